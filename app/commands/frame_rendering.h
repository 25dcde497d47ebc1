// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "output/work_names.h"
#include "promin/device.h"
#include "promin/progress.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/picture_files.h"
#include "work/pictures/picture_run.h"
#include "work/pictures/run_stats.h"
#include "work/spec/render_spec.h"

namespace promin::app {

/// Traces a view of a frame. The second argument is the remaining time, if there is a time limit.
using FrameTracer =
    std::function<work::TracedFrame(const View&, const std::optional<double>&, const ProgressCallback&)>;

/// Traces a frame, writes its pictures and adds it to the films. For a large picture it writes a band while the next
/// one is traced. If the files begin with the error of the whole picture, it writes them after all is traced. `limit_s`
/// is the remaining time if there is a time limit. `stats.view` is the frame's view; the function adds the frame's
/// figures to `stats`. Throws RunError. Throws Cancelled if a signal came while it wrote or if `on_progress` returns
/// false; then it leaves no incomplete file.
void render_frame(const PlannedFrame& planned, const RenderSpec& options, const std::optional<double>& limit_s,
                  const gpu::Device& device, const Scene& scene, const FrameTracer& tracer, RunStats& stats,
                  const Films& films, const ProgressCallback& on_progress);

}  // namespace promin::app
