// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/oracle.h"

/// The metallic-roughness model of glTF 2.0, appendix B, at one point (docs/model.md, "Metallic-roughness").
namespace promin::oracle {

/// The microfacets' density D (Trowbridge and Reitz, GGX): per steradian, of half vectors at the angle theta to the
/// normal.
Real microfacet_density(Real theta, Real alpha);

/// Smith's height-correlated masking and shadowing over 4 (N.L) (N.V), of the cosines v to the eye and l to the light
/// (Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2)).
Real visibility(Real v, Real l, Real alpha);

/// What a lobe does with light of radiance 1 from everywhere.
struct LobeShares {
  /// E1: what is sent to the eye where facets reflect everything once.
  Real all = 1;
  /// B: the part of it that goes with (1 - V.H)^5.
  Real grazing = 0;
};

/// By the device's table, between its entries bilinear over sqrt(v) and the perceptual roughness.
LobeShares look_up_lobe_shares(Real v, Real roughness);

/// By Gauss's quadrature over directions to the light. Its error is below 1e-4 for v = 0 or > 1e-3, and mostly 1e-6.
LobeShares integrate_lobe_shares(Real v, Real roughness);

/// What a sheen of colour 1 sends to the eye of light of radiance 1 from everywhere (KHR_materials_sheen), which may be
/// more than 1. By the device's table.
Real look_up_sheen_share(Real v, Real roughness);

/// By the midpoint rule over directions to the light, where v >= 2^-10. Its error is below 2e-4.
Real integrate_sheen_share(Real v, Real roughness);

/// The angles that a lobe hangs on. All but theta are cosines.
struct LobeAngles {
  /// Between normal and half vector, radians.
  Real theta = 0;
  /// To the eye and to the light.
  Real v = 1;
  Real l = 1;
  /// Between eye and half vector.
  Real v_h = 1;
};

LobeAngles angles_of(const Vector& normal, const Vector& to_eye, const Vector& to_light);

/// The reflectance of a thin film on a base, in linear Rec. 709 (KHR_materials_iridescence, "Thin film reflectance"): of
/// the base's reflectance at normal incidence beside air, the film's index of refraction, its thickness in nanometres,
/// and the cosine to the eye.
Vector film_reflectance(const Vector& f0, Real ior, Real thickness, Real cosine);

/// The ways of light where a grain stretches highlights: unit, x along the grain, z the normal.
struct GrainWays {
  Vector to_eye{0};
  Vector to_light{0};
};

/// How rough a surface with a grain is, as alphas (KHR_materials_anisotropy).
struct GrainAlphas {
  Real along = 1;
  Real across = 1;
  /// The perceptual roughness of the same mean slope, which stands for both where one number must.
  Real mean_roughness() const;
};
GrainAlphas grain_alphas(Real roughness, Real strength);

/// A material as one eye sees it at one point.
class Lobe {
 public:
  /// The vertex colour is a factor of the base colour, which stays at most 1. The shares are those of the cosine to the
  /// eye, at which the eye sees the film too, whose thickness is the maximum.
  Lobe(const MetallicRoughness& material, const Vector& vertex_color, const LobeShares& shares, Real cosine_to_eye = 1);

  /// Of light from all around: what is reflected, and the share that the body under the surface sends, both of 1.
  const Vector& reflectance() const { return reflectance_; }
  const Vector& albedo() const { return albedo_; }
  /// The share that comes into the dielectric.
  Real let_in() const { return let_in_; }
  /// The part of the reflected light that a mirror ray brings, 0...1.
  Real sharpness() const;
  /// The radiance that the surface reflects of a source with an irradiance of 1 across its way.
  Vector highlight(const LobeAngles& angles) const;
  Vector highlight(const GrainWays& ways, const GrainAlphas& alphas) const;
  /// The sum of the highlights of sources in all directions, of radiance 1, where the lobe's shares are these.
  Vector highlights_of_all(const LobeShares& shares) const;
  /// The alpha by which sources are reflected.
  Real alpha_of_sources() const;

 private:
  struct Part {
    Vector f0{0};
    Real f90 = 1;
    /// What microfacets reflect more than once is given back by this factor.
    Vector k{1};
    Part(const Vector& at_normal, Real at_grazing, const LobeShares& shares);
    Vector reflectance(const LobeShares& shares) const;
    Vector fresnel(Real v_h) const;
  };
  /// What facets reflect of a source.
  Vector facets(Real v_h) const;

  Real metallic_;
  Real roughness_;
  Part dielectric_;
  Part metal_;
  Vector reflectance_{0};
  Vector albedo_{0};
  Real let_in_ = 0;
};

/// A clear coat as one eye sees it at one point (KHR_materials_clearcoat), without textures: it has the material's
/// normal.
class ClearCoat {
 public:
  ClearCoat(const MetallicRoughness& material, Real cosine_to_eye);

  /// The part of all that is seen that is the coat's.
  Real weight() const { return weight_; }
  /// What it reflects of light of 1 from all around, were it all that is seen.
  Real reflectance() const { return reflectance_; }
  /// As Lobe's.
  Real sharpness() const;
  Real highlight(const LobeAngles& angles) const;
  Real alpha_of_sources() const;

 private:
  Real weight_;
  Real roughness_;
  Real reflectance_;
};

/// A sheen as one eye sees it at one point (KHR_materials_sheen), without textures.
class Sheen {
 public:
  Sheen(const MetallicRoughness& material, Real cosine_to_eye);

  bool exists() const { return largest_ > 0; }
  /// What it sends of light of 1 from all around.
  Vector reflectance() const;
  /// The share that is left for what is below: of light from all around, and of that of a source at this cosine.
  Real left() const;
  Real left(Real cosine_to_light) const;
  /// The radiance that it sends of a source with an irradiance of 1 across its way.
  Vector highlight(const LobeAngles& angles) const;

 private:
  Vector color_;
  Real largest_;
  Real roughness_;
  Real share_;
};

}  // namespace promin::oracle
