// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/nodes.h"

#include <algorithm>
#include <optional>

#include "core/rounding.h"
#include "core/utf8.h"
#include "formats/gltf/json_lookup.h"
#include "motion/node_state.h"

namespace promin {
namespace {

Node read_node(const GltfDocument& document, size_t index) {
  const nlohmann::json& source = document.json["nodes"][index];
  const GltfNode& typed = document.nodes[index];
  Node node;
  node.name = to_utf8(typed.name);
  if (const auto given = source.find("matrix"); given != source.end()) {
    node.matrix.emplace();
    for (int i = 0; i < 16; ++i) (*node.matrix)[i / 4][i % 4] = (*given)[static_cast<size_t>(i)].get<double>();
  }
  node.trs.translation = vec3_of(source, "translation", node.trs.translation);
  node.trs.rotation = vec4_of(source, "rotation", node.trs.rotation);
  node.trs.scale = vec3_of(source, "scale", node.trs.scale);
  const nlohmann::json* visibility = find_extension(source, "KHR_node_visibility");
  if (visibility != nullptr) node.is_visible = visibility->value("visible", true);
  if (typed.mesh >= 0) {
    const GltfMesh& mesh = document.meshes[static_cast<size_t>(typed.mesh)];
    node.weights = typed.weights ? *typed.weights : mesh.weights;
    size_t target_count = 0;
    for (const GltfPrimitive& primitive : mesh.primitives) {
      target_count = std::max(target_count, primitive.targets.size());
    }
    node.weights.resize(target_count);
  }
  return node;
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

/// Sets the parents of nodes that are not placed. Each gets the parent below which it is found first.
void find_other_parents(const GltfDocument& document, std::vector<bool> is_placed, std::vector<Node>& nodes) {
  std::vector<int> pending = find_roots(document);
  while (!pending.empty()) {
    const auto node = static_cast<size_t>(pending.back());
    pending.pop_back();
    // A node below a node of the scene already has its parent.
    if (is_placed[node]) continue;
    is_placed[node] = true;
    for (const int child : document.nodes[node].children) {
      if (is_placed[static_cast<size_t>(child)]) continue;
      nodes[static_cast<size_t>(child)].parent = static_cast<uint32_t>(node);
      pending.push_back(child);
    }
  }
}

}  // namespace

std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, std::vector<Node>& nodes, LoadReport& report) {
  const size_t count = document.nodes.size();
  nodes.reserve(count);
  for (size_t i = 0; i < count; ++i) nodes.push_back(read_node(document, i));
  std::vector<bool> is_placed(count, false);
  std::vector<PlacedNode> placed;
  // The code has its own stack, with the last node first, because files may have deeper nesting than the machine's
  // stack allows. PlacedNode::index is that of the parent until the node is placed.
  std::vector<PlacedNode> pending;
  const std::vector<int> roots = root_nodes(document);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
    pending.push_back({.node = *root, .world_from_object = world_around(report.center())});
  }
  while (!pending.empty()) {
    PlacedNode next = pending.back();
    pending.pop_back();
    const auto own = static_cast<size_t>(next.node);
    const std::optional<dmat3> rotation = local_rotation(nodes[own]);
    next.world_from_object = next.world_from_object * local_matrix(nodes[own]);
    if (next.rotation) next.rotation = rotation ? std::optional(*next.rotation * *rotation) : std::nullopt;
    next.is_visible = next.is_visible && nodes[own].is_visible;
    if (!is_finite(next.world_from_object)) {
      report.refuse("gltf.node.far", "the node's position in the world is too large for floating-point numbers",
                    "nodes[" + std::to_string(next.node) + "]",
                    "use smaller translations and scales in it and its parents");
      continue;
    }
    const uint32_t parent = next.index;
    next.index = static_cast<uint32_t>(own);
    if (is_placed[own]) {
      next.index = static_cast<uint32_t>(nodes.size());
      nodes.push_back({.name = nodes[own].name, .same_as = static_cast<uint32_t>(own)});
    }
    is_placed[own] = true;
    nodes[next.index].parent = parent;
    placed.push_back(next);
    if (placed.size() > count + kMostFurtherPlaces) {
      report.refuse("gltf.node.parents", "the nodes with several parents appear in too many places", "nodes",
                    "give each node one parent");
      return {};
    }
    const std::vector<int>& children = document.nodes[own].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      pending.push_back({*child, next.world_from_object, next.rotation, next.is_visible, next.index});
    }
  }
  find_other_parents(document, is_placed, nodes);
  return placed;
}

}  // namespace promin
