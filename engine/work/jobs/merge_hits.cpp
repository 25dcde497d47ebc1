// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/merge_hits.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <span>

#include "promin/error.h"
#include "rays/npy.h"
#include "work/jobs/hit_piece.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/missing_pieces.h"
#include "work/spec/check_spec.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// Checks that the number of output files is right.
void check_count(size_t count, const std::vector<fs::path>& files) {
  if (files.size() == count) return;
  throw UsageError({"job.outputs.count",
                    fmt::format("the results of this job need {}, but the number of outputs is {}",
                                count == 2 ? "two files, hits and offsets" : "one file", files.size()),
                    files.empty() ? "" : files.front().string(),
                    count == 2 ? "give --output and --offsets" : "give --output alone"});
}

/// The files of a query. Pieces are added in their order.
class HitFiles {
 public:
  HitFiles(HitQuery query, const std::vector<fs::path>& files, uint64_t rays) {
    check_count(query == HitQuery::kAll ? 2 : 1, files);
    if (query == HitQuery::kCount) {
      counts_.emplace(files[0], rays);
      return;
    }
    hits_.emplace(files[0], query == HitQuery::kAll ? std::nullopt : std::optional(rays));
    if (query != HitQuery::kAll) return;
    offsets_.emplace(files[1], rays + 1);
    offsets_->write(std::array{uint64_t{0}});
  }

  void add(const jobs::Content& content, uint64_t rays) {
    if (counts_) return counts_->write(values_of<int32_t>(content.bytes));
    const size_t hit_bytes = content.bytes.size() - (offsets_ ? rays * sizeof(uint64_t) : 0);
    const auto bytes = std::span(content.bytes);
    hits_->write(values_of<Hit>(bytes.first(hit_bytes)));
    if (!offsets_) return;
    const auto ends = values_of<uint64_t>(bytes.subspan(hit_bytes));
    std::vector<uint64_t> offsets(ends.begin(), ends.end());
    for (uint64_t& offset : offsets) offset += hit_count_;
    offsets_->write(offsets);
    hit_count_ += hit_bytes / sizeof(Hit);
  }

  void commit() {
    if (counts_) return counts_->commit();
    if (!offsets_) return hits_->commit();
    ArrayWriter::commit_together({&*hits_, &*offsets_});
  }

 private:
  std::optional<HitWriter> hits_;
  std::optional<CountWriter> counts_;
  std::optional<OffsetWriter> offsets_;
  uint64_t hit_count_ = 0;
};

}  // namespace

void check_merged_hits(const jobs::Job& job, const std::vector<fs::path>& files) {
  check_arrays(files);
  // Pieces that a function has made have a description of their content.
  const std::optional<std::string> spec = read_job_spec(job);
  if (spec) check_count(parse_spec<CastSpec>(*spec, spec_file(job)).is_all ? 2 : 1, files);
}

void merge_hits(const jobs::Job& job, const std::vector<fs::path>& files, const ProgressCallback& progress,
                bool is_mixed) {
  check_whole(job);
  const size_t last = job.piece_count() - 1;
  const uint64_t rays = decode_hit_piece(job.read(last), job.file_of(last)).rays.end;
  std::optional<HitFiles> written;
  std::optional<HitPiece> first;
  uint64_t done = 0;
  for (size_t number = 0; number <= last; ++number) {
    if (progress && !progress(static_cast<double>(number) / static_cast<double>(last + 1))) throw Cancelled();
    const jobs::Content content = job.read(number);
    const fs::path file = job.file_of(number);
    const HitPiece piece = decode_hit_piece(content, file);
    if (!first) first = piece;
    if (!written) written.emplace(piece.query, files, rays);
    if (piece.query != first->query || piece.rays.begin != done) {
      throw InputError({"job.piece.order", "the piece's rays do not follow the rays of the previous piece",
                        file.string(), "remove it and run the job again"});
    }
    if (piece.driver != first->driver && !is_mixed) {
      throw InputError(
          {"job.device.other",
           fmt::format("the piece was made on {}, but other pieces were made on {}", piece.driver, first->driver),
           file.string(), "remove the pieces of one device, and run the job again on the other device"});
    }
    written->add(content, piece.rays.count());
    done = piece.rays.end;
  }
  written->commit();
}

}  // namespace promin::work
