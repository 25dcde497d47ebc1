// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "promin/ray.h"

// Orders rays so that they can be traced fast. The results of rays do not depend on the order.
namespace promin {

/// A cube around all geometry that rays may hit, except infinite planes.
struct SceneCube {
  vec3 center{0.0F};
  /// Half the cube's side, >= 0.
  float radius = 0.0F;
};

/// Returns the direction scaled so that its largest component is 1 or -1; NaN for a direction of 0.
inline vec3 scaled_direction(const Ray& ray) {
  const vec3 size = glm::abs(ray.direction);
  return ray.direction / std::max(std::max(size.x, size.y), size.z);
}

/// Returns the first ray of the i-th pair in a sample of all pairs of neighbouring rays. `ray_count` is at least 2. The
/// sample uses steps of the golden ratio, because with equal steps all samples could be at the ends of a picture's
/// rows.
inline size_t sampled_pair(size_t i, size_t ray_count) {
  return (i * size_t{0x9E3779B97F4A7C15}) % (ray_count - 1);
}

/// Returns whether most neighbouring rays have similar origins and directions, like the rays of a camera in pixel
/// order. The function tests a sample of the pairs.
bool are_side_by_side(std::span<const Ray> rays, const SceneCube& cube);

/// Sorts rays. The object keeps its memory for the next call.
class RaySorter {
 public:
  /// Returns the rays' indices in a new order. Rays that enter the cube close together and in similar directions are
  /// neighbours in it. The order follows a space-filling curve through entry point and direction (Aila & Karras,
  /// "Architecture Considerations for Tracing Incoherent Rays", HPG 2010). Rays that miss the cube or have no direction
  /// come last. There may be at most 2^32 - 1 rays. The order is stable and the same for every number of threads. The
  /// result is valid until the next call.
  std::span<const uint32_t> sort(std::span<const Ray> rays, const SceneCube& cube);

 private:
  struct KeyedRay {
    uint32_t key;
    uint32_t index;
  };

  UnsetVector<KeyedRay> keyed_;
  UnsetVector<KeyedRay> scattered_;
  UnsetVector<uint32_t> order_;
};

}  // namespace promin
