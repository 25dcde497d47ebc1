// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "oracle/oracle.h"

/// Computes by brute force the tangents that baking tools use: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited",
/// 2008. For triangles without area, the code follows the rules of Mikkelsen's implementation. Texture coordinates are
/// (u, 1 - v).
namespace promin::oracle {

/// The tangent of a corner.
struct CornerTangent {
  /// The direction: a unit vector perpendicular to the normal; 0 if there is none.
  Vector direction{0};
  /// The sign w of the bitangent; 0 if there is none.
  int hand = 0;
  /// The permitted error, as an angle, of a computation in double from exact differences whose result is rounded to
  /// fp32. It is infinite if rounding decides whether there is a direction.
  Real error = 0;
  /// Number of the group that shares the tangent; -1 for a corner in no group.
  int group = -1;
  /// For a corner in no group: the groups of the vertex's other corners, in order. The corner must have the tangent of
  /// one of them.
  std::vector<int> groups_at_vertex;
  /// For a corner in no group: whether its triangle takes no part. The corner must then have the tangent and the
  /// handedness of the first group.
  bool is_degenerate = false;
};

/// Returns the tangent of each corner, indexed by 3 * triangle + (0, 1, 2). Corners with equal position, normal and
/// coordinates of the set are one vertex. A mesh without normals has the normals of its flat triangles. Two of these
/// are equal if their directions are equal without rounding (for corners whose differences have few bits). Triangles
/// with two equal points, and flat triangles without a normal, take no part. The time grows with the square of the
/// number of corners.
std::vector<CornerTangent> corner_tangents(const Mesh& mesh, uint32_t uv_set);

}  // namespace promin::oracle
