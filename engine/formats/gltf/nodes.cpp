// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/nodes.h"

#include <algorithm>

#include <glm/gtc/quaternion.hpp>

#include "core/rounding.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

dmat4 local_transform(const nlohmann::json& node) {
  dmat4 matrix(1.0);
  if (const auto given = node.find("matrix"); given != node.end()) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = (*given)[static_cast<size_t>(i)].get<double>();
    return matrix;
  }
  if (node.contains("rotation")) {
    const dvec4 q = vec4_of(node, "rotation", {});
    matrix = glm::mat4_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
  }
  const dvec3 scale = vec3_of(node, "scale", dvec3(1.0));
  for (int i = 0; i < 3; ++i) matrix[i] *= scale[i];
  matrix[3] = dvec4(vec3_of(node, "translation", dvec3(0.0)), 1.0);
  return matrix;
}

/// The roots of the scene that is shown, or every root in a file without scenes (a library of parts).
std::vector<int> root_nodes(const GltfDocument& document) {
  const nlohmann::json& scenes = elements_of(document.json, "scenes");
  if (!scenes.empty()) return elements_of(scenes[document.scene], "nodes");
  std::vector<bool> is_child(document.nodes.size(), false);
  for (const GltfNode& node : document.nodes) {
    for (const int child : node.children) is_child[static_cast<size_t>(child)] = true;
  }
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, LoadReport& report) {
  std::vector<PlacedNode> placed;
  // The stack is our own, last node first, because files may nest deeper than the machine's stack.
  std::vector<PlacedNode> pending;
  const std::vector<int> roots = root_nodes(document);
  dmat4 from_world(1.0);
  from_world[3] = dvec4(dvec3(0.0) - report.center(), 1.0);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) pending.push_back({*root, from_world, true});
  while (!pending.empty()) {
    PlacedNode next = pending.back();
    pending.pop_back();
    const GltfNode& node = document.nodes[static_cast<size_t>(next.node)];
    const nlohmann::json& source = document.json["nodes"][static_cast<size_t>(next.node)];
    next.world_from_object = next.world_from_object * local_transform(source);
    const nlohmann::json* visibility = find_extension(source, "KHR_node_visibility");
    if (visibility != nullptr) next.is_visible = next.is_visible && visibility->value("visible", true);
    if (!is_finite(next.world_from_object)) {
      report.refuse("the node's place in the world overflows", "nodes[" + std::to_string(next.node) + "]",
                    "use smaller translations and scales in it and its parents");
      continue;
    }
    placed.push_back(next);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      pending.push_back({*child, next.world_from_object, next.is_visible});
    }
  }
  return placed;
}

}  // namespace promin
