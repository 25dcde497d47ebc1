// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// The kind of a light: kPoint, kDirectional, kSpot, kRect, kDisk or kHeadlight, a directional light that shines in the
/// current camera's direction of view. kRect and kDisk are flat lights that shine from one side.
enum class LightKind : uint32_t {
/// @cond
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) ENUMERATOR = NUMBER,
#include "promin/kinds/lights.def"
  /// @endcond
};

/// The decrease of a light's power with the distance d to the lit point.
enum class Attenuation {
  /// The power does not decrease, as in classic lights.
  kNone,
  /// The power decreases by the factor clamp(1 - (d / range)^4, 0, 1) / d^2, as in physical lights.
  kInverseSquare,
};

/// A light with a diffuse and a specular power. The default is a classic point light of power 1 at the origin.
/// validate() (promin/validate.h) checks the ranges below.
struct Light {
  /// The display name; empty if there is none.
  std::string name;
  /// The kind, which determines which of the members below are used.
  LightKind kind = LightKind::kPoint;
  /// Position of point and spot lights in the world; the middle of flat lights.
  vec3 position{0.0F};
  /// Unit vector: the direction in which the light of directional and spot lights travels; the normal of flat lights.
  vec3 direction{0.0F, 0.0F, -1.0F};
  /// Power for the diffuse term, linear RGB, finite and not negative; in candela for lights with attenuation. The
  /// radiance of flat lights, in nits.
  vec3 diffuse{1.0F};
  /// Power for the specular term, in the same units.
  vec3 specular{1.0F};
  /// Attenuation of point and spot lights; none by default.
  Attenuation attenuation = Attenuation::kNone;
  /// Distance beyond which a light with attenuation contributes nothing, in world units, > 0; infinite for no limit.
  float range = std::numeric_limits<float>::infinity();
  /// Half the angle of the cone in which a spot light has its full power, in radians, >= 0. Between this cone and the
  /// outer cone the power decreases as in KHR_lights_punctual. If the cosines of the angles differ by less than 1e-5
  /// (an outer angle below 0.0045 with inner 0), the spot is darker, because fp32 cannot resolve positions in so narrow
  /// a cone.
  float inner_cone_angle = 0.0F;
  /// Half the angle of the cone outside which a spot light contributes nothing, in radians, inner_cone_angle <
  /// outer_cone_angle <= pi / 2.
  float outer_cone_angle = 0.785398163F;
  /// Radius of point and spot lights in world units, 0 to 1e15. A light with a radius is a ball that shines evenly and
  /// casts soft shadows; it is visible only as light. A radius below kLeastLightRadius counts as 0.
  float radius = 0.0F;
  /// The full angle of directional lights in radians, 0 to pi: a disc in the sky that shines evenly and casts soft
  /// shadows, as the sun does (0.0093).
  float angle = 0.0F;
  /// Width and height of flat lights in world units, 1e-15 to 1e15. A disk has two equal diameters.
  vec2 size{1.0F};
  /// Unit vector along the width of flat lights, at a right angle to `direction`.
  vec3 right{1.0F, 0.0F, 0.0F};
  /// True if the light is on. A light that is off keeps its index, costs nothing and contributes nothing.
  bool is_on = true;
};

/// The smallest side of a flat light.
inline constexpr float kLeastLightSide = 1e-15F;
/// The smallest radius of a light, because fp32 cannot store the square of a smaller one.
inline constexpr float kLeastLightRadius = 1e-18F;

/// Returns the light for scenes without lights: a headlight with a diffuse and a specular power of 1.
PROMIN_EXPORT Light make_headlight();

}  // namespace promin
