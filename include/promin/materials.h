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

// The models that a material may follow (docs/model.md). All factors are linear RGB, finite and not negative; nothing
// is clamped to 1 unless it is said.

/// Phong's model (docs/model.md, "Phong"). The default is a matt light grey.
struct Phong {
  /// Weight of Environment::ambient.
  vec3 ambient{0.8F};
  /// Weight of N.L times a light's diffuse power.
  vec3 diffuse{0.8F};
  /// Weight of the highlight times a light's specular power.
  vec3 specular{0.0F};
  /// Phong's exponent, finite; <= 0: there is no specular term.
  float shininess = 0.0F;
  /// Weight of what the mirror ray brings; 0 traces none.
  vec3 reflection{0.0F};
  /// Weight of what the refracted ray brings: what makes it glass; 0 traces none. Where a ray is reflected totally the
  /// mirror ray takes it. Shadow rays go straight through, times this at each face.
  vec3 transmission{0.0F};
  /// Index of refraction, positive and finite; 1 bends nothing.
  float ior = 1.0F;
  /// Whether Fresnel's reflectance F for the index of refraction is a factor of the reflection, and 1 - F of the
  /// transmission.
  bool fresnel = false;
  /// Factors of ambient and diffuse.
  TextureSlot diffuse_texture = {};
  /// Factors of specular and reflection.
  TextureSlot specular_texture = {};
  /// Normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
};

/// The metallic-roughness model of glTF 2.0, appendix B (docs/model.md, "Metallic-roughness"). The default is that of
/// glTF: a rough white metal.
struct MetallicRoughness {
  /// Albedo of the dielectric and reflectance of the metal at normal incidence, 0...1.
  vec3 base_color{1.0F};
  /// The share of metal, 0...1.
  float metallic = 1.0F;
  /// Perceptual roughness, 0...1; its square is the alpha of GGX.
  float roughness = 1.0F;
  /// Index of refraction of the dielectric, >= 1, or 0: it reflects as a mirror does (KHR_materials_ior).
  float ior = 1.5F;
  /// Strength of the dielectric's reflection, 0...1 (KHR_materials_specular).
  float specular = 1.0F;
  /// Colour of the dielectric's reflection at normal incidence (KHR_materials_specular).
  vec3 specular_color{1.0F};
  /// Factor of the strength of the dielectric's reflection (alpha).
  TextureSlot specular_texture = {};
  /// Factors of its colour.
  TextureSlot specular_color_texture = {};
  /// The share of light that goes through instead of being scattered, 0...1 (KHR_materials_transmission).
  float transmission = 0.0F;
  /// Factor of it (red).
  TextureSlot transmission_texture = {};
  /// The share of scattered light that leaves on the other side, 0...1 (KHR_materials_diffuse_transmission). The
  /// surface acts as a thin wall, whatever `thickness` says.
  float diffuse_transmission = 0.0F;
  /// The colour of the light that leaves on the other side, 0...1, in place of the base colour.
  vec3 diffuse_transmission_color{1.0F};
  /// Factor of the share (alpha).
  TextureSlot diffuse_transmission_texture = {};
  /// Factors of the colour.
  TextureSlot diffuse_transmission_color_texture = {};
  /// 0: the surface is a thin wall, which bends no light; else it bounds a volume (KHR_materials_volume). How thick it
  /// is the scene says, so the number itself is not needed. Not negative.
  float thickness = 0.0F;
  /// Of white light the colour that is left in the volume after attenuation_distance, 0...1.
  vec3 attenuation_color{1.0F};
  /// In units of the world, positive; infinite: nothing is absorbed.
  float attenuation_distance = std::numeric_limits<float>::infinity();
  /// 20 over the Abbe number of a volume's glass, not negative: the indices of refraction of red and blue are off by
  /// 0.025 (ior - 1) dispersion (KHR_materials_dispersion), but none is below 1.
  float dispersion = 0.0F;
  /// Factors of the base colour.
  TextureSlot base_color_texture = {};
  /// Factors of roughness (green) and metallic (blue).
  TextureSlot metallic_roughness_texture = {};
  /// Normals in the tangent space of the mesh.
  TextureSlot normal_texture = {};
  /// Factor of x and y of these normals, finite.
  float normal_scale = 1.0F;
  /// Dims what the environment brings (red): 1 + occlusion_strength * (texture - 1).
  TextureSlot occlusion_texture = {};
  /// 0...1.
  float occlusion_strength = 1.0F;
  /// How much of a clear coat there is over all of it, 0...1 (KHR_materials_clearcoat); it reflects as glass does.
  float clearcoat = 0.0F;
  /// The coat's perceptual roughness, 0...1.
  float clearcoat_roughness = 0.0F;
  /// Factor of how much of it there is (red).
  TextureSlot clearcoat_texture = {};
  /// Factor of its roughness (green).
  TextureSlot clearcoat_roughness_texture = {};
  /// Its normals; those of the material below do not bend it.
  TextureSlot clearcoat_normal_texture = {};
  /// Factor of x and y of these normals, finite.
  float clearcoat_normal_scale = 1.0F;
  /// Colour of the sheen of cloth under the coat, 0...1; 0: there is none (KHR_materials_sheen).
  vec3 sheen_color{0.0F};
  /// The sheen's perceptual roughness, 0...1; below 0.07 it is taken for that.
  float sheen_roughness = 0.0F;
  /// Factors of its colour.
  TextureSlot sheen_color_texture = {};
  /// Factor of its roughness (alpha).
  TextureSlot sheen_roughness_texture = {};
  /// How strongly a thin film colours the reflection, 0...1 (KHR_materials_iridescence).
  float iridescence = 0.0F;
  /// The film's index of refraction, from 1 on.
  float iridescence_ior = 1.3F;
  /// The film's thickness in nanometres, not negative, where its texture is 0 and where it is 1. Without a texture it
  /// is the maximum. The minimum may be the larger of the two.
  float iridescence_thickness_minimum = 100.0F;
  float iridescence_thickness_maximum = 400.0F;  ///< See above.
  /// Factor of `iridescence` (red).
  TextureSlot iridescence_texture = {};
  /// From the minimum of the thickness to the maximum (green).
  TextureSlot iridescence_thickness_texture = {};
  /// How much highlights are stretched, 0...1 (KHR_materials_anisotropy), on meshes with texture coordinates.
  float anisotropy = 0.0F;
  /// Where to: radians, counterclockwise from the tangent.
  float anisotropy_rotation = 0.0F;
  /// The direction in tangent space (red and green, 0...1 for -1...1) and a factor of `anisotropy` (blue).
  TextureSlot anisotropy_texture = {};
};

