// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/frame_rendering.h"

#include <utility>
#include <vector>

#include "core/stopwatch.h"
#include "output/deferred_signals.h"
#include "output/picture_spool.h"
#include "promin/error.h"
#include "promin/image.h"
#include "trace/film/refinement.h"
#include "work/pictures/picture_files.h"
#include "work/pictures/picture_run.h"
#include "work/pictures/quantiles.h"
#include "work/pictures/tracing_run.h"

namespace promin::app {
namespace {

PictureHeader make_header(const RenderSpec& options, const Scene& scene, const std::optional<uint32_t>& frame,
                          const RunStats& stats) {
  const View& view = *stats.view;
  AovHeader aovs = describe_aovs(scene, options.aovs, options.hides_unlit, view.depth_kind);
  PictureHeader header;
  header.size = window_of(view).hi - window_of(view).lo;
  if (view.crop) header.crop = CropPlacement{view.crop->lo, view.size};
  header.metadata = make_metadata(stats, frame, aovs);
  header.channels = std::move(aovs.channels);
  header.display = stats.display;
  header.exr = options.exr;
  return header;
}

/// Sets an exposure that is computed from a picture. The first frame of a path determines it for all frames.
void expose_by_first(const RenderSpec& options, const RenderResult& result, RunStats& stats) {
  const bool is_first = stats.frames.size() <= 1;
  if (!options.view.look.averages_exposure || !is_first || options.view.debug_view != DebugView::kNone) return;
  stats.display.exposure_ev = average_exposure_ev(result.image.pixels, result.aovs.object, result.aovs.unlit);
}

/// Returns whether a picture is traced by one call, because it is needed as a whole, has a time limit, or because each
/// of its samples has another pose.
bool is_traced_whole(const RenderSpec& options) {
  return options.error.time_limit_s || options.view.look.averages_exposure || options.shutter;
}

class FrameRendering {
 public:
  FrameRendering(const PlannedFrame& planned, const RenderSpec& options, const std::optional<double>& limit_s,
                 const gpu::Device& device, const Scene& scene, FrameTracer tracer, RunStats& stats, const Films& films,
                 ProgressCallback on_progress)
      : planned_(planned),
        options_(options),
        limit_s_(limit_s),
        device_(device),
        scene_(scene),
        tracer_(std::move(tracer)),
        stats_(stats),
        films_(films),
        on_progress_(std::move(on_progress)),
        window_(window_of(*stats.view)),
        channels_(describe_aovs(scene, options.aovs, options.hides_unlit, stats.view->depth_kind).channels),
        bands_(is_traced_whole(options) ? std::vector{window_} : cut_bands(window_, 3 + channels_.size())),
        trace_ms_(options.tracing.repeat_count, 0.0) {}

  void run() {
    if (planned_.number) stats_.frames.push_back(*planned_.number);
    if (options_.error.is_given() && bands_.size() > 1) {
      write_when_traced();
    } else {
      write_while_tracing();
    }
    if (planned_.number) {
      stats_.trace_ms.push_back(median(trace_ms_));
    } else {
      stats_.trace_ms = trace_ms_;
    }
  }

 private:
  /// Approximate fraction of a picture's work for writing, if it is written after it is traced. It is larger for few
  /// samples and many channels.
  static constexpr double kWritingShare = 0.05;

  /// Traces the picture or a part of it.
  PictureRows trace_part(const std::optional<PixelWindow>& part, const ProgressCallback& on_progress) {
    View view = *stats_.view;
    if (part) view.crop = part;
    TracedFrame traced = tracer_(view, limit_s_, on_progress);
    RenderResult& result = traced.result;
    if (!result.error) {
      stats_.view->error_target.reset();
      stats_.view->samples_per_pixel = result.samples_per_pixel;
    }
    check_validation(device_, stats_);
    stats_.rays += result.rays;
    if (result.error) {
      if (!error_) error_.emplace(PictureError{.target = result.error->target});
      *error_ += *result.error;
    }
    for (size_t i = 0; i < trace_ms_.size(); ++i) trace_ms_[i] += traced.trace_ms[i];
    expose_by_first(options_, result, stats_);
    // The rows of a wide picture with all AOVs need much memory, so at most two copies exist at a time.
    if (files_) files_->wait();
    return {std::move(result.image),
            make_channels(scene_, std::move(result.aovs), options_.aovs, options_.hides_unlit)};
  }

