// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "promin/materials.h"

namespace promin {

/// Returns the slot of the texture for colour and alpha.
inline const TextureSlot& base_slot(const MetallicRoughness& model) {
  return model.base_color_texture;
}
inline const TextureSlot& base_slot(const Unlit& model) {
  return model.color_texture;
}
inline const TextureSlot& base_slot(const Phong& model) {
  return model.diffuse_texture;
}
inline const TextureSlot& base_slot(const Material& material) {
  return std::visit([](const auto& model) -> const TextureSlot& { return base_slot(model); }, material.model);
}

// Calls a visitor with the texture slots of materials, each once: `visit(slot, name, use)` receives the slot, with or
// without a texture, the name of its member, and the use of the image.

template <typename Visit>
void for_each_slot(const Phong& model, const Visit& visit) {
  visit(model.diffuse_texture, "diffuse_texture", ImageUse::kColor);
  visit(model.specular_texture, "specular_texture", ImageUse::kColor);
  visit(model.normal_texture, "normal_texture", ImageUse::kNormal);
}

template <typename Visit>
void for_each_slot(const MetallicRoughness& model, const Visit& visit) {
  visit(model.base_color_texture, "base_color_texture", ImageUse::kColor);
  visit(model.metallic_roughness_texture, "metallic_roughness_texture", ImageUse::kData);
  visit(model.normal_texture, "normal_texture", ImageUse::kNormal);
  visit(model.occlusion_texture, "occlusion_texture", ImageUse::kData);
  visit(model.transmission_texture, "transmission_texture", ImageUse::kData);
  visit(model.diffuse_transmission_texture, "diffuse_transmission_texture", ImageUse::kData);
  visit(model.diffuse_transmission_color_texture, "diffuse_transmission_color_texture", ImageUse::kColor);
  visit(model.specular_texture, "specular_texture", ImageUse::kData);
  visit(model.specular_color_texture, "specular_color_texture", ImageUse::kColor);
  visit(model.clearcoat_texture, "clearcoat_texture", ImageUse::kData);
  visit(model.clearcoat_roughness_texture, "clearcoat_roughness_texture", ImageUse::kData);
  visit(model.clearcoat_normal_texture, "clearcoat_normal_texture", ImageUse::kNormal);
  visit(model.sheen_color_texture, "sheen_color_texture", ImageUse::kColor);
  visit(model.sheen_roughness_texture, "sheen_roughness_texture", ImageUse::kData);
  visit(model.iridescence_texture, "iridescence_texture", ImageUse::kData);
  visit(model.iridescence_thickness_texture, "iridescence_thickness_texture", ImageUse::kData);
  visit(model.anisotropy_texture, "anisotropy_texture", ImageUse::kData);
}

template <typename Visit>
void for_each_slot(const Unlit& model, const Visit& visit) {
  visit(model.color_texture, "color_texture", ImageUse::kColor);
}

/// Calls the visitor with the slots of the material's model and of its emission.
template <typename Visit>
void for_each_slot(const Material& material, const Visit& visit) {
  std::visit([&](const auto& model) { for_each_slot(model, visit); }, material.model);
  visit(material.emissive_texture, "emissive_texture", ImageUse::kColor);
}

}  // namespace promin
