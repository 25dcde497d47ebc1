// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin {

/// Returns the box of the part of a triangle inside a window. The box lies inside the window and the triangle's box,
/// and is rounded outward, so that it contains every point of the part. The box may be empty if no part of the triangle
/// is inside. The window may have any size.
Bounds clip_triangle(const std::array<vec3, 3>& corners, const Bounds& window);

}  // namespace promin
