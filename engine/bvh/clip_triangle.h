// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin {

/// The box of the part of a triangle inside a window. It lies inside the window and the triangle's box, and is rounded
/// outward: no point of that part is outside. Without such a part it may be empty. The window may be of any size.
Bounds clip_triangle(const std::array<vec3, 3>& corners, const Bounds& window);

}  // namespace promin
