// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "promin/ray.h"

// In which order rays are best traced. No answer depends on it.
namespace promin {

/// Where the scene is: a cube around everything that rays may hit, infinite planes aside.
struct SceneCube {
  vec3 center{0.0F};
  /// Half its side; >= 0.
  float radius = 0.0F;
};

/// The direction with its largest component 1 or -1; NaN where there is none.
inline vec3 scaled_direction(const Ray& ray) {
  const vec3 size = glm::abs(ray.direction);
  return ray.direction / std::max(std::max(size.x, size.y), size.z);
}

/// Of a sample of all pairs of rays next to each other the i-th: the first of the two. `ray_count` is at least 2. Steps
/// by the golden ratio: even ones would all fall on the ends of a picture's rows.
inline size_t sampled_pair(size_t i, size_t ray_count) {
  return (i * size_t{0x9E3779B97F4A7C15}) % (ray_count - 1);
}

/// Whether rays next to each other mostly begin and go near each other, as those of a camera in pixel order do; judged
/// by a sample of the pairs.
bool are_side_by_side(std::span<const Ray> rays, const SceneCube& cube);

/// Sorts rays; keeps its memory for the next ones.
class RaySorter {
 public:
  /// The rays' indices, those together that enter the cube near each other in similar directions: along a space-filling
  /// curve through where and whither (Aila & Karras, "Architecture Considerations for Tracing Incoherent Rays", HPG
  /// 2010). Rays that miss the cube, and such as have no direction, come last. At most 2^32 - 1 rays; stable, and the
  /// same with any number of threads. Valid until the next call.
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
