// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <utility>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/picture_sources.h"
#include "promin/scene.h"

namespace promin {

/// Reads the textures that materials name, each image once for each use (glTF 2.0, section 3.8).
class GltfTextures {
 public:
  GltfTextures(const GltfDocument& document, LoadReport& report) : document_(document), report_(report) {}

  /// The slot that `info`, the textureInfo `name` of an object, describes; an empty one where there is none.
  TextureSlot read_slot(const nlohmann::json& object, const char* name, ImageUse use);

  /// Decodes all images on all cores and hands everything over. An image that cannot be decoded is warned about and
  /// counts as absent.
  void finish(Scene& scene);

 private:
  uint32_t find_texture(size_t index, ImageUse use);
  uint32_t find_image(int index, ImageUse use);
  void read_file(size_t index, PictureSource& source);

  const GltfDocument& document_;
  LoadReport& report_;
  std::vector<PictureSource> images_;
  std::vector<Texture> textures_;
  std::map<std::pair<int, ImageUse>, uint32_t> image_numbers_;
  std::map<std::pair<size_t, ImageUse>, uint32_t> texture_numbers_;
  std::set<size_t> textures_without_image_;
};

}  // namespace promin
