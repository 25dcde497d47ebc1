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

// The material models (docs/model.md). All factors are linear RGB, finite and not negative; none is clamped to 1 unless
// stated.

/// Phong's model (docs/model.md, "Phong"). The default is a matt light grey.
struct Phong {
  /// Weight of Environment::ambient.
  vec3 ambient{0.8F};
  /// Weight of N.L times a light's diffuse power.
  vec3 diffuse{0.8F};
  /// Weight of the highlight times a light's specular power.
  vec3 specular{0.0F};
  /// Phong's exponent, finite; <= 0 for no specular term.
  float shininess = 0.0F;
  /// Weight of the mirror ray's radiance; 0 traces none.
  vec3 reflection{0.0F};
  /// Weight of the refracted ray's radiance, which makes the material glass; 0 traces none. On total reflection the
  /// mirror ray gets this weight. Shadow rays pass straight through and are multiplied by this at each face.
  vec3 transmission{0.0F};
  /// Index of refraction, positive and finite; 1 does not bend rays.
  float ior = 1.0F;
  /// Whether the reflection is multiplied by Fresnel's reflectance F for the index of refraction, and the transmission
  /// by 1 - F.
  bool fresnel = false;
  /// Texture of factors of ambient and diffuse.
  TextureSlot diffuse_texture = {};
  /// Texture of factors of specular and reflection.
  TextureSlot specular_texture = {};
  /// Normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
};

/// The metallic-roughness model of glTF 2.0, appendix B (docs/model.md, "Metallic-roughness"). The default is that of
/// glTF: a rough white metal.
struct MetallicRoughness {
  /// Albedo of the dielectric and reflectance of the metal at normal incidence, 0...1.
  vec3 base_color{1.0F};
  /// Weight of the metal, 0...1.
  float metallic = 1.0F;
  /// Perceptual roughness, 0...1; its square is the alpha of GGX.
  float roughness = 1.0F;
  /// Index of refraction of the dielectric, >= 1; or 0, which makes it a perfect mirror (KHR_materials_ior).
  float ior = 1.5F;
  /// Strength of the dielectric's reflection, 0...1 (KHR_materials_specular).
  float specular = 1.0F;
  /// Colour of the dielectric's reflection at normal incidence (KHR_materials_specular).
  vec3 specular_color{1.0F};
  /// Factor of the strength of the dielectric's reflection (alpha).
  TextureSlot specular_texture = {};
  /// Factors of specular_color.
  TextureSlot specular_color_texture = {};
  /// The part of the light that is transmitted and not scattered, 0...1 (KHR_materials_transmission).
  float transmission = 0.0F;
  /// Factor of the transmission (red).
  TextureSlot transmission_texture = {};
  /// The part of the scattered light that leaves on the other side, 0...1 (KHR_materials_diffuse_transmission). The
  /// surface then acts as a thin wall, whatever `thickness` is.
  float diffuse_transmission = 0.0F;
  /// The colour of the light that leaves on the other side, 0...1, in place of the base colour.
  vec3 diffuse_transmission_color{1.0F};
  /// Factor of diffuse_transmission (alpha).
  TextureSlot diffuse_transmission_texture = {};
  /// Factors of diffuse_transmission_color.
  TextureSlot diffuse_transmission_color_texture = {};
  /// 0 makes the surface a thin wall, which does not bend light; any other value makes it the boundary of a volume
  /// (KHR_materials_volume). The value itself is not used, because the geometry determines the thickness. Not negative.
  float thickness = 0.0F;
  /// The colour that white light has after attenuation_distance in the volume, 0...1.
  vec3 attenuation_color{1.0F};
  /// In world units, positive; infinite for no absorption.
  float attenuation_distance = std::numeric_limits<float>::infinity();
  /// 20 divided by the Abbe number of a volume's glass, not negative. The indices of refraction of red and blue differ
  /// from `ior` by 0.025 (ior - 1) dispersion (KHR_materials_dispersion), but none is below 1.
  float dispersion = 0.0F;
  /// Factors of the base colour.
  TextureSlot base_color_texture = {};
  /// Factors of roughness (green) and metallic (blue).
  TextureSlot metallic_roughness_texture = {};
  /// Normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
  /// Factor of x and y of these normals, finite.
  float normal_scale = 1.0F;
  /// Factor of light from the environment (red): 1 + occlusion_strength * (texture - 1).
  TextureSlot occlusion_texture = {};
  /// Strength of the occlusion texture, 0...1.
  float occlusion_strength = 1.0F;
  /// Weight of the clear coat over the material, 0...1 (KHR_materials_clearcoat). The coat reflects like glass.
  float clearcoat = 0.0F;
  /// The coat's perceptual roughness, 0...1.
  float clearcoat_roughness = 0.0F;
  /// Factor of the coat's weight (red).
  TextureSlot clearcoat_texture = {};
  /// Factor of the coat's roughness (green).
  TextureSlot clearcoat_roughness_texture = {};
  /// Normals of the coat, which ignores the normals of the material below.
  TextureSlot clearcoat_normal_texture = {};
  /// Factor of x and y of these normals, finite.
  float clearcoat_normal_scale = 1.0F;
  /// Colour of the sheen of cloth under the coat, 0...1; 0 for no sheen (KHR_materials_sheen).
  vec3 sheen_color{0.0F};
  /// The sheen's perceptual roughness, 0...1; values below 0.07 are raised to 0.07.
  float sheen_roughness = 0.0F;
  /// Factors of sheen_color.
  TextureSlot sheen_color_texture = {};
  /// Factor of sheen_roughness (alpha).
  TextureSlot sheen_roughness_texture = {};
  /// Weight of a thin film that colours the reflection, 0...1 (KHR_materials_iridescence).
  float iridescence = 0.0F;
  /// The film's index of refraction, >= 1.
  float iridescence_ior = 1.3F;
  /// The film's thickness in nanometres where its texture is 0, not negative. It may be larger than the maximum.
  float iridescence_thickness_minimum = 100.0F;
  /// The thickness where the texture is 1, or without a texture.
  float iridescence_thickness_maximum = 400.0F;
  /// Factor of `iridescence` (red).
  TextureSlot iridescence_texture = {};
  /// Interpolates the thickness from the minimum to the maximum (green).
  TextureSlot iridescence_thickness_texture = {};
  /// How much highlights are stretched on meshes with texture coordinates, 0...1 (KHR_materials_anisotropy).
  float anisotropy = 0.0F;
  /// Direction of the stretch in radians, counterclockwise from the tangent.
  float anisotropy_rotation = 0.0F;
  /// The direction in tangent space (red and green, 0...1 for -1...1) and a factor of `anisotropy` (blue).
  TextureSlot anisotropy_texture = {};
};

