// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/cast_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/count_of.h"
#include "core/divide_up.h"
#include "core/json_text.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "rays/npy.h"
#include "trace/render/caster_access.h"
#include "work/jobs/fingerprint.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/missing_pieces.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/check_spec.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Names of the queries, indexed by HitQuery.
constexpr std::array<std::string_view, 4> kQueryNames = {"nearest", "any", "count", "all"};

std::string_view name_of_query(HitQuery query) {
  return kQueryNames[static_cast<size_t>(query)];
}

/// A range of the rays of a file: from `first` up to, but without, `end`.
struct RayRange {
  uint64_t begin = 0;
  uint64_t end = 0;

  uint64_t count() const { return end - begin; }
};

/// Returns the default number of pieces for this number of rays.
uint64_t choose_pieces(uint64_t count, bool is_all) {
  const uint64_t most_rays = is_all ? kPieceRaysOfAll : kPieceRays;
  return std::max({uint64_t{1}, std::min(kUsualPieces, count / kLeastPieceRays), divide_up(count, most_rays)});
}

/// Divides all rays into nearly equal ranges; there is at least one.
std::vector<RayRange> cut_rays(uint64_t count, const CastSpec& options) {
  const uint64_t pieces = options.job.pieces.value_or(choose_pieces(count, options.is_all));
  if (pieces > std::max<uint64_t>(count, 1) || pieces > kMostRayPieces) {
    throw UsageError({"job.pieces.many",
                      fmt::format("{} pieces are more than {}", pieces,
                                  pieces > kMostRayPieces ? fmt::format("the {} that a job may have", kMostRayPieces)
                                                          : count_of(count, "ray")),
                      options.rays.string(), "lower --pieces"});
  }
  std::vector<RayRange> ranges;
  // The product would overflow with 10^13 rays or more, so the code divides first.
  const uint64_t least = count / pieces;
  const uint64_t longer = count % pieces;
  for (uint64_t i = 0, begin = 0; i < pieces; ++i) {
    const uint64_t end = begin + least + (i < longer ? 1 : 0);
    ranges.push_back({begin, end});
    begin = end;
  }
  return ranges;
}

std::vector<std::string> name_ray_pieces(const std::vector<RayRange>& ranges) {
  std::vector<std::string> names;
  for (const RayRange& range : ranges) names.push_back(fmt::format("r{:012}-{:012}", range.begin, range.end));
  return names;
}

/// The description of a piece. The piece's bytes are hits or counts. With kAll, the hits are followed by an offset for
/// each ray: the number of hits up to the ray's end.
struct HitPiece {
  HitQuery query = HitQuery::kNearest;
  std::string driver;
  RayRange rays;
};

std::string encode(const HitPiece& piece) {
  const Json json = {{"driver", piece.driver},
                     {"query", name_of_query(piece.query)},
                     {"first_ray", piece.rays.begin},
                     {"rays", piece.rays.count()}};
  return json_text(json);
}

/// Reads the description of a piece and checks its bytes against it. Throws InputError.
HitPiece decode(const jobs::Content& content, const fs::path& file) {
  const InputError bad(
      {"job.piece.kind", "the piece does not contain hits", file.string(), "remove it and run the job again"});
  HitPiece piece;
  try {
    const Json json = read_ordered_json(content.description);
    const auto query = std::ranges::find(kQueryNames, json.at("query").get<std::string>());
    if (query == kQueryNames.end()) throw bad;
    piece.query = static_cast<HitQuery>(query - kQueryNames.begin());
    piece.driver = json.at("driver").get<std::string>();
    piece.rays.begin = json.at("first_ray").get<uint64_t>();
    piece.rays.end = piece.rays.begin + json.at("rays").get<uint64_t>();
  } catch (const nlohmann::json::exception&) {
    throw bad;
  }
  const uint64_t count = piece.rays.count();
  const uint64_t bytes = content.bytes.size();
  bool is_whole = bytes == count * (piece.query == HitQuery::kCount ? sizeof(int32_t) : sizeof(Hit));
  if (piece.query == HitQuery::kAll) {
    uint64_t last = 0;
    is_whole = bytes / sizeof(uint64_t) >= count;
    if (is_whole && count > 0) std::memcpy(&last, &content.bytes[bytes - sizeof(last)], sizeof(last));
    is_whole = is_whole && bytes % sizeof(Hit) == count * sizeof(uint64_t) % sizeof(Hit) &&
               (bytes - count * sizeof(uint64_t)) / sizeof(Hit) == last;
  }
  if (!is_whole) throw bad;
  return piece;
}

