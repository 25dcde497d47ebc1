// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/document.h"
#include "promin/math.h"

namespace promin {

/// A node as the traversal meets it.
struct PlacedNode {
  int node = 0;
  /// Composed in double.
  dmat4 world_from_object{1.0};
  /// The rotations of the node and everything above it alone, for what has a direction and no size. None where a matrix
  /// among them has no rotation.
  std::optional<dmat3> rotation{dmat3(1.0)};
  /// KHR_node_visibility of the node and everything above it.
  bool is_visible = true;
};

/// Whether a transform leaves no area of anything: its scale is 0 along two axes or more.
bool has_no_area(const dmat4& world_from_object);

/// The nodes of the default scene, depth first, parents before children: the order that numbers objects and cameras. A
/// node with several parents is placed below each. Nodes whose transform overflows go to the report, and so do more
/// places than the file's nodes and 2^18 more.
std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, LoadReport& report);

/// Where each node of the file is in the world, at its index. A node of the scene is at its first place among `placed`;
/// another stands below its parents, which may be in no scene, around the `center` of the scene. The transform may
/// overflow.
std::vector<dmat4> place_all_gltf_nodes(const GltfDocument& document, const std::vector<PlacedNode>& placed,
                                        const dvec3& center);

}  // namespace promin
