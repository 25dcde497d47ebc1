// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/math.h"

namespace promin {

/// A skin, posed by the nodes of the file.
struct GltfPose {
  /// For each joint, its transform in the world times its inverse bind matrix, times the inverse of `world_from_mesh`.
  std::vector<dmat4> joint_matrices;
  /// The transform of objects that show posed meshes. It is the identity, or a reflection in x if all joints mirror.
  /// The reflection reverses the winding of triangles, as a mirroring node does for a mesh without a skin.
  dmat4 world_from_mesh{1.0};
  /// True if every joint reduces areas to 0. Such a scale of 0 hides the mesh.
  bool is_hidden = false;
};

/// The skins of a document, each posed once.
class GltfSkins {
 public:
  /// `placed` are the nodes of the visible scene; joints that are not in it use the transforms of their own parents.
  /// The arguments must outlive this object.
  GltfSkins(const GltfDocument& document, const std::vector<PlacedNode>& placed, LoadReport& report);

  bool has_joints(int skin) const;
  /// Returns the pose of a skin that has joints. Reports too few inverse bind matrices.
  const GltfPose& find(int skin);

 private:
  GltfPose make_pose(int skin) const;

  const GltfDocument& document_;
  LoadReport& report_;
  std::vector<dmat4> world_from_node_;
  std::map<int, GltfPose> poses_;
};

}  // namespace promin
