// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin {

/// The box of that part of a triangle which lies inside a window. It lies inside the window and the triangle's box, and
/// is rounded outward, so that no point of the part is outside. It may be empty where there is no such part. The window
/// may be of any size.
Bounds clip_triangle(const std::array<vec3, 3>& corners, const Bounds& window);

}  // namespace promin
