// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <variant>

#include "core/rounding.h"
#include "promin/materials.h"
#include "scene/alpha.h"
#include "scene/texture_slots.h"

// Functions for materials that transmit light (docs/model.md, "Glass").
namespace promin {

// Returns whether the model transmits light.
inline bool is_clear(const Phong& model) {
  return max_component(model.transmission) > 0.0F;
}
/// Returns whether the model may transmit light. A texture may remove all metal, so `metallic` does not matter if there
/// is one. An index of refraction of 0 stands for a dielectric that reflects all light.
inline bool is_clear(const MetallicRoughness& model) {
  const bool may_be_dielectric = model.metallic < 1.0F || model.metallic_roughness_texture.exists();
  return model.transmission > 0.0F && may_be_dielectric && model.ior > 0.0F;
}
inline bool is_clear(const Unlit& /*model*/) {
  return false;
}

/// Returns whether the material transmits light. If a material is transparent because of its alpha, it transmits no
/// further light.
inline bool is_clear(const Material& material) {
  const bool may_blend = blends(material) && (material.alpha < 1.0F || base_slot(material).exists());
  return !may_blend && std::visit([](const auto& model) { return is_clear(model); }, material.model);
}

/// Returns whether the material's surfaces bound volumes of glass. Such surfaces are visible from both sides.
inline bool bounds_volume(const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  return is_clear(material) && (model == nullptr || model->thickness > 0.0F);
}
inline bool shows_backs(const Material& material) {
  return material.is_double_sided || bounds_volume(material);
}

/// Returns the difference between the indices of refraction of blue and green, which is also the difference between
/// green and red, in a metallic-roughness material (KHR_materials_dispersion). It is 0 if the material has no inside.
inline float index_spread(const MetallicRoughness& model) {
  if (model.thickness == 0.0F) return 0.0F;
  const double above_one = static_cast<double>(model.ior) - 1.0;
  return static_cast<float>(above_one * std::min(1.0, 0.025 * static_cast<double>(model.dispersion)));
}
inline bool parts_colors(const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  return model != nullptr && is_clear(material) && index_spread(*model) > 0.0F;
}

/// Returns whether the model's reflection depends on the angle.
inline bool hangs_on_angle(const Phong& model) {
  return model.fresnel && (is_clear(model) || max_component(model.reflection) > 0.0F);
}

}  // namespace promin
