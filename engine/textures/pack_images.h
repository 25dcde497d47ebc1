// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/unset_vector.h"
#include "promin/error.h"
#include "promin/textures.h"

namespace promin {

/// How a scene's images fit into a number of bytes.
struct TextureFit {
  /// How often each image is halved.
  std::vector<uint32_t> halvings;
  /// The bytes of all images with their levels as they are, and as they are packed.
  uint64_t whole_bytes = 0;
  uint64_t bytes = 0;
};

/// Halves the largest image, of equal ones the first, until all fit in `most_bytes`, and in the 8 GiB that words are
/// numbered in. Throws RunError where they do not even as single texels.
TextureFit fit_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                      uint64_t most_bytes);

/// Says which images are halved, if any are.
std::optional<Problem> warn_of(const TextureFit& fit);

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
  /// See warn_of.
  std::optional<Problem> warning;
};

/// Packs images on all cores, with levels down to one texel where a texture asks for levels. Each texel of a level is
/// the mean over its area, of colours in linear light. `cutoffs` has, for each image of a mask, from which alpha on it
/// is there, for all others 0; empty: there are no masks. Levels of masks keep the share that is
/// (textures/alpha_coverage.h). An image that is halved to fit (fit_images) begins with the level of that size, whether
/// it has further ones or not. Throws RunError as fit_images does.
PackedImages pack_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                         uint64_t most_bytes = kDefaultTextureBytes, std::span<const float> cutoffs = {});

/// The bytes that these images take when they are packed and none is halved, by their sizes: their texels need not be
/// there.
uint64_t packed_image_bytes(std::span<const std::shared_ptr<const TextureImage>> images,
                            std::span<const Texture> textures);

}  // namespace promin