class RayJob : public PlannedJob {
 public:
  RayJob(const CastSpec& options, const Messages& console, std::shared_ptr<RaySource> rays)
      : options_(options), console_(console), rays_(std::move(rays)), ranges_(cut_rays(rays_->count(), options)) {
    std::vector<SourceFile> sources;
    scene_ = load_for(options.tracing, stats_, console, sources);
    manifest_ = begin_manifest(kRayJob, list_bits(options));
    manifest_.options.emplace_back("rays", std::to_string(rays_->count()));
    add_scene_files(manifest_, sources);
    manifest_.files.push_back(rays_->describe());
    manifest_.pieces = name_ray_pieces(ranges_);
    spec_ = write_spec_of_pieces(options);
  }

  std::unique_ptr<PieceMaker> open(const gpu::Device& device, size_t pieces, const ProgressCallback& progress) override;
  PieceDifference compare(size_t piece, const jobs::Content& there, const jobs::Content& anew,
                          const fs::path& file) override;
  void remember() override { rays_->remember(); }

 private:
  friend class RayPieces;

  CastSpec options_;
  const Messages& console_;
  std::shared_ptr<RaySource> rays_;
  std::vector<RayRange> ranges_;
  RunStats stats_;
  Scene scene_;
};

class RayPieces : public PieceMaker {
 public:
  RayPieces(RayJob& job, const gpu::Device& device, const ProgressCallback& progress)
      : job_(job), device_(device), stats_(job.stats_) {
    stats_.device = gpu::info_of(device);
    TunedCasterOptions options;
    choose_tree(job.options_.tracing, options);
    options.shared_bvh = shared_tree_file(job.options_.job, options.builder);
    options.progress = progress;
    caster_.emplace(make_caster(device, world::flatten(job.scene_, world::Purpose::kHits), options));
    std::vector<Ray> rays(std::min(kChunkRays, job.ranges_.front().count()));
    job.rays_->read(0, rays, job.scene_.center);
    caster_->prepare(job.options_.query(), rays);
    take_setup(caster_->setup_stats(), stats_, job.console_);
  }

  jobs::Content make(size_t number, const ProgressCallback& progress) override {
    const HitPiece piece{job_.options_.query(), driver_of(stats_.device), job_.ranges_[number]};
    jobs::Content content{encode(piece), {}};
    ends_.clear();
    std::vector<Ray> rays;
    for (uint64_t done = 0; done < piece.rays.count(); done += rays.size()) {
      rays.resize(std::min(kChunkRays, piece.rays.count() - done));
      job_.rays_->read(piece.rays.begin + done, rays, job_.scene_.center);
      answer(rays, content.bytes, [&](double fraction) {
        const double traced = static_cast<double>(done) + fraction * static_cast<double>(rays.size());
        return !progress || progress(traced / static_cast<double>(piece.rays.count()));
      });
    }
    const auto ends = std::as_bytes(std::span(ends_));
    content.bytes.insert(content.bytes.end(), ends.begin(), ends.end());
    check_validation(device_, stats_);
    return content;
  }

 private:
  /// Traces the rays and appends their results.
  void answer(std::span<const Ray> rays, std::vector<std::byte>& bytes, const ProgressCallback& progress) {
    const HitQuery query = job_.options_.query();
    if (query == HitQuery::kAll) {
      const auto take = [&](const HitList& list) {
        const uint64_t before = bytes.size() / sizeof(Hit);
        for (const uint64_t end : list.offsets.subspan(1)) ends_.push_back(before + end);
        append(list.hits, bytes);
      };
      caster_->list(rays, take, Caster::kListBytes, progress);
    } else if (query == HitQuery::kCount) {
      counts_.resize(rays.size());
      caster_->count(rays, counts_, progress);
      append(std::span(std::as_const(counts_)), bytes);
    } else {
      hits_.resize(rays.size());
      caster_->cast(rays, hits_, query, progress);
      append(std::span(std::as_const(hits_)), bytes);
    }
  }

