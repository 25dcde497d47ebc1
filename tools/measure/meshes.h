// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace promin::measure {

// Meshes of any size to measure with, each a scene of one object without camera or light; the same bits every time.

/// A closed surface around the origin with waves on it, of 4 r^2 triangles for the r that comes nearest to the number
/// asked for.
Scene make_wavy_sphere(uint32_t triangle_count);

/// Long thin triangles, a fiftieth as wide as long, strewn in a ball at any angle: boxes that overlap and are mostly
/// empty.
Scene make_needles(uint32_t triangle_count);

}  // namespace promin::measure
