// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/shapes.h"

namespace promin {

/// The joints that move the vertices of a mesh, and their weights (glTF 2.0, section 3.7.3).
struct SkinInfluences {
  /// The number of joints per vertex.
  size_t per_vertex = 0;
  /// `per_vertex` indices of joints for each vertex, one vertex after another. They are in range if the weight is not
  /// 0.
  std::vector<uint32_t> joints = {};
  /// The weight of each, finite. The sum of a vertex's weights is not 0.
  std::vector<float> weights = {};
};

/// Poses a mesh, in double with one rounding to fp32. The transform of a vertex is the weighted mean of those of its
/// joints (linear blend skinning). It transforms positions and tangents; its cofactor matrix transforms normals, which
/// are then normalised; a normal that vanishes becomes 0. A mirroring transform reverses the handedness of the vertex's
/// tangent. `joint_matrices` are those of the joints in the world times their inverse bind matrices.
void pose_mesh(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, Mesh& mesh);

}  // namespace promin
