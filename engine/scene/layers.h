// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/rounding.h"
#include "promin/materials.h"

// What few metallic-roughness materials have; scenes without them pay for none of it.
namespace promin {

inline bool has_coat(const MetallicRoughness& material) {
  return material.clearcoat > 0.0F;
}
inline bool has_sheen(const MetallicRoughness& material) {
  return max_component(material.sheen_color) > 0.0F;
}
/// Textures of what the dielectric reflects.
inline bool has_specular_textures(const MetallicRoughness& material) {
  return material.specular_texture.exists() || material.specular_color_texture.exists();
}

}  // namespace promin
