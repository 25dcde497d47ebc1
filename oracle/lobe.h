// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/oracle.h"

/// The metallic-roughness model of glTF 2.0, appendix B, at one point (docs/model.md, "Metallic-roughness").
namespace promin::oracle {

/// Returns the microfacets' density D (Trowbridge and Reitz, GGX) per steradian, for half vectors at the angle theta to
/// the normal.
Real microfacet_density(Real theta, Real alpha);

/// Returns Smith's height-correlated masking and shadowing, divided by 4 (N.L) (N.V), for the cosines v to the eye and
/// l to the light (Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2)).
Real visibility(Real v, Real l, Real alpha);

/// The fractions of light of radiance 1 from all directions that a lobe reflects.
struct LobeShares {
  /// E1: the radiance to the eye if facets reflect all light once.
  Real all = 1;
  /// B: the same integral with the factor (1 - V.H)^5.
  Real grazing = 0;
};

/// Returns the shares from the device's table, interpolated bilinearly over sqrt(v) and the perceptual roughness.
LobeShares look_up_lobe_shares(Real v, Real roughness);

/// Computes the shares by Gaussian quadrature over directions to the light. The error is below 1e-4 for v = 0 or >
/// 1e-3, and mostly 1e-6.
LobeShares integrate_lobe_shares(Real v, Real roughness);

/// Returns the radiance that a sheen of colour 1 sends to the eye under light of radiance 1 from all directions
/// (KHR_materials_sheen), from the device's table. The result may exceed 1.
Real look_up_sheen_share(Real v, Real roughness);

/// Computes the radiance of look_up_sheen_share by the midpoint rule over directions to the light, for v >= 2^-10. The
/// error is below 2e-4.
Real integrate_sheen_share(Real v, Real roughness);

/// The angles on which a lobe depends. All except theta are cosines.
struct LobeAngles {
  /// The angle between the normal and the half vector, in radians.
  Real theta = 0;
  /// The cosines N.V to the eye and N.L to the light.
  Real v = 1;
  Real l = 1;
  /// The cosine V.H between the directions of eye and half vector.
  Real v_h = 1;
};

LobeAngles angles_of(const Vector& normal, const Vector& to_eye, const Vector& to_light);

/// Returns the reflectance of a thin film on a base, in linear Rec. 709 (KHR_materials_iridescence, "Thin film
/// reflectance"). The arguments are the base's reflectance at normal incidence in air, the film's index of refraction,
/// its thickness in nanometres, and the cosine to the eye.
Vector film_reflectance(const Vector& f0, Real ior, Real thickness, Real cosine);

/// The directions of light at a surface with a grain, which stretches highlights. They are unit vectors in a frame with
/// x along the grain and z along the normal.
struct GrainWays {
  Vector to_eye{0};
  Vector to_light{0};
};

/// The alphas along and across the grain (KHR_materials_anisotropy).
struct GrainAlphas {
  Real along = 1;
  Real across = 1;
  /// Returns the perceptual roughness with the same mean slope, for formulas that need a single number.
  Real mean_roughness() const;
};
GrainAlphas grain_alphas(Real roughness, Real strength);

/// A material at one point, seen from one direction.
class Lobe {
 public:
  /// Creates a lobe. The vertex colour multiplies the base colour, which stays at most 1. `shares` are the shares for
  /// the cosine to the eye. The film is seen at the same cosine, and its thickness is the maximum.
  Lobe(const MetallicRoughness& material, const Vector& vertex_color, const LobeShares& shares, Real cosine_to_eye = 1);

  /// Returns the fraction of uniform light that the lobe reflects; albedo() returns the fraction that the body below
  /// the surface scatters.
  const Vector& reflectance() const { return reflectance_; }
  const Vector& albedo() const { return albedo_; }
  /// Returns the fraction of light that enters the dielectric.
  Real let_in() const { return let_in_; }
  /// Returns the fraction of the reflected light that a mirror ray contributes, 0...1.
  Real sharpness() const;
  /// Returns the radiance that the lobe reflects from a source whose irradiance perpendicular to its direction is 1.
  Vector highlight(const LobeAngles& angles) const;
  Vector highlight(const GrainWays& ways, const GrainAlphas& alphas) const;
  /// Returns the sum of the highlights of sources of radiance 1 in all directions, computed from these shares of the
  /// lobe.
  Vector highlights_of_all(const LobeShares& shares) const;
  /// Returns the alpha with which sources are reflected.
  Real alpha_of_sources() const;

 private:
  struct Part {
    Vector f0{0};
    Real f90 = 1;
    /// The factor that compensates for light that microfacets reflect more than once.
    Vector k{1};
    Part(const Vector& at_normal, Real at_grazing, const LobeShares& shares);
    Vector reflectance(const LobeShares& shares) const;
    Vector fresnel(Real v_h) const;
  };
  /// Returns the facets' reflectance for a source.
  Vector facets(Real v_h) const;

  Real metallic_;
  Real roughness_;
  Part dielectric_;
  Part metal_;
  Vector reflectance_{0};
  Vector albedo_{0};
  Real let_in_ = 0;
};

/// A clear coat at one point, seen from one direction (KHR_materials_clearcoat), without textures. It has the
/// material's normal.
class ClearCoat {
 public:
  ClearCoat(const MetallicRoughness& material, Real cosine_to_eye);

  /// Returns the coat's weight in the sum of coat and material.
  Real weight() const { return weight_; }
  /// Returns the fraction of uniform light that the coat reflects, without its weight.
  Real reflectance() const { return reflectance_; }
  /// Returns the fraction of the reflected light that a mirror ray contributes, like Lobe::sharpness().
  Real sharpness() const;
  Real highlight(const LobeAngles& angles) const;
  Real alpha_of_sources() const;

 private:
  Real weight_;
  Real roughness_;
  Real reflectance_;
};

/// A sheen at one point, seen from one direction (KHR_materials_sheen), without textures.
class Sheen {
 public:
  Sheen(const MetallicRoughness& material, Real cosine_to_eye);

  bool exists() const { return largest_ > 0; }
  /// Returns the radiance that the sheen sends under uniform light of radiance 1.
  Vector reflectance() const;
  /// Returns the fraction of uniform light that remains for the layers below; left_of_source() returns the fraction of
  /// the light of a source at this cosine.
  Real left() const;
  Real left(Real cosine_to_light) const;
  /// Returns the radiance that the sheen reflects from a source whose irradiance perpendicular to its direction is 1.
  Vector highlight(const LobeAngles& angles) const;

 private:
  Vector color_;
  Real largest_;
  Real roughness_;
  Real share_;
};

}  // namespace promin::oracle
