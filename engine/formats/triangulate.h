// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "promin/math.h"

namespace promin {

/// The largest number of corners that readers accept, because triangulating a concave polygon takes quadratic time.
inline constexpr size_t kMaxPolygonCorners = 10'000;

/// Divides a polygon, convex or not, into n - 2 triangles with the same winding, as indices into `corners`. Convex
/// polygons become the fan around corner 0, others are divided by ear clipping (Meisters 1975). A polygon that crosses
/// itself or has no area still gives n - 2 triangles, so that triangle numbers do not change.
std::vector<uvec3> triangulate_polygon(std::span<const vec3> corners);

}  // namespace promin
