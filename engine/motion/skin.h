// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/shapes.h"

namespace promin {

/// Which joints move the vertices of a mesh, and how much (glTF 2.0, section 3.7.3).
struct SkinInfluences {
  /// The number of joints that may move a vertex.
  size_t per_vertex = 0;
  /// `per_vertex` indices of joints for each vertex, one vertex after another. They are in range where the weight is
  /// not 0.
  std::vector<uint32_t> joints = {};
  /// The weight of each, finite. Those of a vertex have a sum other than 0.
  std::vector<float> weights = {};
};

/// Poses a mesh, in double with one rounding to fp32. The transform of a vertex is the mean of those of its joints by
/// their weights (linear blend skinning). Positions and tangents go by it. Normals go by its matrix of cofactors, as
/// normals do, and are of unit length; one that vanishes becomes 0. A transform that mirrors turns the hand of the
/// vertex's tangent. `joint_matrices` are those of the joints in the world times their inverse bind matrices.
void pose_mesh(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, Mesh& mesh);

}  // namespace promin
