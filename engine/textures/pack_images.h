// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/unset_vector.h"
#include "promin/error.h"
#include "promin/textures.h"

namespace promin {

/// The sizes at which a scene's images fit into the allowed number of bytes.
struct TextureFit {
  /// The number of times that each image is halved.
  std::vector<uint32_t> halvings;
  /// Number of bytes of all images with their levels, at full size and as packed.
  uint64_t whole_bytes = 0;
  uint64_t bytes = 0;
};

/// Halves the largest image until all images fit in `most_bytes` and in the 8 GiB that word indices can address. If
/// images are equally large, the first is halved. Throws RunError if they do not fit even as single texels.
TextureFit fit_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                      uint64_t most_bytes);

/// Returns a warning about the halved images, if there are any.
std::optional<Problem> warn_of(const TextureFit& fit);

/// The largest number of images of a bundle, and of those with sRGB colours. The words of a bundle's texel are one
/// texel of shading data.
inline constexpr uint32_t kMostBundled = 4;
inline constexpr uint32_t kMostColorsBundled = 2;

/// Images of equal size and with equally many levels whose texels lie side by side, so that a shader reads all of them
/// at once. Indices of images, those with colours first.
using ImageBundle = std::vector<uint32_t>;

/// The position of an image among the words of PackedImages.
struct PlacedImage {
  /// Index of the first word of the image, or of its bundle. The positions of the levels, relative to this word, come
  /// first; the texels follow. A bundle begins at a multiple of its stride.
  uint32_t first = 0;
  uvec2 size{0};
  /// Number of levels; 0 if the image is absent.
  uint32_t levels = 0;
  ImageUse use = ImageUse::kColor;
  /// The number of words from a texel to the next: 1 for an image that stands alone, 2 or 4 in a bundle.
  uint32_t stride = 1;
  /// The image's place in its bundle, and the number of words by which its texels follow those of the bundle.
  uint32_t place = 0;
  /// Whether the first and the second image of the bundle have colours; of an image that stands alone, whether it has.
  std::array<bool, kMostColorsBundled> has_colors{};
};

/// The images of a scene in the form that shaders/shade/textures.glsl reads.
struct PackedImages {
  UnsetVector<uint32_t> words;
  std::vector<PlacedImage> images;
  /// The warning of warn_of(), if images were halved.
  std::optional<Problem> warning;
};

/// Packs images on all cores, with levels down to one texel if a texture uses levels. Each texel of a level is the mean
/// over its area; colours are averaged in linear light. `cutoffs` has the alpha cutoff for each image of a mask and 0
/// for all others; empty if there are no masks. Levels of masks keep the fraction of texels that are present
/// (textures/alpha_coverage.h). An image that is halved to fit (fit_images) begins with the level of that size, even if
/// it has no further levels. Each of the `bundles` has at least two images; an image is in one bundle at most, and has
/// no cutoff. Three images take the memory of four. If images do not fit with all bundles, none is a bundle. Throws
/// RunError as fit_images() does.
PackedImages pack_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                         uint64_t most_bytes = kDefaultTextureBytes, std::span<const float> cutoffs = {},
                         std::span<const ImageBundle> bundles = {});

/// Returns the packed size in bytes of these images without halving and without bundles, computed from their sizes;
/// their texels may be missing.
uint64_t packed_image_bytes(std::span<const std::shared_ptr<const TextureImage>> images,
                            std::span<const Texture> textures);

}  // namespace promin
