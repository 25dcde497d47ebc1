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
  /// If true, the loader refuses a file that breaks any rule of its format or requires an extension that promin does
  /// not know (glTF 2.0, section 3.12). Otherwise promin draws all geometry that can be drawn, and a fault in colours,
  /// shading, cameras or lights only causes a warning (docs/usage.md, "What is read").
  bool is_strict = false;
  /// A folder whose files the scene may refer to, in addition to the files in the scene's own folder. Symbolic links
  /// are resolved first. Empty if there is no such folder. With it, a trusted scene can refer to links into another
  /// folder or to textures in "../textures".
  std::filesystem::path root = {};
  /// The material variant to use (KHR_materials_variants), one of Scene::variants; empty for the file's default
  /// materials.
  std::string material_variant = {};
  /// If true, the loader decodes the texels of images. If false, it reads only their sizes from the file headers, which
  /// is enough to describe a scene and takes a fraction of the time. Images of OBJ files are always decoded, because
  /// some of them combine the texels of two pictures.
  bool decodes_images = true;
};

/// Reads a scene file; the file name's extension determines the format: .gltf, .glb, .obj, .ply, .stl or .nff. Returns
/// a valid scene (promin/validate.h). The function adds no lights to a scene without lights; light_scene()
/// (promin/lighting.h) does. Warnings are stored in Scene::warnings. Throws InputError with all problems found, each
/// with place and cure, and UsageError if the material variant does not exist or the root is not a folder. Any thread
/// may call this function.
PROMIN_EXPORT Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace promin
