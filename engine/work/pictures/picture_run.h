// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "formats/source_file.h"
#include "promin/aovs.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "trace/render/make_renderer.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/messages.h"
#include "work/pictures/moving_scene.h"
#include "work/pictures/picture_files.h"
#include "work/pictures/run_stats.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/render_spec.h"

namespace promin::work {

// Steps of rendering that a single run and a job have in common.

/// Pictures that are ready to be traced. All inputs are read, but no device is open.
struct PictureRun {
  /// The options. They include Aovs::unlit if the display of the pictures needs it.
  RenderSpec options;
  std::vector<PlannedFrame> frames;
  /// The scene with its lights and its cameras. If the scene moves, this is the scene that stands for all frames.
  Scene scene;
  /// The scene of each frame, if the frames have different poses.
  std::shared_ptr<const MovingScene> moving = nullptr;
  std::vector<SourceFile> sources;
  /// The statistics so far. They include the display transform and the view of all frames without their cameras.
  RunStats stats;
};

/// Loads the scene of checked options and chooses open settings, with notes. Plans the frames of a film if there are
/// none. Throws InputError. Throws UsageError if the options refer to something that the scene does not have.
PictureRun prepare_pictures(const RenderSpec& given, std::vector<PlannedFrame> frames, const Messages& console);

/// Returns the number of samples of all pictures together.
uint64_t count_samples(const View& view, size_t frames, const RenderSpec& options);

TunedRendererOptions make_renderer_options(const RenderSpec& options, uint64_t expected_samples);

/// A picture and the device's time for each of its repetitions.
struct TracedFrame {
  RenderResult result;
  std::vector<double> trace_ms;
};

TracedFrame trace(Renderer& renderer, const View& view, const RenderSpec& options, const std::optional<double>& limit_s,
                  const std::function<bool(double)>& on_progress);

/// Returns the metadata of a picture. They have no times, so that equal pictures give equal files.
Metadata make_metadata(const RunStats& stats, const std::optional<uint32_t>& frame, const AovHeader& aovs);

/// Returns the rendered window of the whole picture: the crop, or the whole picture.
PixelWindow window_of(const View& view);

}  // namespace promin::work
