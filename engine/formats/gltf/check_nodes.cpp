// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

std::string node_place(size_t node) {
  return "nodes[" + std::to_string(node) + "]";
}

/// The parent of each node, -1 for roots.
std::vector<int> find_parents(const json& nodes, LoadReport& report) {
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    size_t position = 0;
    for (const json& child : elements_of(nodes[i], "children")) {
      int& parent = parents[child.get<size_t>()];
      if (parent >= 0) {
        report.refuse(node_place(child.get<size_t>()) + " has two parents, " + node_place(static_cast<size_t>(parent)) +
                          " and " + node_place(i),
                      node_place(i) + ".children[" + std::to_string(position) + "]", "copy the node instead");
      }
      parent = static_cast<int>(i);
      ++position;
    }
  }
  return parents;
}

/// With one parent each, whatever cannot be reached from a root lies on a cycle or below one.
void refuse_cycles(const json& nodes, const std::vector<int>& parents, LoadReport& report) {
  std::vector<size_t> reached;
  std::vector<bool> is_reached(nodes.size(), false);
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (parents[i] < 0) reached.push_back(i);
  }
  while (!reached.empty()) {
    const size_t node = reached.back();
    reached.pop_back();
    if (is_reached[node]) continue;
    is_reached[node] = true;
    for (const json& child : elements_of(nodes[node], "children")) reached.push_back(child.get<size_t>());
  }
  const auto lost = std::find(is_reached.begin(), is_reached.end(), false);
  if (lost != is_reached.end()) {
    report.refuse("the node is its own ancestor or lies below one that is",
                  node_place(static_cast<size_t>(lost - is_reached.begin())), "remove the child that closes the cycle");
  }
}

void check_transform(const json& node, const std::string& place, LoadReport& report) {
  if (node.contains("matrix")) {
    for (const char* property : {"translation", "rotation", "scale"}) {
      if (node.contains(property)) {
        report.refuse(std::string("the node has both a matrix and a ") + property, place, "keep one of them");
      }
    }
    const auto& m = node["matrix"];
    if (m[3].get<double>() != 0.0 || m[7].get<double>() != 0.0 || m[11].get<double>() != 0.0 ||
        m[15].get<double>() != 1.0) {
      report.refuse("the matrix is not affine", place + ".matrix", "make its last row 0 0 0 1");
    }
  }
  const dvec4 rotation = vec4_of(node, "rotation", dvec4(0.0, 0.0, 0.0, 1.0));
  if (glm::dot(rotation, rotation) < 1e-12) {
    report.refuse("the rotation has length 0", place + ".rotation", "use a unit quaternion");
  }
}

}  // namespace

void check_gltf_nodes(const json& document, LoadReport& report) {
  const json& nodes = elements_of(document, "nodes");
  const std::vector<int> parents = find_parents(nodes, report);
  refuse_cycles(nodes, parents, report);
  for (size_t i = 0; i < nodes.size(); ++i) check_transform(nodes[i], node_place(i), report);

  const json& scenes = elements_of(document, "scenes");
  for (size_t s = 0; s < scenes.size(); ++s) {
    std::vector<bool> is_listed(nodes.size(), false);
    const json& listed = elements_of(scenes[s], "nodes");
    for (size_t i = 0; i < listed.size(); ++i) {
      const size_t node = listed[i];
      const std::string place = "scenes[" + std::to_string(s) + "].nodes[" + std::to_string(i) + "]";
      if (parents[node] >= 0) {
        report.refuse(node_place(node) + " is a child of " + node_place(static_cast<size_t>(parents[node])), place,
                      "list root nodes only");
      } else if (is_listed[node]) {
        report.refuse(node_place(node) + " is listed twice", place, "list it once");
      }
      is_listed[node] = true;
    }
  }
}

}  // namespace promin
