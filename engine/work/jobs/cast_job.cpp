// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/cast_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/count_of.h"
#include "core/divide_up.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "trace/render/caster_access.h"
#include "work/jobs/fingerprint.h"
#include "work/jobs/hit_piece.h"
#include "work/jobs/job_manifest.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

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
    caster_.emplace(make_caster(device, world::flatten(job.scene_, world::Purpose::kHits, options.instances), options));
    std::vector<Ray> rays(std::min(kChunkRays, job.ranges_.front().count()));
    job.rays_->read(0, rays, job.scene_.center);
    caster_->prepare(job.options_.query(), rays);
    take_setup(caster_->setup_stats(), device_, stats_, job.console_);
  }

  jobs::Content make(size_t number, const ProgressCallback& progress) override {
    const HitPiece piece{job_.options_.query(), driver_of(stats_.device), job_.ranges_[number]};
    jobs::Content content{encode_hit_piece(piece), {}};
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
    const HitPiece told = decode_hit_piece(*content, file);
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

}  // namespace

std::unique_ptr<PlannedJob> plan_rays(const CastSpec& options, const Messages& console,
                                      std::shared_ptr<RaySource> rays) {
  if (rays == nullptr) rays = open_rays(options.rays, *options.job.folder);
  return std::make_unique<RayJob>(options, console, std::move(rays));
}

}  // namespace promin::work
