// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "promin/math.h"

namespace promin {

/// The meaning of an image's texels, which determines how promin computes the image's mip levels.
enum class ImageUse : uint32_t {
  /// sRGB colours with alpha.
  kColor = 0,
  /// Numbers from 0 to 1.
  kData = 1,
  /// Unit vectors, stored as (component + 1) / 2.
  kNormal = 2,
};

/// An image that textures use. If its texels are missing, promin ignores texture slots with this image.
struct TextureImage {
  /// The display name; empty if there is none.
  std::string name;
  /// Width and height. Each is 1...kMaxTextureSide if there are texels.
  uvec2 size{0};
  /// RGBA with 8 bits for each channel, red in the lowest byte. The rows start at v = 0.
  std::vector<uint32_t> texels;
  /// The meaning of the texels.
  ImageUse use = ImageUse::kColor;
};

/// The largest side of a texture image.
inline constexpr uint32_t kMaxTextureSide = 16384;

/// The default of RendererOptions::texture_bytes, the device memory for the images of a scene. It is the same on every
/// device, because pictures depend on it.
inline constexpr uint64_t kDefaultTextureBytes = uint64_t{512} << 20;

/// The continuation of an image beyond its edges.
enum class TextureWrap : uint32_t { kRepeat = 0, kMirroredRepeat = 1, kClampToEdge = 2 };

/// An image with a sampler (glTF 2.0, section 3.8).
struct Texture {
  /// Index into Scene::images.
  uint32_t image = 0;
  /// Wrap mode at the edges u = 0 and 1.
  TextureWrap wrap_u = TextureWrap::kRepeat;
  /// Wrap mode at the edges v = 0 and 1.
  TextureWrap wrap_v = TextureWrap::kRepeat;
  /// True if texels that are larger than pixels are interpolated.
  bool is_magnified_linearly = true;
  /// True if texels that are smaller than pixels are interpolated.
  bool is_minified_linearly = true;
  /// True if promin uses the image's mip levels where texels are smaller than pixels.
  bool has_levels = true;
  /// True if promin interpolates between two mip levels.
  bool are_levels_linear = true;

  /// Returns whether both textures show an image in the same way.
  bool operator==(const Texture&) const = default;
};

/// A reference from a material to a texture.
struct TextureSlot {
  /// The value of `texture` if the slot has no texture.
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  /// Index into Scene::textures.
  uint32_t texture = kNone;
  /// The set of the mesh's texture coordinates, 0 or 1.
  uint32_t uv_set = 0;
  /// Row of the transform of texture coordinates, finite: u = to_u . (s, t, 1), where (s, t) are the mesh's
  /// coordinates.
  vec3 to_u{1.0F, 0.0F, 0.0F};
  /// The second row, finite: v = to_v . (s, t, 1).
  vec3 to_v{0.0F, 1.0F, 0.0F};

  /// Returns whether the slot has a texture.
  bool exists() const { return texture != kNone; }
};

}  // namespace promin