  void open_files() {
    if (error_) stats_.errors.push_back(*error_);
    // Signals are deferred from here on until no temporary file remains.
    while_writing_.emplace();
    files_.emplace(planned_.pictures, make_header(options_, scene_, planned_.number, stats_), films_);
  }

  void write_while_tracing() {
    const auto rows = static_cast<double>(window_.hi.y - window_.lo.y);
    for (const PixelWindow& band : bands_) {
      PictureRows traced = trace_part(bands_.size() > 1 ? std::optional(band) : std::nullopt, [&](double fraction) {
        if (!on_progress_((band.lo.y - window_.lo.y + fraction * (band.hi.y - band.lo.y)) / rows)) return false;
        return !while_writing_ || !while_writing_->is_pending();
      });
      const Stopwatch write;
      if (!files_) open_files();
      files_->write_rows(std::move(traced.image), std::move(traced.channels));
      stats_.write_ms += write.ms();
    }
    commit();
  }

  void write_when_traced() {
    std::optional<PictureSpool> spool;
    {
      const DeferredSignals while_making;
      spool.emplace(planned_.pictures.empty() ? options_.pictures.front() : planned_.pictures.front(), window_,
                    channels_);
    }
    double pixels_done = 0.0;
    const auto pixels = static_cast<double>(area_of(window_));
    for (const PixelWindow& part : parts_to_refine(window_)) {
      const auto part_pixels = static_cast<double>(area_of(part));
      const PictureRows traced = trace_part(part, [&](double fraction) {
        return on_progress_((1.0 - kWritingShare) * (pixels_done + fraction * part_pixels) / pixels);
      });
      spool->write(part, traced.image, traced.channels);
      pixels_done += part_pixels;
    }
    const Stopwatch write;
    open_files();
    for (size_t i = 0; i < bands_.size(); ++i) {
      if (while_writing_->is_pending()) throw Cancelled();
      on_progress_(1.0 - kWritingShare * (1.0 - static_cast<double>(i) / static_cast<double>(bands_.size())));
      PictureRows rows = spool->read(bands_[i]);
      files_->write_rows(std::move(rows.image), std::move(rows.channels));
    }
    stats_.write_ms += write.ms();
    commit();
  }

  void commit() {
    const Stopwatch write;
    files_->commit();
    stats_.write_ms += write.ms();
  }

  const PlannedFrame& planned_;
  const RenderSpec& options_;
  std::optional<double> limit_s_;
  const gpu::Device& device_;
  const Scene& scene_;
  FrameTracer tracer_;
  RunStats& stats_;
  const Films& films_;
  ProgressCallback on_progress_;
  PixelWindow window_;
  /// Channels in addition to R, G and B. They have no values.
  std::vector<Channel> channels_;
  std::vector<PixelWindow> bands_;
  /// Time of each repetition in milliseconds.
  std::vector<double> trace_ms_;
  std::optional<PictureError> error_;
  // The members are in this order, so that uncommitted files are removed before a signal ends the program.
  std::optional<DeferredSignals> while_writing_;
  std::optional<PictureFiles> files_;
};

}  // namespace

void render_frame(const PlannedFrame& planned, const RenderSpec& options, const std::optional<double>& limit_s,
                  const gpu::Device& device, const Scene& scene, const FrameTracer& tracer, RunStats& stats,
                  const Films& films, const ProgressCallback& on_progress) {
  FrameRendering(planned, options, limit_s, device, scene, tracer, stats, films, on_progress).run();
}

}  // namespace promin::app
