// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/math.h"

namespace promin {

/// A skin as the nodes of the file stand.
struct GltfPose {
  /// For each joint, its transform in the world times its inverse bind matrix, times the inverse of `world_from_mesh`.
  std::vector<dmat4> joint_matrices;
  /// What the objects have that show posed meshes: the identity, or where all joints mirror a reflection in x, which
  /// turns the winding of triangles as the mirroring node of an unskinned mesh does.
  dmat4 world_from_mesh{1.0};
  /// Whether no joint leaves any area of anything: such a scale of 0 hides the mesh.
  bool is_hidden = false;
};

/// The skins of a document, each posed once.
class GltfSkins {
 public:
  /// `placed` are the nodes of the scene that is shown; other joints stand by their own parents. The arguments outlive
  /// this.
  GltfSkins(const GltfDocument& document, const std::vector<PlacedNode>& placed, LoadReport& report);

  bool has_joints(int skin) const;
  /// The pose of a skin that has joints. Too few inverse bind matrices go to the report.
  const GltfPose& find(int skin);

 private:
  GltfPose make_pose(int skin) const;

  const GltfDocument& document_;
  LoadReport& report_;
  std::vector<dmat4> world_from_node_;
  std::map<int, GltfPose> poses_;
};

}  // namespace promin
