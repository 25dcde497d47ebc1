// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "promin/export.h"
#include "promin/scene.h"

namespace promin {

/// How a scene is read.
struct LoadOptions {
  /// Whether a file is refused for anything that its format forbids, and for each extension that it requires and promin
  /// does not know (glTF 2.0, section 3.12). Otherwise geometry that can be drawn is drawn: a fault of what only
  /// colours, shades, views or lights it costs one warning (docs/usage.md, "What is read").
  bool is_strict = false;
  /// A folder besides the scene's own in which files may lie that the scene names, links resolved; empty: none. It
  /// widens what a trusted scene may read: files whose links lead into a store, textures in "../textures".
  std::filesystem::path root = {};
  /// The variant of materials that is shown (KHR_materials_variants), one of Scene::variants; empty: the materials that
  /// hold without any.
  std::string material_variant = {};
  /// Whether images of materials get their texels. Without them only their sizes are read, from the heads of their
  /// files: enough to tell what a scene holds, in a fraction of the time. OBJ files have them always, because some of
  /// their images are made of the texels of two pictures.
  bool decodes_images = true;
};

/// Reads a scene by its ending: .gltf, .glb, .obj, .ply, .stl or .nff. The scene comes back valid (promin/validate.h).
/// A scene without lights stays without, see light_scene (promin/lighting.h). Throws InputError with every problem
/// found, each with place and cure, and UsageError where it has no such variant of materials or the root is no folder;
/// warnings lie in Scene::warnings. Any thread may call it.
PROMIN_EXPORT Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace promin
