// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/file.h"
#include "promin/error.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/picture_part.h"
#include "work/jobs/picture_pieces.h"
#include "work/pictures/frame_renderers.h"
#include "work/pictures/shutter.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

jobs::Manifest make_manifest(const RenderSpec& spec, const PictureRun& run, std::vector<std::string> pieces) {
  RenderSpec named = spec;
  // The default depends on the integrator.
  std::optional<uint32_t>& samples = named.view.samples_per_pixel;
  if (samples == samples_of(Quality::kNormal, run.stats.view->mode)) samples.reset();
  jobs::Manifest manifest = begin_manifest(kPictureJob, list_bits(named));
  const uvec2& size = run.stats.view->size;
  manifest.options.emplace_back("size", fmt::format("{}x{}", size.x, size.y));
  const Integrator integrator = run.stats.view->mode.integrator;
  if (!spec.view.integrator && integrator != Integrator::kWhitted) {
    manifest.options.emplace_back("integrator", integrator_names()[static_cast<size_t>(integrator)]);
  }
  add_scene_files(manifest, run.sources);
  if (run.options.path) manifest.files.push_back(jobs::describe_input(*run.options.path));
  const auto& panorama = run.options.view.environment.panorama;
  if (panorama) manifest.files.push_back(jobs::describe_input(*panorama));
  manifest.pieces = std::move(pieces);
  return manifest;
}

/// A job whose pieces are parts of frames: all parts of the first frame, then all parts of the next frame, and so on.
class PictureJob : public PlannedJob {
 public:
  PictureJob(const RenderSpec& spec, PictureRun run, const Messages& console)
      : run_(std::move(run)),
        console_(console),
        window_(window_of(*run_.stats.view)),
        parts_(cut_picture(window_, run_.options.job, run_.frames.size())) {
    std::vector<std::optional<uint32_t>> numbers;
    for (const PlannedFrame& frame : run_.frames) numbers.push_back(frame.number);
    manifest_ = make_manifest(spec, run_, name_pieces(numbers, parts_));
    spec_ = write_spec_of_pieces(spec);
  }

  std::unique_ptr<PieceMaker> open(const gpu::Device& device, size_t pieces, const ProgressCallback& progress) override;
  PieceDifference compare(size_t /*piece*/, const jobs::Content& there, const jobs::Content& anew,
                          const std::filesystem::path& file) override {
    return compare_parts(decode_part(there, file), decode_part(anew, file), file);
  }

 private:
  friend class PicturePieces;

  PictureRun run_;
  const Messages& console_;
  PixelWindow window_;
  std::vector<PixelWindow> parts_;
};

class PicturePieces : public PieceMaker {
 public:
  PicturePieces(PictureJob& job, const gpu::Device& device, size_t pieces, const ProgressCallback& progress)
      : job_(job), device_(device), stats_(job.run_.stats), motion_(job.run_) {
    stats_.device = gpu::info_of(device);
    const size_t all = job.manifest().pieces.size();
    const uint64_t samples = count_samples(*stats_.view, job.run_.frames.size(), job.run_.options);
    const uint64_t expected = samples / all * std::clamp<size_t>(pieces, 1, all);
    TunedRendererOptions options = make_renderer_options(job.run_.options, expected);
    // Each frame of a film has its own tree.
    if (job.run_.moving == nullptr) options.shared_bvh = shared_tree_file(job.run_.options.job, options.builder);
    options.progress = progress;
    renderers_.emplace(device, job.run_, options);
    if (job.run_.moving == nullptr) prepare(job.run_.frames.front());
  }

  jobs::Content make(size_t piece, const ProgressCallback& progress) override {
    const RenderSpec& options = job_.run_.options;
    const PlannedFrame& frame = job_.run_.frames[piece / job_.parts_.size()];
    prepare(frame);
    View view = *job_.run_.stats.view;
    renderers_->describe(frame, view, stats_);
    view.crop = job_.parts_[piece % job_.parts_.size()];
    TracedFrame traced = trace_frame(*renderers_, motion_, job_.run_, frame, view, std::nullopt, progress);
    check_validation(device_, stats_);
    stats_.errors.clear();
    if (traced.result.error) stats_.errors.push_back(*traced.result.error);
    const AovHeader aovs = describe_aovs(job_.run_.scene, options.aovs, options.hides_unlit, view.depth_kind);
    return encode_part(
        {.frame = frame.number,
         .full_size = view.size,
         .window = job_.window_,
         .part = *view.crop,
         .metadata = make_metadata(stats_, frame.number, aovs),
         .exr = options.exr,
         .display = stats_.display,
         .error = traced.result.error,
         .image = std::move(traced.result.image),
         .channels = make_channels(job_.run_.scene, std::move(traced.result.aovs), options.aovs, options.hides_unlit)});
  }

 private:
  /// Makes the renderer of a frame. The first one reports its setup.
  void prepare(const PlannedFrame& frame) {
    const Renderer& renderer = renderers_->at(frame);
    if (!std::exchange(is_set_up_, true)) take_setup(renderer.setup_stats(), device_, stats_, job_.console_);
  }

  const PictureJob& job_;
  const gpu::Device& device_;
  RunStats stats_;
  FrameMotion motion_;
  std::optional<FrameRenderers> renderers_;
  bool is_set_up_ = false;
};

std::unique_ptr<PieceMaker> PictureJob::open(const gpu::Device& device, size_t pieces,
                                             const ProgressCallback& progress) {
  return std::make_unique<PicturePieces>(*this, device, pieces, progress);
}

}  // namespace

std::unique_ptr<PlannedJob> plan_pictures(const RenderSpec& spec, PictureRun run, const Messages& console) {
  return std::make_unique<PictureJob>(spec, std::move(run), console);
}

}  // namespace promin::work
