// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/camera.h"
#include "promin/display.h"
#include "view/pixel_query.h"

namespace promin::app {

/// Shows at the right edge of the window where a pixel's color comes from, as a tree of its rays with colors as they
/// are displayed, and draws the rays into the picture as the camera sees them. False when the user has closed it.
bool show_explanation(const ExplainedPixel& explained, const Camera& camera, const DisplayTransform& display);

}  // namespace promin::app
