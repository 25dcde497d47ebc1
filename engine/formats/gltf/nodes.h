// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "promin/math.h"

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
};

/// Returns whether a transform reduces every area to 0, because its scale is 0 along at least two axes.
bool has_no_area(const dmat4& world_from_object);

/// Returns the nodes of the default scene, depth first and parents before children, which is the order of objects and
/// cameras. A node with several parents appears below each parent. Reports transforms that overflow. Also reports if
/// the result has more than 2^18 nodes more than the file.
std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, LoadReport& report);

/// Returns the transform to the world of each node of the file, by its index. The transform of a node in the scene is
/// its first transform in `placed`. The transform of any other node is computed from its parents, which need not be in
/// a scene, relative to the `center` of the scene. Transforms may overflow.
std::vector<dmat4> place_all_gltf_nodes(const GltfDocument& document, const std::vector<PlacedNode>& placed,
                                        const dvec3& center);

}  // namespace promin