/// A material whose colour does not depend on light (KHR_materials_unlit).
struct Unlit {
  /// The colour.
  vec3 color{1.0F};
  /// Texture of factors of the colour.
  TextureSlot color_texture = {};
};

/// The effect of alpha (glTF 2.0, section 3.9.4). Casts ignore alpha.
enum class AlphaMode : uint32_t {
  /// Alpha has no effect.
  kOpaque = 0,
  /// Parts with an alpha below the cutoff are absent; the others are opaque.
  kMask = 1,
  /// The surface lets through 1 - alpha of the light from behind, for rays that see it and for shadow rays.
  kBlend = 2,
};

/// The material of an object's surface.
struct Material {
  /// A name for people; empty if there is none.
  std::string name;
  /// The model and its parameters.
  std::variant<Phong, MetallicRoughness, Unlit> model;
  /// Light that the surface emits, linear RGB, finite and not negative. It does not light other surfaces.
  vec3 emissive{0.0F};
  /// Texture of factors of the emission; unlit materials have none.
  TextureSlot emissive_texture = {};
  /// The effect of alpha.
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// Opacity of the surface, 0...1. It is multiplied by the alpha of the model's base colour texture.
  float alpha = 1.0F;
  /// The smallest alpha at which a masked surface is present, finite and not negative.
  float alpha_cutoff = 0.5F;
  /// Whether camera and mirror rays see both sides of triangles, or only the front, from which the corners run
  /// counterclockwise. Other shapes are always seen from both sides, and both sides cast shadows.
  bool is_double_sided = true;

  /// Returns the model of a Phong material. Throws std::bad_variant_access for another model.
  Phong& phong() { return std::get<Phong>(model); }
  /// The same for reading.
  const Phong& phong() const { return std::get<Phong>(model); }
};

}  // namespace promin
