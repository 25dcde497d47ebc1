// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "oracle/oracle.h"

/// Computes by brute force the tangents that baking tools use: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited",
/// 2008, with the rules of its author's implementation for triangles without area, for the coordinates (u, 1 - v).
namespace promin::oracle {

/// The tangent of a corner.
struct CornerTangent {
  /// A unit vector perpendicular to the normal; 0 if there is none.
  Vector direction{0};
  /// The sign of the bitangent, w; 0 if there is none.
  int hand = 0;
  /// The permitted error, as an angle, of a computation in double from exact differences with a result rounded to fp32;
  /// infinite if rounding decides whether there is a direction at all.
  Real error = 0;
  /// The group that shares the tangent; -1 for corners in no group.
  int group = -1;
  /// For corners in no group: the groups of the vertex's other corners, in order, one of which must be copied.
  std::vector<int> groups_at_vertex;
  /// For corners in no group: whether the triangle takes no part; then the first group is copied with its hand.
  bool is_degenerate = false;
};

/// Returns the tangent of each corner, indexed by 3 * triangle + (0, 1, 2). Corners with equal position, normal and
/// coordinates of the set are one vertex. Without normals, a mesh has those of its flat triangles, which are equal if
/// their directions are equal without rounding (for corners whose differences have few bits). Triangles with a point
/// twice, and flat triangles without a normal, take no part. The time grows with the square of the number of corners.
std::vector<CornerTangent> corner_tangents(const Mesh& mesh, uint32_t uv_set);

}  // namespace promin::oracle
