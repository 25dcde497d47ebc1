// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "formats/gltf/document.h"
#include "motion/skin.h"
#include "promin/math.h"
#include "promin/motion.h"

namespace promin {

/// The skins of a document.
class GltfSkins {
 public:
  /// The arguments must outlive this object. Reports skins without joints.
  GltfSkins(const GltfDocument& document, LoadReport& report);

  bool has_joints(int skin) const { return !skins_[static_cast<size_t>(skin)].joints.empty(); }
  /// Returns the skin in the pose of nodes with these transforms, which are the same in each call. Reports too few
  /// inverse bind matrices, and joints whose transforms overflow.
  const PosedSkin& find(int skin, std::span<const dmat4> world_from_node);
  /// Returns all skins. A skin that find() has not returned has no inverse bind matrices.
  std::vector<Skin> take() { return std::move(skins_); }

 private:
  const GltfDocument& document_;
  LoadReport& report_;
  std::vector<Skin> skins_;
  std::map<int, PosedSkin> poses_;
};

}  // namespace promin
