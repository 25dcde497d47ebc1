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
  /// How far off, as an angle, a computation in double from exact differences may be whose result is rounded to fp32;
  /// infinite where rounding decides whether there is a direction at all.
  Real error = 0;
  /// The group that shares the tangent; -1 for corners in no group.
  int group = -1;
  /// Of these the groups that other corners of the vertex have, the first first: one of them is to be copied.
  std::vector<int> groups_at_vertex;
  /// Of these whether the triangle takes no part: then the first is copied with its hand.
  bool is_degenerate = false;
};

/// Of each corner, 3 * triangle + (0, 1, 2). Corners are one vertex whose positions, normals and coordinates of the set
/// are equal; where the mesh has no normals they are those of the flat triangles, which are equal where their
/// directions are, without rounding (of corners whose differences have few bits). Triangles with a point twice, or flat
/// without a normal, take no part. Takes time in the square of the number of corners.
std::vector<CornerTangent> corner_tangents(const Mesh& mesh, uint32_t uv_set);

}  // namespace promin::oracle
