// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "promin/math.h"

namespace promin {

/// A node as the traversal meets it.
struct PlacedNode {
  int node = 0;
  /// Composed in double.
  dmat4 world_from_object{1.0};
  /// KHR_node_visibility of the node and everything above it.
  bool is_visible = true;
};

/// The nodes of the default scene, depth first, parents before children: the order that numbers objects and cameras.
/// Nodes whose transform overflows go to the report.
std::vector<PlacedNode> place_gltf_nodes(const GltfDocument& document, LoadReport& report);

}  // namespace promin
