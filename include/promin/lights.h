// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// Kinds of promin/kinds/lights.def. A headlight is a directional light that shines along the view of whatever camera
/// looks.
enum class LightKind : uint32_t {
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) ENUMERATOR = NUMBER,
#include "promin/kinds/lights.def"
};

enum class Attenuation { kNone, kInverseSquare };

/// A light with its own diffuse and specular power. Classic lights do not fall off with distance; physical ones
/// (KHR_lights_punctual) have candela in both powers and fall off as clamp(1 - (d/range)^4, 0, 1) / d^2.
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  /// Of point and spot lights.
  vec3 position{0.0F};
  /// Unit vector in which the light travels; of directional and spot lights.
  vec3 direction{0.0F, 0.0F, -1.0F};
  vec3 diffuse{1.0F};
  vec3 specular{1.0F};
  Attenuation attenuation = Attenuation::kNone;
  /// > 0; infinite: no limit.
  float range = std::numeric_limits<float>::infinity();
  /// Half angles of a spot, radians, 0 <= inner < outer <= pi/2.
  float inner_cone_angle = 0.0F;
  float outer_cone_angle = 0.785398163F;
  /// A light that is off keeps its number, costs nothing and brings nothing.
  bool is_on = true;
};

/// The light of a scene without lights: i_d = i_s = 1.
PROMIN_EXPORT Light make_headlight();

}  // namespace promin
