// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include "promin/math.h"
#include "promin/textures.h"

namespace promin {

// The material models (docs/model.md). All factors are linear RGB, finite and not negative. A factor may exceed 1
// unless its comment gives a range.

/// Phong's model (docs/model.md, "Phong"). The default is a matt light grey.
struct Phong {
  /// Factor of Environment::ambient.
  vec3 ambient{0.8F};
  /// Factor of N.L times a light's diffuse power.
  vec3 diffuse{0.8F};
  /// Factor of the highlight times a light's specular power.
  vec3 specular{0.0F};
  /// Phong's exponent, finite; there is no specular term if it is <= 0.
  float shininess = 0.0F;
  /// Factor of the mirror ray's radiance; if it is 0, no mirror ray is traced.
  vec3 reflection{0.0F};
  /// Factor of the refracted ray's radiance. A factor other than 0 makes the material glass; if it is 0, no refracted
  /// ray is traced. On total reflection the mirror ray gets this factor. Shadow rays pass straight through, and each
  /// face multiplies their light by this factor.
  vec3 transmission{0.0F};
  /// Index of refraction, positive and finite; 1 does not bend rays.
  float ior = 1.0F;
  /// If true, the reflection is multiplied by Fresnel's reflectance F for the index of refraction, and the transmission
  /// by 1 - F.
  bool fresnel = false;
  /// Texture whose values multiply `ambient` and `diffuse`.
  TextureSlot diffuse_texture = {};
  /// Texture whose values multiply `specular` and `reflection`.
  TextureSlot specular_texture = {};
  /// Texture of normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
};

/// The metallic-roughness model of glTF 2.0, appendix B (docs/model.md, "Metallic-roughness"). The default is the same
/// as glTF's: a rough white metal.
struct MetallicRoughness {
  /// Albedo of the dielectric and reflectance of the metal at normal incidence, 0...1.
  vec3 base_color{1.0F};
  /// Weight of the metal in the mixture of dielectric and metal, 0...1.
  float metallic = 1.0F;
  /// Perceptual roughness, 0...1; its square is the alpha of GGX.
  float roughness = 1.0F;
  /// Index of refraction of the dielectric, >= 1; or 0, which makes it a perfect mirror (KHR_materials_ior).
  float ior = 1.5F;
  /// Strength of the dielectric's reflection, 0...1 (KHR_materials_specular).
  float specular = 1.0F;
  /// Colour of the dielectric's reflection at normal incidence (KHR_materials_specular).
  vec3 specular_color{1.0F};
  /// Texture whose alpha multiplies `specular`.
  TextureSlot specular_texture = {};
  /// Texture whose RGB multiplies `specular_color`.
  TextureSlot specular_color_texture = {};
  /// The fraction of the light that is transmitted and not scattered, 0...1 (KHR_materials_transmission).
  float transmission = 0.0F;
  /// Texture whose red channel multiplies `transmission`.
  TextureSlot transmission_texture = {};
  /// The fraction of the scattered light that leaves on the other side, 0...1 (KHR_materials_diffuse_transmission). A
  /// surface with a fraction above 0 acts as a thin wall for every value of `thickness`.
  float diffuse_transmission = 0.0F;
  /// The colour of the light that leaves on the other side, 0...1; it replaces the base colour for this light.
  vec3 diffuse_transmission_color{1.0F};
  /// Texture whose alpha multiplies `diffuse_transmission`.
  TextureSlot diffuse_transmission_texture = {};
  /// Texture whose RGB multiplies `diffuse_transmission_color`.
  TextureSlot diffuse_transmission_color_texture = {};
  /// Determines the kind of the surface (KHR_materials_volume); not negative. The value 0 makes it a thin wall, which
  /// does not bend light. Any other value makes it the boundary of a volume. The size of the value is not used, because
  /// the geometry determines the thickness.
  float thickness = 0.0F;
  /// The colour that white light has after the distance attenuation_distance in the volume, 0...1.
  vec3 attenuation_color{1.0F};
  /// The distance to which attenuation_color refers, in world units, positive; infinite for no absorption.
  float attenuation_distance = std::numeric_limits<float>::infinity();
  /// 20 divided by the Abbe number of a volume's glass, not negative. The indices of refraction of red and blue differ
  /// from `ior` by 0.025 (ior - 1) dispersion (KHR_materials_dispersion), but none is below 1.
  float dispersion = 0.0F;
  /// Texture whose values multiply `base_color`.
  TextureSlot base_color_texture = {};
  /// Texture whose green channel multiplies `roughness` and whose blue channel multiplies `metallic`.
  TextureSlot metallic_roughness_texture = {};
  /// Texture of normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
  /// Factor of x and y of the normals in normal_texture, finite.
  float normal_scale = 1.0F;
  /// Texture whose red channel occludes light from the environment: the light is multiplied by 1 + occlusion_strength *
  /// (red - 1).
  TextureSlot occlusion_texture = {};
  /// Strength of the occlusion texture, 0...1.
  float occlusion_strength = 1.0F;
  /// Weight of the clear coat over the material, 0...1 (KHR_materials_clearcoat). The coat reflects like glass.
  float clearcoat = 0.0F;
  /// The coat's perceptual roughness, 0...1.
  float clearcoat_roughness = 0.0F;
  /// Texture whose red channel multiplies `clearcoat`.
  TextureSlot clearcoat_texture = {};
  /// Texture whose green channel multiplies `clearcoat_roughness`.
  TextureSlot clearcoat_roughness_texture = {};
  /// Texture of the coat's normals. The coat ignores the normals of the material below.
  TextureSlot clearcoat_normal_texture = {};
  /// Factor of x and y of the normals in clearcoat_normal_texture, finite.
  float clearcoat_normal_scale = 1.0F;
  /// Colour of the sheen of cloth under the coat, 0...1; 0 for no sheen (KHR_materials_sheen).
  vec3 sheen_color{0.0F};
  /// The sheen's perceptual roughness, 0...1; values below 0.07 are raised to 0.07.
  float sheen_roughness = 0.0F;
  /// Texture whose RGB multiplies `sheen_color`.
  TextureSlot sheen_color_texture = {};
  /// Texture whose alpha multiplies `sheen_roughness`.
  TextureSlot sheen_roughness_texture = {};
  /// Weight of a thin film that colours the reflection, 0...1 (KHR_materials_iridescence).
  float iridescence = 0.0F;
  /// The film's index of refraction, >= 1.
  float iridescence_ior = 1.3F;
  /// The film's thickness in nanometres where iridescence_thickness_texture is 0, not negative. It may be larger than
  /// the maximum.
  float iridescence_thickness_minimum = 100.0F;
  /// The film's thickness in nanometres where iridescence_thickness_texture is 1, and everywhere without a texture.
  float iridescence_thickness_maximum = 400.0F;
  /// Texture whose red channel multiplies `iridescence`.
  TextureSlot iridescence_texture = {};
  /// Texture whose green channel interpolates the film's thickness from the minimum to the maximum.
  TextureSlot iridescence_thickness_texture = {};
  /// Strength with which highlights are stretched on meshes with texture coordinates, 0...1 (KHR_materials_anisotropy).
  float anisotropy = 0.0F;
  /// Direction of the stretch in radians, counterclockwise from the tangent.
  float anisotropy_rotation = 0.0F;
  /// Texture of the stretch's direction in tangent space (red and green: 0...1 stands for -1...1). Its blue channel
  /// multiplies `anisotropy`.
  TextureSlot anisotropy_texture = {};
};

/// A material whose colour does not depend on light (KHR_materials_unlit).
struct Unlit {
  /// The colour, linear RGB.
  vec3 color{1.0F};
  /// Texture whose values multiply `color`.
  TextureSlot color_texture = {};
  /// True if the surface shows only the shadows on it: what is behind it, multiplied by the fraction of light that
  /// arrives. Only light from infinity counts: directional lights, and the environment with Integrator::kDirect or
  /// kPath. `color` is then the light that arrives without shadows: the irradiance divided by pi. In pictures with
  /// alpha, the alpha of the surface is the fraction of light that is missing. A plane that catches shadows blocks no
  /// light.
  bool catches_shadows = false;
};

/// The effect of alpha on a picture (glTF 2.0, section 3.9.4). Casts ignore alpha.
enum class AlphaMode : uint32_t {
  /// Alpha has no effect.
  kOpaque = 0,
  /// Points with an alpha below the cutoff are absent; all others are opaque.
  kMask = 1,
  /// The surface transmits the fraction 1 - alpha of the light from behind, to rays that see it and to shadow rays.
  kBlend = 2,
};

/// The material of an object's surface.
struct Material {
  /// The display name; empty if there is none.
  std::string name;
  /// The model and its parameters.
  std::variant<Phong, MetallicRoughness, Unlit> model;
  /// Emitted light, linear RGB, finite and not negative. It lights others with Integrator::kDirect and kPath.
  vec3 emissive{0.0F};
  /// Texture whose values multiply `emissive`; unlit materials ignore it.
  TextureSlot emissive_texture = {};
  /// The effect of `alpha`.
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// Opacity of the surface, 0...1. The alpha of the model's base colour texture multiplies it.
  float alpha = 1.0F;
  /// The smallest alpha at which a surface with AlphaMode::kMask is present, finite and not negative.
  float alpha_cutoff = 0.5F;
  /// If true, camera and mirror rays see both sides of triangles. If false, they see only the front, from which the
  /// corners run counterclockwise. They see both sides of all other shapes, and shadow rays see both sides of
  /// everything.
  bool is_double_sided = true;

  /// Returns the model of a Phong material. Throws std::bad_variant_access for another model.
  Phong& phong() { return std::get<Phong>(model); }
  /// Returns the model of a Phong material for reading. Throws std::bad_variant_access for another model.
  const Phong& phong() const { return std::get<Phong>(model); }
};

}  // namespace promin
