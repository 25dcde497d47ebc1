// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "promin/math.h"

namespace promin {

/// What the texels of an image mean, which decides how its smaller levels are made.
enum class ImageUse : uint32_t {
  /// Colours of sRGB, with alpha.
  kColor = 0,
  /// Numbers from 0 to 1.
  kData = 1,
  /// Unit vectors, as (component + 1) / 2.
  kNormal = 2,
};

/// A picture that textures show. An image whose texels are missing counts as absent: its slots are ignored.
struct TextureImage {
  /// For people; empty where there is none.
  std::string name;
  /// Width and height, each 1...kMaxTextureSide where there are texels.
  uvec2 size{0};
  /// RGBA, 8 bits each, red in the lowest byte, row after row from v = 0 on.
  std::vector<uint32_t> texels;
  /// What they mean.
  ImageUse use = ImageUse::kColor;
};

/// The longest side of an image of a texture.
inline constexpr uint32_t kMaxTextureSide = 16384;

/// Most bytes of device memory that the images of a scene take, unless RendererOptions::texture_bytes says otherwise:
/// the same on every device, because pictures depend on it.
inline constexpr uint64_t kDefaultTextureBytes = uint64_t{512} << 20;

/// What lies beyond the edge of an image.
enum class TextureWrap : uint32_t { kRepeat = 0, kMirroredRepeat = 1, kClampToEdge = 2 };

/// An image as surfaces show it (glTF 2.0, section 3.8).
struct Texture {
  /// Index into Scene::images.
  uint32_t image = 0;
  /// Beyond the edges at u = 0 and 1.
  TextureWrap wrap_u = TextureWrap::kRepeat;
  /// Beyond the edges at v = 0 and 1.
  TextureWrap wrap_v = TextureWrap::kRepeat;
  /// Whether texels are interpolated where they are larger than pixels.
  bool is_magnified_linearly = true;
  /// Whether they are where they are smaller.
  bool is_minified_linearly = true;
  /// Whether smaller levels stand in where texels are smaller than pixels.
  bool has_levels = true;
  /// Whether levels are interpolated.
  bool are_levels_linear = true;
};

/// A texture in its place in a material.
struct TextureSlot {
  /// The value of `texture` where there is none.
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  /// Index into Scene::textures.
  uint32_t texture = kNone;
  /// Which of the mesh's texture coordinates, 0 or 1.
  uint32_t uv_set = 0;
  /// u = to_u . (s, t, 1) of the coordinates (s, t) of the mesh, finite.
  vec3 to_u{1.0F, 0.0F, 0.0F};
  /// v likewise.
  vec3 to_v{0.0F, 1.0F, 0.0F};

  /// Whether there is a texture.
  bool exists() const { return texture != kNone; }
};

}  // namespace promin
