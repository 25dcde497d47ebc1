// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "promin/math.h"

namespace promin {

/// The points origin + t * direction with tmin < t < tmax, in the world. The direction has any length but 0, and t is
/// in its units. A negative tmin, -infinity too, counts as 0; tmax may be infinite. NaN anywhere, an infinity elsewhere
/// or an origin beyond 10^38 makes a ray that misses everything.
struct Ray {
  /// Where t is 0.
  vec3 origin{0.0F};
  /// Hits at this t and before are none.
  float tmin = 0.0F;
  /// The unit of t; a ray with the default of 0 misses everything.
  vec3 direction{0.0F};
  /// Hits at this t and beyond are none.
  float tmax = std::numeric_limits<float>::infinity();
};

/// The answer to a ray. To a HitQuery::kAny ray only t: 0 on a hit, infinite on a miss.
struct Hit {
  /// Where on the ray, in units of its direction; infinite on a miss.
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

// As they lie in RAYS.npy and HITS.npy.
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);

/// What is asked of a ray.
enum class HitQuery {
  /// The hit with the least t; of several at the same t the one with the lower (object, primitive).
  kNearest,
  /// Whether there is any hit (occlusion), which is answered faster.
  kAny,
  /// How many crossings the ray has with all primitives (Caster::count).
  kCount,
  /// All of these crossings (Caster::list).
  kAll,
};

}  // namespace promin
