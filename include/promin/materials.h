// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

/// Phong (docs/model.md, "Light"). All factors are linear RGB and not negative; nothing is clamped to 1.
struct Material {
  std::string name;
  vec3 ambient{0.8F};
  /// Kd as it multiplies N.L * i_d: a metallic-roughness material's base colour arrives divided by pi.
  vec3 diffuse{0.8F};
  vec3 specular{0.0F};
  /// Phong's exponent; <= 0 means no specular term.
  float shininess = 0.0F;
  /// kr: weight of the mirror ray.
  vec3 reflection{0.0F};
  /// Added as it is.
  vec3 emissive{0.0F};
};

}  // namespace promin
