// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "promin/export.h"
#include "promin/scene.h"

namespace promin {

/// Options for reading a scene.
struct LoadOptions {
  /// Whether to refuse a file that breaks any rule of its format or requires an extension that promin does not know
  /// (glTF 2.0, section 3.12). Otherwise all geometry that can be drawn is drawn, and a fault in its colours, shading,
  /// cameras or lights only causes a warning (docs/usage.md, "What is read").
  bool is_strict = false;
  /// A further folder, besides the scene's own, whose files the scene may refer to; links are resolved first. Empty for
  /// none. A trusted scene may thus read files that are links into a store, or textures in "../textures".
  std::filesystem::path root = {};
  /// The material variant to use (KHR_materials_variants), one of Scene::variants; empty for the file's default
  /// materials.
  std::string material_variant = {};
  /// Whether to decode the texels of images. Otherwise only their sizes are read from the file headers, which is enough
  /// to describe a scene and takes a fraction of the time. Images of OBJ files are always decoded, because some of them
  /// combine the texels of two pictures.
  bool decodes_images = true;
};

/// Reads a scene file; its ending determines the format: .gltf, .glb, .obj, .ply, .stl or .nff. Returns a valid scene
/// (promin/validate.h). No lights are added to a scene without lights, see light_scene (promin/lighting.h). Warnings
/// are stored in Scene::warnings. Throws InputError with all problems found, each with place and cure, and UsageError
/// if the material variant does not exist or the root is not a folder. Any thread may call this function.
PROMIN_EXPORT Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace promin
