// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/json_text.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/json_rule.h"

namespace promin {
namespace {

using nlohmann::json;

std::string node_place(size_t node) {
  return "nodes[" + std::to_string(node) + "]";
}

/// Removes the elements for which `is_extra` returns true from an array of indices.
template <class IsExtra>
void take_out(json& indices, const IsExtra& is_extra) {
  json kept = json::array();
  for (size_t i = 0; i < indices.size(); ++i) {
    if (!is_extra(indices[i].get<size_t>(), i)) kept.push_back(indices[i]);
  }
  if (kept.size() < indices.size()) indices = std::move(kept);
}

/// Returns the number of parents of each node. Each parent has the node once as a child.
std::vector<uint32_t> count_parents(json& nodes, LoadReport& report) {
  std::vector<uint32_t> parent_counts(nodes.size(), 0);
  // For each node, the last parent that was found.
  std::vector<size_t> parents(nodes.size(), nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].contains("children")) continue;
    take_out(nodes[i]["children"], [&](size_t child, size_t position) {
      const std::string place = node_place(i) + ".children[" + std::to_string(position) + "]";
      if (parents[child] == i) {
        report.repair({"gltf.node.twice", "a node lists a child twice", node_place(child), place, "list it once",
                       "it is shown once"});
        return true;
      }
      if (parent_counts[child]++ > 0) {
        report.repair({"gltf.node.parents", "a node has two parents", node_place(child), place, "copy the node instead",
                       "it appears below both"});
      }
      parents[child] = i;
      return false;
    });
  }
  return parent_counts;
}

/// Refuses cycles. A node that is not reached after all of its parents is on a cycle or below one.
void refuse_cycles(const json& nodes, std::vector<uint32_t> parent_counts, LoadReport& report) {
  std::vector<size_t> reached;
  size_t reached_count = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (parent_counts[i] == 0) reached.push_back(i);
  }
  while (!reached.empty()) {
    const size_t node = reached.back();
    reached.pop_back();
    ++reached_count;
    for (const json& child : elements_of(nodes[node], "children")) {
      if (--parent_counts[child.get<size_t>()] == 0) reached.push_back(child.get<size_t>());
    }
  }
  if (reached_count == nodes.size()) return;
  const auto lost = std::ranges::find_if(parent_counts, [](uint32_t count) { return count > 0; });
  report.refuse("gltf.node.cycle", "the node is its own ancestor, or lies below such a node",
                node_place(static_cast<size_t>(lost - parent_counts.begin())),
                "remove the child that closes the cycle");
}

/// Sets the last row of a matrix to 0 0 0 1.
void make_affine(json& matrix, const std::string& place, bool is_strict, LoadReport& report) {
  for (const size_t i : {3, 7, 11, 15}) {
    const double wanted = i == 15 ? 1.0 : 0.0;
    const auto number = matrix[i].get<double>();
    if (number == wanted) continue;
    if (std::abs(number - wanted) > kMostRounding || is_strict) {
      report.repair({"gltf.matrix.affine", "the matrix is not affine", json_text(matrix[i]),
                     place + ".matrix[" + std::to_string(i) + "]", "make its last row 0 0 0 1",
                     "its last row is read as 0 0 0 1"});
    }
    matrix[i] = wanted;
  }
}

void check_transform(json& node, const std::string& place, bool is_strict, LoadReport& report) {
  if (node.contains("matrix")) {
    make_affine(node["matrix"], place, is_strict, report);
    if (node.erase("translation") + node.erase("rotation") + node.erase("scale") > 0) {
      report.repair({"gltf.node.transform", "a node has both a matrix and a translation, rotation or scale", "", place,
                     "keep one of them", "the matrix is used"});
    }
  }
  const dvec4 rotation = vec4_of(node, "rotation", dvec4(0.0, 0.0, 0.0, 1.0));
  if (glm::dot(rotation, rotation) >= 1e-12) return;
  report.repair({"gltf.rotation.zero", "a rotation has length 0", "", place + ".rotation", "use a unit quaternion",
                 "the node is not turned"});
  node.erase("rotation");
}

/// Marks the nodes below a node.
void mark_below(const json& nodes, size_t node, std::vector<bool>& is_below) {
  std::vector<size_t> pending{node};
  while (!pending.empty()) {
    const size_t next = pending.back();
    pending.pop_back();
    for (const json& child : elements_of(nodes[next], "children")) {
      if (is_below[child.get<size_t>()]) continue;
      is_below[child.get<size_t>()] = true;
      pending.push_back(child.get<size_t>());
    }
  }
}

/// Removes a node from a scene's list if the list has it twice or if it is below another listed node.
void check_scene(json& listed, const json& nodes, const std::vector<uint32_t>& parent_counts, const std::string& place,
                 LoadReport& report) {
  std::vector<bool> is_listed(nodes.size(), false);
  std::vector<bool> is_below(nodes.size(), false);
  for (const json& node : listed) mark_below(nodes, node.get<size_t>(), is_below);
  take_out(listed, [&](size_t node, size_t i) {
    const std::string at = place + ".nodes[" + std::to_string(i) + "]";
    const bool is_twice = is_listed[node];
    is_listed[node] = true;
    if (is_twice) {
      report.repair(
          {"gltf.node.twice", "a scene lists a node twice", node_place(node), at, "list it once", "it is shown once"});
    } else if (is_below[node]) {
      report.repair({"gltf.node.root", "a scene lists a node that lies below another", node_place(node), at,
                     "list only root nodes", "it is shown once, below that node"});
    } else if (parent_counts[node] > 0) {
      report.repair({"gltf.node.root", "a scene lists a node that has a parent", node_place(node), at,
                     "list only root nodes", "it is shown as a root, without the parent's transform"});
    }
    return is_twice || is_below[node];
  });
}

}  // namespace

void check_gltf_nodes(json& document, bool is_strict, LoadReport& report) {
  if (!document.contains("nodes")) return;
  json& nodes = document["nodes"];
  const std::vector<uint32_t> parent_counts = count_parents(nodes, report);
  refuse_cycles(nodes, parent_counts, report);
  for (size_t i = 0; i < nodes.size(); ++i) check_transform(nodes[i], node_place(i), is_strict, report);
  if (!document.contains("scenes")) return;
  json& scenes = document["scenes"];
  for (size_t i = 0; i < scenes.size(); ++i) {
    if (!scenes[i].contains("nodes")) continue;
    check_scene(scenes[i]["nodes"], nodes, parent_counts, "scenes[" + std::to_string(i) + "]", report);
  }
}

}  // namespace promin
