// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/skin.h"

#include <algorithm>

namespace promin {

bool has_no_area(const dmat4& world_from_object) {
  const dmat3 m(world_from_object);
  const dvec3 zero(0.0);
  return glm::cross(m[0], m[1]) == zero && glm::cross(m[1], m[2]) == zero && glm::cross(m[2], m[0]) == zero;
}

PosedSkin pose_skin(const Skin& skin, std::span<const dmat4> world_from_node) {
  PosedSkin posed;
  for (size_t joint = 0; joint < skin.joints.size(); ++joint) {
    const dmat4& world = world_from_node[skin.joints[joint]];
    posed.joint_matrices.push_back(skin.inverse_bind.empty() ? world : world * skin.inverse_bind[joint]);
  }
  const auto mirrors = [](const dmat4& matrix) { return glm::determinant(dmat3(matrix)) < 0.0; };
  posed.is_hidden = std::ranges::all_of(posed.joint_matrices, has_no_area);
  if (!posed.is_hidden && std::ranges::all_of(posed.joint_matrices, mirrors)) {
    posed.world_from_mesh[0][0] = -1.0;
    for (dmat4& matrix : posed.joint_matrices) matrix = posed.world_from_mesh * matrix;
  }
  return posed;
}

}  // namespace promin
