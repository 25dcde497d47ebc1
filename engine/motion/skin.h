// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "promin/motion.h"

namespace promin {

/// A skin in one pose.
struct PosedSkin {
  /// For each joint, its transform to the scene times its inverse bind matrix, times the inverse of `world_from_mesh`.
  std::vector<dmat4> joint_matrices;
  /// The transform of objects that show posed meshes. It is the identity, or a reflection in x if all joints mirror.
  /// The reflection reverses the winding of triangles, as a mirroring node does for a mesh without a skin.
  dmat4 world_from_mesh{1.0};
  /// True if every joint reduces areas to 0. Such a scale of 0 hides the mesh.
  bool is_hidden = false;
};

/// Returns whether a transform reduces every area to 0, because its scale is 0 along at least two axes.
bool has_no_area(const dmat4& world_from_object);

/// Returns a skin in a pose. `world_from_node` are the transforms of all nodes. The result may not be finite.
PosedSkin pose_skin(const Skin& skin, std::span<const dmat4> world_from_node);

}  // namespace promin
