// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "promin/textures.h"

namespace promin {

/// The mean light of the parts of an image that a texture of emission shows, for the chances of triangles as sources of
/// light (docs/model.md, "Surfaces that emit light").
class EmissionMap {
 public:
  /// Prepares an image of sRGB texels in the form of TextureImage::texels.
  EmissionMap(std::span<const uint32_t> texels, const uvec2& size);

  /// Returns about the mean of the light on a triangle with these coordinates, linear RGB. It is 0 only if no point of
  /// the triangle shows a texel with light, also where texels are interpolated.
  vec3 mean_on(const std::array<dvec2, 3>& corners, const Texture& texture) const;

 private:
  /// Squares of texels. Their largest channel is 0 if all of their texels are black.
  struct Level {
    glm::ivec2 size{0};
    std::vector<vec3> means;
    std::vector<float> largest;
  };
  void add_level();

  uvec2 size_;
  /// The number of texels along a side of the squares of the finest level; each further level has squares of twice this
  /// side, down to one square.
  uint32_t side_ = 1;
  std::vector<Level> levels_;
};

}  // namespace promin
