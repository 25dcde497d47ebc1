// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "promin/math.h"

namespace promin {

/// The points origin + t * direction with tmin < t < tmax, in the world. The direction has any length except 0, and t
/// is in units of that length. A negative tmin, including -infinity, counts as 0; tmax may be infinite. A ray misses
/// everything if it contains a NaN, if another of its numbers is infinite, or if its origin lies beyond 10^38.
struct Ray {
  /// The point at t = 0.
  vec3 origin{0.0F};
  /// Only hits with t > tmin count.
  float tmin = 0.0F;
  /// The direction; its length is the unit of t. A ray with the default of 0 misses everything.
  vec3 direction{0.0F};
  /// Only hits with t < tmax count.
  float tmax = std::numeric_limits<float>::infinity();
};

/// The result of casting a ray. For HitQuery::kAny only t is set: 0 on a hit, infinite on a miss.
struct Hit {
  /// The ray's parameter at the hit, in units of its direction; infinite on a miss.
  float t = std::numeric_limits<float>::infinity();
  /// Index into Scene::objects; -1 on a miss.
  int32_t object = -1;
  /// Index of the triangle in the object's mesh, in the order of the file; 0 on analytic shapes; -1 on a miss.
  int32_t primitive = -1;
  /// Barycentric weight of a triangle's second corner; 0 on analytic shapes and on a miss.
  float u = 0.0F;
  /// Barycentric weight of a triangle's third corner; 0 on analytic shapes and on a miss.
  float v = 0.0F;
  /// Geometric unit normal in the world. It points to the side from which a triangle's corners run counter-clockwise,
  /// outwards on a solid, and along a plane's own normal. It never depends on the ray. 0 on a miss.
  vec3 normal{0.0F};
};

// RAYS.npy and HITS.npy have this layout.
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 32);

/// The query that a ray answers.
enum class HitQuery {
  /// The query for the hit with the smallest t. If several hits have the same t, the hit with the lowest (object,
  /// primitive) counts.
  kNearest,
  /// The query whether there is any hit (occlusion). It is faster than kNearest.
  kAny,
  /// The query for the number of crossings with all primitives (Caster::count).
  kCount,
  /// The query for all crossings with all primitives (Caster::list).
  kAll,
};

}  // namespace promin
