// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/rounding.h"

namespace promin {
namespace {

/// Number of pairs of rays that are tested. Two rays are side by side if their origins differ by at most kNearOrigin of
/// the cube's half side, and their directions by at most kNearDirection of the direction's largest component.
constexpr size_t kSamplePairs = 256;
constexpr float kNearOrigin = 0.1F;
constexpr float kNearDirection = 0.1F;

/// Number of bits in a sort key for each coordinate of the entry point and of the direction; the highest bits come
/// first. There are kCells cells along each side of the cube of points and of the cube of directions.
constexpr uint32_t kGridLevels = 5;
constexpr float kCells = 1U << kGridLevels;
constexpr uint32_t kKeyBits = 6 * kGridLevels;
constexpr uint32_t kMissKey = (1U << kKeyBits) - 1;
constexpr uint32_t kDigitBits = 10;
constexpr uint32_t kBuckets = 1U << kDigitBits;
static_assert(kKeyBits % kDigitBits == 0);

/// The smallest number of rays for which a thread is worth its cost.
constexpr size_t kLeastPart = 16384;

// Number of rays whose keys are computed at a time. Loops over arrays without branches become vector instructions; a
// computation ray by ray takes five times as long.
constexpr size_t kBlock = 64;
using RayBlock = std::array<float, kBlock>;

// These functions return the first number if the second is NaN.
float lesser(float a, float b) {
  return b < a ? b : a;
}
float greater(float a, float b) {
  return b > a ? b : a;
}

/// Returns the cell of x in [-1, 1] before it is rounded down. For any other x, also NaN, it returns some number in [0,
/// kCells).
float cell_of(float x) {
  return lesser(kCells - 1.0F, greater(0.0F, 0.5F * kCells * (x + 1.0F)));
}

/// Rounds a cell down and moves bit i of its number to bit 6 i. The product contains copies of the number at distances
/// that are one bit less than 6, so bit i of copy i is at bit 6 i.
uint32_t spread_bits(float cell) {
  static_assert(kGridLevels == 5);
  return (static_cast<uint32_t>(static_cast<int32_t>(cell)) * 0x108421U) & 0x1041041U;
}

/// Computes the keys of at most kBlock rays.
void compute_keys(std::span<const Ray> rays, const SceneCube& cube, std::span<uint32_t, kBlock> keys) {
  std::array<RayBlock, 3> origins{};
  std::array<RayBlock, 3> directions{};
  for (size_t i = 0; i < rays.size(); ++i) {
    const vec3& origin = rays[i].origin;
    const vec3& direction = rays[i].direction;
    origins[0][i] = origin.x;
    origins[1][i] = origin.y;
    origins[2][i] = origin.z;
    directions[0][i] = direction.x;
    directions[1][i] = direction.y;
    directions[2][i] = direction.z;
  }
  RayBlock scales;
  for (size_t i = 0; i < kBlock; ++i) {
    const float size_of_two = greater(std::fabs(directions[0][i]), std::fabs(directions[1][i]));
    scales[i] = 1.0F / greater(size_of_two, std::fabs(directions[2][i]));
  }

  // The following coordinates are relative to a cube from -1 to 1.
  RayBlock entry;
  RayBlock exit;
  entry.fill(0.0F);
  exit.fill(std::numeric_limits<float>::infinity());
  const float unit = 1.0F / cube.radius;
  for (int axis = 0; axis < 3; ++axis) {
    const float center = cube.center[axis];
    RayBlock& origin = origins[axis];
    RayBlock& direction = directions[axis];
    for (size_t i = 0; i < kBlock; ++i) {
      direction[i] *= scales[i];
      origin[i] = (origin[i] - center) * unit;
      const float inverse = 1.0F / direction[i];
      const float t0 = (-1.0F - origin[i]) * inverse;
      const float t1 = (1.0F - origin[i]) * inverse;
      entry[i] = greater(entry[i], lesser(t0, t1));
      exit[i] = lesser(exit[i], greater(t0, t1));
    }
  }

  RayBlock sums{};
  RayBlock point_cells;
  RayBlock direction_cells;
  std::fill(keys.begin(), keys.end(), 0U);
  for (int axis = 0; axis < 3; ++axis) {
    const RayBlock& origin = origins[axis];
    const RayBlock& direction = directions[axis];
    for (size_t i = 0; i < kBlock; ++i) {
      const float point = origin[i] + entry[i] * direction[i];
      sums[i] += point + direction[i];
      point_cells[i] = cell_of(point);
      direction_cells[i] = cell_of(direction[i]);
    }
    // This is a separate loop, because the compiler would turn rounding next to a comparison into a branch.
    for (size_t i = 0; i < kBlock; ++i) {
      keys[i] |= (spread_bits(point_cells[i]) << axis) | (spread_bits(direction_cells[i]) << (axis + 3));
    }
  }
  for (size_t i = 0; i < kBlock; ++i) {
    // The condition is also false if a number is infinite or NaN.
    const bool enters = entry[i] <= exit[i] && sums[i] - sums[i] == 0.0F;
    keys[i] = enters ? keys[i] : kMissKey;
  }
}

}  // namespace

bool are_side_by_side(std::span<const Ray> rays, const SceneCube& cube) {
  if (rays.size() < 2) return true;
  const size_t pairs = std::min(kSamplePairs, rays.size() - 1);
  size_t near_pairs = 0;
  for (size_t i = 0; i < pairs; ++i) {
    const size_t first = sampled_pair(i, rays.size());
    const Ray& a = rays[first];
    const Ray& b = rays[first + 1];
    const bool is_near = max_abs_component(b.origin - a.origin) <= kNearOrigin * cube.radius &&
                         max_abs_component(scaled_direction(b) - scaled_direction(a)) <= kNearDirection;
    near_pairs += is_near ? 1 : 0;
  }
  return 2 * near_pairs >= pairs;
}

std::span<const uint32_t> RaySorter::sort(std::span<const Ray> rays, const SceneCube& cube) {
  keyed_.resize(rays.size());
  scattered_.resize(rays.size());
  order_.resize(rays.size());
  const size_t part_count = std::clamp(rays.size() / kLeastPart, size_t{1}, size_t{core_count()});
  const size_t part_size = rays.size() / part_count + 1;
  for_each_chunk(rays.size(), part_size, 0, [&](size_t begin, size_t end) {
    std::array<uint32_t, kBlock> keys;
    for (size_t first = begin; first < end; first += kBlock) {
      const size_t count = std::min(kBlock, end - first);
      compute_keys(rays.subspan(first, count), cube, keys);
      for (size_t i = 0; i < count; ++i) keyed_[first + i] = {keys[i], static_cast<uint32_t>(first + i)};
    }
  });

  // The sort is a stable counting sort for each digit, the lowest digit first. Each thread sorts its part, so the order
  // does not depend on the number of threads.
  using Buckets = std::array<uint32_t, kBuckets>;
  std::vector<Buckets> buckets(part_count);
  for (uint32_t shift = 0; shift < kKeyBits; shift += kDigitBits) {
    const auto bucket_of = [shift](const KeyedRay& ray) { return (ray.key >> shift) & (kBuckets - 1); };
    for_each_chunk(rays.size(), part_size, 0, [&](size_t begin, size_t end) {
      Buckets& counts = buckets[begin / part_size];
      counts.fill(0);
      for (size_t i = begin; i < end; ++i) ++counts[bucket_of(keyed_[i])];
    });
    uint32_t place = 0;
    for (uint32_t bucket = 0; bucket < kBuckets; ++bucket) {
      for (Buckets& part : buckets) place += std::exchange(part[bucket], place);
    }
    const bool is_last = shift + kDigitBits == kKeyBits;
    for_each_chunk(rays.size(), part_size, 0, [&](size_t begin, size_t end) {
      Buckets& places = buckets[begin / part_size];
      for (size_t i = begin; i < end; ++i) {
        const uint32_t to = places[bucket_of(keyed_[i])]++;
        if (is_last) {
          order_[to] = keyed_[i].index;
        } else {
          scattered_[to] = keyed_[i];
        }
      }
    });
    keyed_.swap(scattered_);
  }
  return order_;
}

}  // namespace promin
