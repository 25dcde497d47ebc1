// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/progress.h"
#include "promin/view.h"
#include "work/pictures/frame_motion.h"
#include "work/pictures/frame_renderers.h"
#include "work/pictures/picture_run.h"

namespace promin::work {

/// Returns the moment of a frame at this fraction of the time until the next frame, 0 to 1: the frame with another time
/// and camera.
PlannedFrame frame_between(const PictureRun& run, const PlannedFrame& frame, double fraction);

/// Renders a frame with Aovs::motion. `view` is the view of the frame. Pixels do not depend on the view's crop.
///
/// While the shutter is open (RenderSpec::shutter), sample i of each pixel shows the moment at the fraction s r(i) of
/// the time until the next frame. s is the shutter, and r(i) is the radical inverse of i in base 2. Colours and
/// coverage of objects and materials are means of the samples, and AOVs of surfaces are those of the middle sample. The
/// view then has a fixed number of samples.
TracedFrame trace_frame(FrameRenderers& renderers, FrameMotion& motion, const PictureRun& run,
                        const PlannedFrame& frame, const View& view, const std::optional<double>& limit_s,
                        const ProgressCallback& on_progress);

}  // namespace promin::work
