// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

/// A material of Phong's model (docs/model.md, "Light"). All factors are linear RGB, finite and not negative; nothing
/// is clamped to 1. The default is a matt light grey.
struct Material {
  /// For people; empty where there is none.
  std::string name;
  /// Weight of Environment::ambient.
  vec3 ambient{0.8F};
  /// Weight of N.L times a light's diffuse power. Of a metallic-roughness material it is the base colour over pi.
  vec3 diffuse{0.8F};
  /// Weight of the highlight times a light's specular power.
  vec3 specular{0.0F};
  /// Phong's exponent, finite; <= 0: there is no specular term.
  float shininess = 0.0F;
  /// Weight of what the mirror ray brings; 0 traces none.
  vec3 reflection{0.0F};
  /// Light that the surface sends by itself; it lights nothing else.
  vec3 emissive{0.0F};
};

}  // namespace promin
