// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "core/rounding.h"
#include "promin/materials.h"

// What materials let through (docs/model.md, "Glass").
namespace promin {

/// Whether light goes through it.
inline bool is_clear(const Phong& material) {
  return max_component(material.transmission) > 0.0F;
}
/// An index of refraction of 0 stands for a dielectric that reflects all.
inline bool is_clear(const MetallicRoughness& material) {
  return material.transmission > 0.0F && material.metallic < 1.0F && material.ior > 0.0F;
}
inline bool is_clear(const Unlit& /*material*/) {
  return false;
}
inline bool is_clear(const Material& material) {
  return std::visit([](const auto& model) { return is_clear(model); }, material.model);
}

/// Whether its mirror hangs on the angle.
inline bool hangs_on_angle(const Phong& material) {
  return material.fresnel && (is_clear(material) || max_component(material.reflection) > 0.0F);
}

}  // namespace promin
