// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "promin/math.h"

namespace promin {

/// P(t) = origin + t * direction; a hit has tmin < t < tmax. The direction has any length but 0, and t is in its
/// units. A negative tmin, -infinity too, counts as 0; tmax may be infinite. NaN anywhere, an infinity elsewhere or an
/// origin beyond 10^38 makes a ray that misses everything.
struct Ray {
  vec3 origin{0.0F};
  float tmin = 0.0F;
  vec3 direction{0.0F};
  float tmax = std::numeric_limits<float>::infinity();
};

/// The answer to a ray. To a HitQuery::kAny ray only t: 0 on a hit, infinite on a miss.
struct Hit {
  /// Infinite on a miss.
  float t = std::numeric_limits<float>::infinity();
  /// Index into Scene::objects; -1 on a miss.
  int32_t object = -1;
  /// Triangle of the object in file order, 0 on analytic shapes; -1 on a miss.
  int32_t primitive = -1;
  /// Weights of a triangle's second and third corner; 0 on analytic shapes and on a miss.
  float u = 0.0F;
  float v = 0.0F;
  /// Geometric, unit: as wound (counter-clockwise), outward, a plane's own; never flipped to the ray. 0 on a miss.
  vec3 normal{0.0F};
};

// As they lie in RAYS.npy and HITS.npy.
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);

enum class HitQuery {
  /// The hit with the least t; of several at the same t the one with the lower (object, primitive).
  kNearest,
  /// Whether there is any: occlusion.
  kAny,
};

}  // namespace promin
