// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/picture_sources.h"
#include "promin/scene.h"

namespace promin {

/// Reads the textures to which materials refer. Each image is read once for each of its uses (glTF 2.0, section 3.8).
class GltfTextures {
 public:
  /// `decodes_images` is LoadOptions::decodes_images.
  GltfTextures(const GltfDocument& document, bool decodes_images, LoadReport& report)
      : document_(document), decodes_images_(decodes_images), report_(report) {}

  /// Returns the slot for the textureInfo `name` of an object; an empty one if there is none.
  TextureSlot read_slot(const nlohmann::json& object, const char* name, ImageUse use);

  /// Returns the slot for a specularGlossinessTexture, as a slot of roughness. The green channel of its image becomes 1
  /// - glossiness_factor * glossiness.
  TextureSlot read_glossiness_slot(const nlohmann::json& object, const char* name, float glossiness_factor);

  /// Decodes all images, or reads their sizes, on all cores and stores everything in the scene. An image that cannot be
  /// decoded causes a warning and counts as absent.
  void finish(Scene& scene);

 private:
  /// The purpose of an image: its use, and for a specularGlossinessTexture the factor.
  using Purpose = std::pair<ImageUse, std::optional<float>>;

  TextureSlot read_slot_for(const nlohmann::json& object, const char* name, const Purpose& purpose);
  uint32_t find_texture(size_t index, const Purpose& purpose);
  uint32_t find_image(int index, const Purpose& purpose);
  void restore_roughness(Material& material) const;

  const GltfDocument& document_;
  bool decodes_images_;
  LoadReport& report_;
  std::vector<PictureSource> images_;
  /// The factors of specularGlossinessTextures, by the index of the image.
  std::map<uint32_t, float> glossiness_factors_;
  std::vector<Texture> textures_;
  std::map<std::pair<int, Purpose>, uint32_t> image_numbers_;
  std::map<std::pair<size_t, Purpose>, uint32_t> texture_numbers_;
  std::set<size_t> textures_without_image_;
};

}  // namespace promin