/// A colour that no light changes (KHR_materials_unlit).
struct Unlit {
  /// What is seen.
  vec3 color{1.0F};
  /// Factors of it.
  TextureSlot color_texture = {};
};

/// What alpha does (glTF 2.0, section 3.9.4). Casts see geometry whatever its alpha.
enum class AlphaMode : uint32_t {
  /// Nothing.
  kOpaque = 0,
  /// What has less than the cutoff is not there; the rest is opaque.
  kMask = 1,
  /// Of the light from behind 1 - alpha is seen through the surface, and falls through it.
  kBlend = 2,
};

/// What an object's surface is made of.
struct Material {
  /// For people; empty where there is none.
  std::string name;
  /// One of the models above.
  std::variant<Phong, MetallicRoughness, Unlit> model;
  /// Light that the surface sends by itself, linear RGB, finite and not negative; it lights nothing else.
  vec3 emissive{0.0F};
  /// Factors of it; unlit materials have none.
  TextureSlot emissive_texture = {};
  /// What alpha does.
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  /// How much of what is behind it the surface covers, 0...1; the alpha of the model's base colour texture is a factor
  /// of it.
  float alpha = 1.0F;
  /// From which alpha on a masked surface is there, finite and not negative.
  float alpha_cutoff = 0.5F;
  /// Whether rays from the camera and from mirrors see both sides of triangles, or only the front, around which the
  /// corners go counterclockwise. Other shapes are seen from both sides, and shadows fall from either.
  bool is_double_sided = true;

  /// The model of a Phong material. Throws std::bad_variant_access where it is another.
  Phong& phong() { return std::get<Phong>(model); }
  /// The same, to read.
  const Phong& phong() const { return std::get<Phong>(model); }
};

}  // namespace promin
