// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "oracle/oracle.h"

/// Textures as defined by docs/model.md ("Textures") and glTF 2.0, section 3.8, with exact sRGB, and the errors that a
/// device may have.
namespace promin::oracle {

using Vector2 = glm::vec<2, Real>;
using Texel = glm::vec<4, Real>;

/// The conversions of IEC 61966-2-1, all values 0...1: decode_srgb returns the light of a code, encode_srgb the code of
/// a light.
Real decode_srgb(Real code);
Real encode_srgb(Real light);

/// The smallest cosine between ray and normal that levels of detail and reflected cones use.
inline constexpr Real kLeastCosine = 1.0L / 64;

/// The cone of a ray: its width at the origin, and its growth per length.
struct Cone {
  Real width = 0;
  Real spread = 0;
};

/// A point of a triangle, for looking up textures.
struct TrianglePoint {
  const Mesh* mesh = nullptr;
  int32_t triangle = 0;
  /// Barycentric weights of the second and third corner.
  Real u = 0;
  Real v = 0;
  /// The width of the ray's cone at the point; 0 selects the finest level.
  Real width = 0;
  /// The cosine |G.D| between the geometric normal and the ray's unit direction.
  Real cosine = 1;
  /// The errors that a device may have: of the position, in scene units along the triangle, and of the cosine.
  Real place_error = 0;
  Real cosine_error = 0;
};

/// The RGBA value of a texture, and the permitted error of each channel.
struct Shown {
  Texel value{1};
  Texel error{0};
};

/// Returns the texture coordinates of the point for a slot, after the slot's transform.
Vector2 coordinates_at(const TextureSlot& slot, const TrianglePoint& point);

/// The change of the coordinates along two edges of the triangle: from the first corner to the second, and to the
/// third.
struct UvEdges {
  Vector2 to_b{0};
  Vector2 to_c{0};
};
UvEdges uv_edges(const TextureSlot& slot, const TrianglePoint& point);

/// The decoded images of a scene with their levels. Levels of masks keep the fraction of texels that are present.
class Textures {
 public:
  explicit Textures(const world::Scene& scene);

  /// Returns whether the slot has a texture that is shown on a mesh with texture coordinates.
  bool shows(const TextureSlot& slot, const TrianglePoint& point) const;

  /// Returns the value of the texture; 1 if there is none. Its error is the change of the value within the errors of
  /// position and level.
  Shown look_up(const TextureSlot& slot, const TrianglePoint& point) const;

  /// Returns the level of detail. It is 0 or less if texels are larger than the cone.
  Real level_at(const TextureSlot& slot, const TrianglePoint& point) const;

  /// Returns the value at a position and a level of detail.
  Texel filter(const TextureSlot& slot, const Vector2& place, Real level) const;

 private:
  struct Level {
    uvec2 size{0};
    std::vector<Texel> texels;
  };
  /// The levels of an image, beginning with level 0; empty if the image is absent.
  using Levels = std::vector<Level>;

  static Level make_level(const TextureImage& image, uint32_t number);
  static Texel sample(const Level& level, const Texture& texture, const Vector2& place, bool is_linear);

  const world::Scene& scene_;
  std::vector<Levels> images_;
};

}  // namespace promin::oracle
