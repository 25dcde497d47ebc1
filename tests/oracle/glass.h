// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "oracle/oracle.h"

/// Glass (docs/model.md, "Glass"): faces between media, and what they do with light.
namespace promin::oracle {

/// The place of the color in a colour.
constexpr int kGreen = 1;

/// A face as a ray meets it.
struct Face {
  /// Indices of refraction on the ray's side and beyond.
  Real from = 1;
  Real to = 1;
  bool is_thin = false;
};

/// How a material lets light through; nullptr-like where it does not.
struct GlassOf {
  bool exists = false;
  bool is_clear = false;
  bool is_thin = false;
  Real index = 1;
  /// Of blue less that of green, and of green less that of red.
  Real spread = 0;
  Real index_of(int color) const { return index + (color - kGreen) * spread; }
};
GlassOf glass_of(const Material& material);

/// As what light of this weight is bent: where it has one color, as that, else as green.
int color_of(const Vector& weight);

/// The solids of glass that a ray is in, the last entered last.
class Media {
 public:
  /// Of the last entered; 1 outside of all.
  Real index(int color) const;
  /// The face of a material as a ray of this color from within these media meets it, and the media beyond.
  Face meet(const Material& material, bool leaves, int color, Media& beyond) const;
  /// The share of light that is left after this way.
  Vector left_after(Real way) const;

 private:
  std::vector<const Material*> entered_;
};

/// Where a ray goes on behind a face.
struct Refraction {
  bool is_total = false;
  /// Unit.
  Vector direction{0};
  /// Of the angles to the normal on either side.
  Real cosine = 1;
  Real cosine_beyond = 1;
};
/// `normal` faces the ray, which comes along the unit vector `direction`.
Refraction refract(const Vector& direction, const Vector& normal, const Vector& geometric_normal, const Face& face);

/// What a face reflects of unpolarised light.
Real fresnel(const Face& face, const Refraction& at);

/// The share of a source's light that goes straight on through a face. `tint` is the base colour there, `transmission`
/// and `metal` the factors of textures, all of metallic-roughness materials.
Vector straight_share(const Material& material, const Face& face, Real cosine, const Vector& tint, Real transmission,
                      Real metal);

}  // namespace promin::oracle
