// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "promin/math.h"
#include "promin/motion.h"

namespace promin {

/// A node at a place in the scene, with its transform to the world.
struct PlacedNode {
  int node = 0;
  /// The transform to the world, composed in double.
  dmat4 world_from_object{1.0};
  /// The product of the rotations of the node and its ancestors, for objects that have a direction but no size. Empty
  /// if one of the matrices has no rotation.
  std::optional<dmat3> rotation{dmat3(1.0)};
  /// True if the node is visible, according to KHR_node_visibility of the node and its ancestors.
  bool is_visible = true;
  /// The node's index in Motion::nodes. It differs from `node` if the node appears again below another parent.
  uint32_t index = kNoIndex;
};

/// Returns the nodes of the default scene, depth first and parents before children, which is the order of objects and
/// cameras. A node with several parents appears below each parent. Reports transforms that overflow. Also reports if
/// the result has more than 2^18 nodes more than the file.
///
/// `nodes` receives all nodes of the file, in its order, and then those that appear again. A node in the scene has its
/// parent in the scene. Any other node has one of its parents, because joints of skins need not be in a scene.
std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, std::vector<Node>& nodes, LoadReport& report);

}  // namespace promin
