// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/nodes.h"

#include <algorithm>
#include <utility>

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

/// Returns the rotation of a node without its ancestors; nullopt if its matrix has no rotation.
std::optional<dmat3> local_rotation(const nlohmann::json& node) {
  if (!node.contains("matrix")) {
    const dvec4 q = vec4_of(node, "rotation", dvec4(0.0, 0.0, 0.0, 1.0));
    return glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z)));
  }
  const dmat3 matrix(local_transform(node));
  const dvec3 z = glm::normalize(matrix[2]);
  const dvec3 x = glm::normalize(glm::cross(matrix[1], z));
  const dmat3 rotation(x, glm::cross(z, x), z);
  if (!is_finite(dmat4(rotation))) return std::nullopt;
  return rotation;
}

/// Returns the transform from the file's world to the scene's world, whose origin is the center.
dmat4 world_around(const dvec3& center) {
  dmat4 place(1.0);
  place[3] = dvec4(dvec3(0.0) - center, 1.0);
  return place;
}

/// Returns the nodes without parents.
std::vector<int> find_roots(const GltfDocument& document) {
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

/// Returns the roots of the scene that is shown, or all roots if the file has no scenes (a library of parts).
std::vector<int> root_nodes(const GltfDocument& document) {
  const nlohmann::json& scenes = elements_of(document.json, "scenes");
  return scenes.empty() ? find_roots(document) : elements_of(scenes[document.scene], "nodes").get<std::vector<int>>();
}

/// The largest number of further places of nodes. A node with several parents appears several times, so the size of the
/// file does not limit the number of places.
constexpr size_t kMostFurtherPlaces = size_t{1} << 18;

}  // namespace

bool has_no_area(const dmat4& world_from_object) {
  const dmat3 m(world_from_object);
  const dvec3 zero(0.0);
  return glm::cross(m[0], m[1]) == zero && glm::cross(m[1], m[2]) == zero && glm::cross(m[2], m[0]) == zero;
}

std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, LoadReport& report) {
  std::vector<PlacedNode> placed;
  // The code has its own stack, with the last node first, because files may have deeper nesting than the machine's
  // stack allows.
  std::vector<PlacedNode> pending;
  const std::vector<int> roots = root_nodes(document);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
    pending.push_back({.node = *root, .world_from_object = world_around(report.center())});
  }
  while (!pending.empty()) {
    PlacedNode next = pending.back();
    pending.pop_back();
    const GltfNode& node = document.nodes[static_cast<size_t>(next.node)];
    const nlohmann::json& source = document.json["nodes"][static_cast<size_t>(next.node)];
    next.world_from_object = next.world_from_object * local_transform(source);
    const std::optional<dmat3> rotation = local_rotation(source);
    if (next.rotation) next.rotation = rotation ? std::optional(*next.rotation * *rotation) : std::nullopt;
    const nlohmann::json* visibility = find_extension(source, "KHR_node_visibility");
    if (visibility != nullptr) next.is_visible = next.is_visible && visibility->value("visible", true);
    if (!is_finite(next.world_from_object)) {
      report.refuse("gltf.node.far", "the node's position in the world is too large for floating-point numbers",
                    "nodes[" + std::to_string(next.node) + "]",
                    "use smaller translations and scales in it and its parents");
      continue;
    }
    placed.push_back(next);
    if (placed.size() > document.nodes.size() + kMostFurtherPlaces) {
      report.refuse("gltf.node.parents", "the nodes with several parents appear in too many places", "nodes",
                    "give each node one parent");
      return {};
    }
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      pending.push_back({*child, next.world_from_object, next.rotation, next.is_visible});
    }
  }
  return placed;
}

std::vector<dmat4> place_all_gltf_nodes(const GltfDocument& document, const std::vector<PlacedNode>& placed,
                                        const dvec3& center) {
  const size_t count = document.nodes.size();
  std::vector<dmat4> worlds(count, dmat4(1.0));
  std::vector<bool> is_placed(count, false);
  for (const PlacedNode& place : placed) {
    const auto node = static_cast<size_t>(place.node);
    if (is_placed[node]) continue;
    worlds[node] = place.world_from_object;
    is_placed[node] = true;
  }
  std::vector<std::pair<int, dmat4>> pending;
  for (const int root : find_roots(document)) pending.emplace_back(root, world_around(center));
  while (!pending.empty()) {
    const auto [next, world_from_parent] = pending.back();
    pending.pop_back();
    const auto node = static_cast<size_t>(next);
    // A node below a node of the scene already has its transform.
    if (is_placed[node]) continue;
    is_placed[node] = true;
    worlds[node] = world_from_parent * local_transform(document.json["nodes"][node]);
    for (const int child : document.nodes[node].children) pending.emplace_back(child, worlds[node]);
  }
  return worlds;
}

}  // namespace promin
