// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "core/rounding.h"
#include "promin/materials.h"

// Functions for rare properties of materials, most of them of metallic-roughness ones. Scenes without these properties
// do not pay for them.
namespace promin {

/// Returns whether the material emits light that other surfaces may receive.
inline bool emits_light(const Material& material) {
  return !std::holds_alternative<Unlit>(material.model) && max_component(material.emissive) > 0.0F;
}

inline bool has_coat(const MetallicRoughness& material) {
  return material.clearcoat > 0.0F;
}
inline bool has_sheen(const MetallicRoughness& material) {
  return max_component(material.sheen_color) > 0.0F;
}
/// Returns whether some scattered light leaves on the other side. A texture may turn a metal into a dielectric.
inline bool scatters_through(const MetallicRoughness& material) {
  const bool may_be_dielectric = material.metallic < 1.0F || material.metallic_roughness_texture.exists();
  return material.diffuse_transmission > 0.0F && may_be_dielectric;
}
inline bool is_iridescent(const MetallicRoughness& material) {
  return material.iridescence > 0.0F;
}
inline bool is_anisotropic(const MetallicRoughness& material) {
  return material.anisotropy > 0.0F;
}
/// Returns whether there are textures for the dielectric's reflection.
inline bool has_specular_textures(const MetallicRoughness& material) {
  return material.specular_texture.exists() || material.specular_color_texture.exists();
}
/// Returns whether the material has at least one of these rare properties.
inline bool is_extended(const MetallicRoughness& material) {
  return has_coat(material) || has_sheen(material) || has_specular_textures(material) || scatters_through(material) ||
         is_iridescent(material) || is_anisotropic(material);
}

}  // namespace promin
