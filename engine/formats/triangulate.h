// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Cutting a concave polygon takes quadratic time, so readers refuse more corners.
inline constexpr size_t kMaxPolygonCorners = 10'000;

/// Cuts a polygon, convex or not, into its n - 2 triangles, wound as it is; indices into `corners`. Convex polygons
/// become the fan around corner 0, others are cut by ear clipping (Meisters 1975). A polygon that crosses itself or
/// has no area still gives n - 2 triangles, so that numbering holds.
std::vector<uvec3> triangulate_polygon(std::span<const vec3> corners);

}  // namespace promin
