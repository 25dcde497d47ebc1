// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/lights.h"

namespace promin {

/// Returns whether lights of this kind have a position. All other lights shine from infinity in one direction.
constexpr bool has_place(LightKind kind) {
  switch (kind) {
    case LightKind::kPoint:
    case LightKind::kSpot:
    case LightKind::kRect:
    case LightKind::kDisk:
      return true;
    case LightKind::kDirectional:
    case LightKind::kHeadlight:
      break;
  }
  return false;
}

/// Returns whether lights of this kind are flat and shine from one side.
constexpr bool is_flat(LightKind kind) {
  return kind == LightKind::kRect || kind == LightKind::kDisk;
}

/// Returns whether the light has a power that grows weaker with distance.
inline bool falls_off(const Light& light) {
  return has_place(light.kind) && !is_flat(light.kind) && light.attenuation == Attenuation::kInverseSquare;
}

/// Returns whether the light shines from more than one point or direction.
inline bool has_size(const Light& light) {
  if (is_flat(light.kind)) return true;
  if (has_place(light.kind)) return light.radius >= kLeastLightRadius;
  return light.kind == LightKind::kDirectional && light.angle > 0.0F;
}

}  // namespace promin
