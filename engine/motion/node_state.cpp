// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/node_state.h"

#include <glm/gtc/quaternion.hpp>

#include "core/rounding.h"

namespace promin {
namespace {

glm::dquat quaternion_of(const Trs& trs) {
  return glm::normalize(glm::dquat(trs.rotation.w, trs.rotation.x, trs.rotation.y, trs.rotation.z));
}

}  // namespace

dmat4 local_matrix(const Node& node) {
  if (node.matrix) return *node.matrix;
  const Trs& trs = node.trs;
  dmat4 matrix(1.0);
  if (trs.rotation != Trs{}.rotation) matrix = glm::mat4_cast(quaternion_of(trs));
  for (int i = 0; i < 3; ++i) matrix[i] *= trs.scale[i];
  matrix[3] = dvec4(trs.translation, 1.0);
  return matrix;
}

std::optional<dmat3> local_rotation(const Node& node) {
  if (!node.matrix) return glm::mat3_cast(quaternion_of(node.trs));
  const dmat3 matrix(*node.matrix);
  const dvec3 z = glm::normalize(matrix[2]);
  const dvec3 x = glm::normalize(glm::cross(matrix[1], z));
  const dmat3 rotation(x, glm::cross(z, x), z);
  if (!is_finite(dmat4(rotation))) return std::nullopt;
  return rotation;
}

dmat4 world_around(const dvec3& center) {
  dmat4 place(1.0);
  place[3] = dvec4(dvec3(0.0) - center, 1.0);
  return place;
}

std::vector<uint32_t> order_nodes(std::span<const Node> nodes) {
  std::vector<uint32_t> order;
  order.reserve(nodes.size());
  std::vector<bool> is_listed(nodes.size(), false);
  std::vector<uint32_t> above;
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    for (uint32_t node = i; node != kNoIndex && !is_listed[node]; node = nodes[node].parent) {
      above.push_back(node);
      is_listed[node] = true;
    }
    order.insert(order.end(), above.rbegin(), above.rend());
    above.clear();
  }
  return order;
}

std::vector<dmat4> place_nodes(std::span<const Node> nodes, const dvec3& center) {
  const dmat4 root = world_around(center);
  std::vector<dmat4> worlds(nodes.size());
  for (const uint32_t i : order_nodes(nodes)) {
    const Node& node = nodes[i];
    worlds[i] = (node.parent == kNoIndex ? root : worlds[node.parent]) * local_matrix(node);
  }
  return worlds;
}

std::optional<dmat3> rotation_of(std::span<const Node> nodes, uint32_t node) {
  dmat3 product(1.0);
  for (; node != kNoIndex; node = nodes[node].parent) {
    const std::optional<dmat3> rotation = local_rotation(nodes[node]);
    if (!rotation) return std::nullopt;
    product = *rotation * product;
  }
  return product;
}

}  // namespace promin
