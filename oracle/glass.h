// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "oracle/oracle.h"

/// Glass (docs/model.md, "Glass"): faces between media, with their reflection and refraction.
namespace promin::oracle {

/// The component of a colour that has the reference index of refraction.
constexpr int kGreen = 1;

/// A face that a ray hits.
struct Face {
  /// The indices of refraction on the ray's side and on the other side.
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
  /// The index of refraction of blue minus that of green, and of green minus that of red.
  Real spread = 0;
  Real index_of(int color) const { return index + (color - kGreen) * spread; }
};
GlassOf glass_of(const Material& material);

/// Returns the colour whose index of refraction applies to light of this weight: its only colour if it has one,
/// otherwise green.
int color_of(const Vector& weight);

/// The solids of glass that contain a ray, in the order in which it entered them.
class Media {
 public:
  /// Returns the index of refraction of the solid that the ray entered last; 1 outside all solids.
  Real index(int color) const;
  /// Returns the face of a material that a ray of this colour hits in these media, and sets the media on the other
  /// side.
  Face meet(const Material& material, bool leaves, int color, Media& beyond) const;
  /// Returns the fraction of light that remains after this length.
  Vector left_after(Real way) const;

 private:
  std::vector<const Material*> entered_;
};

/// The continuation of a ray on the other side of a face.
struct Refraction {
  bool is_total = false;
  /// The refracted direction, a unit vector.
  Vector direction{0};
  /// The cosines of the angles to the normal on both sides.
  Real cosine = 1;
  Real cosine_beyond = 1;
};
/// Refracts a ray. `direction` is the ray's unit direction, and `normal` faces the ray.
Refraction refract(const Vector& direction, const Vector& normal, const Vector& geometric_normal, const Face& face);

/// Returns the fraction of unpolarised light that a face reflects.
Real fresnel(const Face& face, const Refraction& at);

/// Returns the fraction of a source's light that passes straight through a face. `tint` is the base colour at the
/// point. `transmission` and `metal` are the factors of the textures. These three are for metallic-roughness materials.
Vector straight_share(const Material& material, const Face& face, Real cosine, const Vector& tint, Real transmission,
                      Real metal);

}  // namespace promin::oracle
