// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/unset_vector.h"
#include "promin/textures.h"

namespace promin {

/// Where an image lies among the words of PackedImages.
struct PlacedImage {
  /// The first word: the places of its levels, counted from here, then their texels.
  uint32_t first = 0;
  uvec2 size{0};
  /// 0 where the image is absent.
  uint32_t levels = 0;
  ImageUse use = ImageUse::kColor;
};

/// The images of a scene as shaders/textures.glsl reads them.
struct PackedImages {
  UnsetVector<uint32_t> words;
  std::vector<PlacedImage> images;
};

/// Packs images on all cores, with levels down to one texel where a texture asks for levels. Each texel of a level is
/// the mean over its area, of colours in linear light. Throws RunError where all take more than kMostTextureBytes.
PackedImages pack_images(std::span<const std::shared_ptr<const TextureImage>> images,
                         std::span<const Texture> textures);

/// Most memory of a scene's images, so that pictures do not depend on the device's.
inline constexpr uint64_t kMostTextureBytes = uint64_t{512} << 20;

}  // namespace promin