  template <typename Value>
  static void append(std::span<const Value> values, std::vector<std::byte>& bytes) {
    const auto more = std::as_bytes(values);
    bytes.insert(bytes.end(), more.begin(), more.end());
  }

  const RayJob& job_;
  const gpu::Device& device_;
  RunStats stats_;
  std::optional<Caster> caster_;
  std::vector<Hit> hits_;
  std::vector<int32_t> counts_;
  /// With kAll, the ends of the hits of the current piece's rays.
  std::vector<uint64_t> ends_;
};

std::unique_ptr<PieceMaker> RayJob::open(const gpu::Device& device, size_t /*pieces*/,
                                         const ProgressCallback& progress) {
  return std::make_unique<RayPieces>(*this, device, progress);
}

/// Returns a piece's bytes, or a part of them, as values of their type. They are aligned, because they begin at an
/// allocation or after hits.
template <typename Value>
std::span<const Value> values_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Value*>(bytes.data()), bytes.size() / sizeof(Value)};
}

/// The hits of a piece with kAll, ray by ray.
class HitLists {
 public:
  HitLists(std::span<const std::byte> bytes, uint64_t rays)
      : hits_(values_of<Hit>(bytes.first(bytes.size() - rays * sizeof(uint64_t)))),
        ends_(values_of<uint64_t>(bytes.last(rays * sizeof(uint64_t)))) {}

  /// Returns the hits of a ray. Throws InputError if its ends are invalid.
  std::span<const Hit> of(size_t ray, const fs::path& file) const {
    const uint64_t begin = ray == 0 ? 0 : ends_[ray - 1];
    if (begin <= ends_[ray] && ends_[ray] <= hits_.size()) return hits_.subspan(begin, ends_[ray] - begin);
    throw InputError(
        {"job.piece.kind", "the piece does not contain hits", file.string(), "remove it and run the job again"});
  }

 private:
  std::span<const Hit> hits_;
  std::span<const uint64_t> ends_;
};

PieceDifference RayJob::compare(size_t piece, const jobs::Content& there, const jobs::Content& anew,
                                const fs::path& file) {
  const RayRange& range = ranges_[piece];
  for (const jobs::Content* content : {&there, &anew}) {
    const HitPiece told = decode(*content, file);
    if (told.query == options_.query() && told.rays.begin == range.begin && told.rays.end == range.end) continue;
    throw InputError(
        {"job.piece.other", "the piece belongs to other rays", file.string(), "remove it and run the job again"});
  }
  HitComparison comparison(scene_);
  if (options_.query() == HitQuery::kCount) {
    comparison.compare(values_of<int32_t>(there.bytes), values_of<int32_t>(anew.bytes));
    return comparison.difference();
  }
  std::vector<Ray> rays;
  for (uint64_t done = 0; done < range.count(); done += rays.size()) {
    rays.resize(std::min(kChunkRays, range.count() - done));
    rays_->read(range.begin + done, rays, scene_.center);
    if (options_.query() == HitQuery::kAll) {
      const HitLists lists_there(there.bytes, range.count());
      const HitLists lists_anew(anew.bytes, range.count());
      for (size_t i = 0; i < rays.size(); ++i) {
        comparison.compare_lists(rays[i], lists_there.of(done + i, file), lists_anew.of(done + i, file));
      }
    } else {
      comparison.compare(rays, values_of<Hit>(there.bytes).subspan(done, rays.size()),
                         values_of<Hit>(anew.bytes).subspan(done, rays.size()));
    }
  }
  return comparison.difference();
}

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

std::unique_ptr<PlannedJob> plan_rays(const CastSpec& options, const Messages& console,
                                      std::shared_ptr<RaySource> rays) {
  if (rays == nullptr) rays = open_rays(options.rays, *options.job.folder);
  return std::make_unique<RayJob>(options, console, std::move(rays));
}

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
  const uint64_t rays = decode(job.read(last), job.file_of(last)).rays.end;
  std::optional<HitFiles> written;
  std::optional<HitPiece> first;
  uint64_t done = 0;
  for (size_t number = 0; number <= last; ++number) {
    if (progress && !progress(static_cast<double>(number) / static_cast<double>(last + 1))) throw Cancelled();
    const jobs::Content content = job.read(number);
    const fs::path file = job.file_of(number);
    const HitPiece piece = decode(content, file);
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
