// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "promin/motion.h"

namespace promin {

/// Returns the animations of a document, in its order (glTF 2.0, section 3.11, and KHR_animation_pointer). `nodes` are
/// the document's nodes.
///
/// A channel that would move wrongly is left out with a warning, so that its property stands still. This happens if its
/// keys are not in order, if its numbers are not finite or one of its rotations has length 0. It also happens if its
/// target does not exist, or if another channel changes the same property. Wrong counts of values become problems of
/// the animation (Animation::problems), because its keys would read wrong values.
std::vector<Animation> read_gltf_animations(const GltfDocument& document, const std::vector<Node>& nodes,
                                            LoadReport& report);

/// The things that animations change, by their indices in the document.
struct GltfAnimated {
  /// True for nodes whose place may change, because an animation changes the transform or the visibility of the node or
  /// of an ancestor. The indices are those of Motion::nodes.
  std::vector<bool> is_moved;
  /// The same for visibility alone.
  std::vector<bool> is_hidden;
  /// True for nodes whose weights of morph targets change.
  std::vector<bool> is_morphed;
  /// True for materials that change.
  std::vector<bool> is_material_changed;
};

/// Returns the transforms of all texture slots of a material of the document that animations may change
/// (MaterialLink::textures).
std::vector<TextureLink> read_gltf_texture_links(const nlohmann::json& material);

/// Returns the things that animations change. Nodes that have the state of another node change like it.
GltfAnimated find_gltf_animated(const std::vector<Animation>& animations, const std::vector<Node>& nodes,
                                size_t material_count);

}  // namespace promin
