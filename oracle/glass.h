// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "oracle/oracle.h"

/// Glass (docs/model.md, "Glass"): faces between media, and their reflection and refraction.
namespace promin::oracle {

/// The index of the color in a colour.
constexpr int kGreen = 1;

/// A face as a ray meets it.
struct Face {
  /// Indices of refraction on the ray's side and beyond.
  Real from = 1;
  Real to = 1;
  bool is_thin = false;
};

/// The transmission of a material; empty if it transmits nothing.
struct GlassOf {
  bool exists = false;
  bool is_clear = false;
  bool is_thin = false;
  Real index = 1;
  /// The index of blue less that of green, and of green less that of red.
  Real spread = 0;
  Real index_of(int color) const { return index + (color - kGreen) * spread; }
};
GlassOf glass_of(const Material& material);

/// Returns the color by whose index light of this weight is refracted: its only color if it has one, else green.
int color_of(const Vector& weight);

/// The solids of glass that contain a ray, in the order in which it entered them.
class Media {
 public:
  /// Returns the index of refraction of the solid entered last; 1 outside of all.
  Real index(int color) const;
  /// Returns the face of a material for a ray of this color from these media, and sets the media beyond.
  Face meet(const Material& material, bool leaves, int color, Media& beyond) const;
  /// Returns the share of light that is left after this length.
  Vector left_after(Real way) const;

 private:
  std::vector<const Material*> entered_;
};

/// The continuation of a ray behind a face.
struct Refraction {
  bool is_total = false;
  /// Unit.
  Vector direction{0};
  /// The cosines of the angles to the normal on both sides.
  Real cosine = 1;
  Real cosine_beyond = 1;
};
/// `normal` faces the ray, which comes along the unit vector `direction`.
Refraction refract(const Vector& direction, const Vector& normal, const Vector& geometric_normal, const Face& face);

/// Returns the share of unpolarised light that a face reflects.
Real fresnel(const Face& face, const Refraction& at);

/// The share of a source's light that goes straight on through a face. `tint` is the base colour there, `transmission`
/// and `metal` the factors of textures, all of metallic-roughness materials.
Vector straight_share(const Material& material, const Face& face, Real cosine, const Vector& tint, Real transmission,
                      Real metal);

}  // namespace promin::oracle
