// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// Where a light comes from: kPoint, kDirectional, kSpot or kHeadlight, a directional light that shines along the view
/// of whatever camera looks.
enum class LightKind : uint32_t {
/// @cond
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) ENUMERATOR = NUMBER,
#include "promin/kinds/lights.def"
  /// @endcond
};

/// How a light's power falls with the distance d to the point that it lights.
enum class Attenuation {
  /// Not at all: classic lights.
  kNone,
  /// As clamp(1 - (d / range)^4, 0, 1) / d^2: physical lights.
  kInverseSquare,
};

/// A light with its own diffuse and specular power. By default it is a classic point light of power 1 at the origin.
/// validate() (promin/validate.h) checks the ranges that are given here.
struct Light {
  /// For people; empty where there is none.
  std::string name;
  /// Which of the members below count.
  LightKind kind = LightKind::kPoint;
  /// Of point and spot lights: where they are in the world.
  vec3 position{0.0F};
  /// Of directional and spot lights: unit vector in which the light travels.
  vec3 direction{0.0F, 0.0F, -1.0F};
  /// Linear RGB power in the diffuse term, finite and not negative; candela where the light falls off.
  vec3 diffuse{1.0F};
  /// The same in the specular term.
  vec3 specular{1.0F};
  /// Of point and spot lights: none by default.
  Attenuation attenuation = Attenuation::kNone;
  /// Distance beyond which a light that falls off brings nothing, in world units, > 0; infinite: no limit.
  float range = std::numeric_limits<float>::infinity();
  /// Half angle of the cone in which a spot has its whole power, radians, from 0 on. Between it and the outer cone the
  /// power falls as in KHR_lights_punctual. Where the angles' cosines are closer than 1e-5 (an outer angle under 0.0045
  /// with inner 0) the spot brings less: fp32 cannot tell where in so narrow a cone a point is.
  float inner_cone_angle = 0.0F;
  /// Half angle of the cone beyond which a spot brings nothing, radians, inner_cone_angle < outer_cone_angle <= pi / 2.
  float outer_cone_angle = 0.785398163F;
  /// A light that is off keeps its number, costs nothing and brings nothing.
  bool is_on = true;
};

/// The light of a scene without lights: a headlight of power 1 in both terms.
PROMIN_EXPORT Light make_headlight();

}  // namespace promin
