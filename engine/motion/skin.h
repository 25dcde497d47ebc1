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
  /// Indices of joints: `per_vertex` for each vertex, one vertex after the other. An index is in range if its weight is
  /// not 0.
  std::vector<uint32_t> joints = {};
  /// The weight of each joint, finite. The sum of a vertex's weights is not 0.
  std::vector<float> weights = {};
};

/// Poses a mesh, in double with one rounding to fp32. The transform of a vertex is the weighted mean of the transforms
/// of its joints (linear blend skinning). It transforms positions and tangents. Its cofactor matrix transforms normals,
/// which are then normalised. A normal that vanishes becomes 0. A mirroring transform reverses the handedness of the
/// vertex's tangent. `joint_matrices` are the transforms of the joints in the world times their inverse bind matrices.
void pose_mesh(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, Mesh& mesh);

}  // namespace promin
