// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "promin/math.h"

namespace promin {

/// The points origin + t * direction with tmin < t < tmax, in the world. The direction has any length except 0, and t
/// is in units of that length. A negative tmin, including -infinity, counts as 0; tmax may be infinite. A ray misses
/// everything if it contains a NaN or another infinity, or if its origin lies beyond 10^38.
struct Ray {
  /// The point at t = 0.
  vec3 origin{0.0F};
  /// Only hits with a larger t count.
  float tmin = 0.0F;
  /// The unit of t. A ray with the default of 0 misses everything.
  vec3 direction{0.0F};
  /// Only hits with a smaller t count.
  float tmax = std::numeric_limits<float>::infinity();
};

/// The result of casting a ray. For HitQuery::kAny only t is set: 0 on a hit, infinite on a miss.
struct Hit {
  /// The ray's parameter at the hit, in units of its direction; infinite on a miss.
  float t = std::numeric_limits<float>::infinity();
  /// Index into Scene::objects; -1 on a miss.
  int32_t object = -1;
  /// Triangle of the object in file order, 0 on analytic shapes; -1 on a miss.
  int32_t primitive = -1;
  /// Weight of a triangle's second corner; 0 on analytic shapes and on a miss.
  float u = 0.0F;
  /// Weight of a triangle's third corner; 0 on analytic shapes and on a miss.
  float v = 0.0F;
  /// Geometric unit normal: as wound (counter-clockwise), outward, a plane's own; never flipped to the ray. 0 on a
  /// miss.
  vec3 normal{0.0F};
};

// The layout is that of RAYS.npy and HITS.npy.
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);

/// The question that a ray answers.
enum class HitQuery {
  /// The hit with the smallest t; of several with the same t the one with the lower (object, primitive).
  kNearest,
  /// Whether there is any hit (occlusion); this is faster.
  kAny,
  /// The number of crossings with all primitives (Caster::count).
  kCount,
  /// All of these crossings (Caster::list).
  kAll,
};

}  // namespace promin
