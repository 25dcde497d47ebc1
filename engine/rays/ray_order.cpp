// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace promin {
namespace {

/// Pairs that are looked at, and how near two rays are that count as side by side, in parts of the cube's half side and
/// of the direction's largest component.
constexpr size_t kSamplePairs = 1024;
constexpr float kNearOrigin = 0.1F;
constexpr float kNearDirection = 0.1F;

/// A sort key has kLevels bits of each coordinate of the entry point and of the direction, the highest first.
constexpr uint32_t kLevels = 5;
constexpr uint32_t kKeyBits = 6 * kLevels;
constexpr uint32_t kMissKey = (1U << kKeyBits) - 1;
constexpr uint32_t kDigitBits = 10;
static_assert(kKeyBits % kDigitBits == 0);

constexpr size_t kChunkRays = 16384;

struct KeyedRay {
  uint32_t key;
  uint32_t index;
};

/// Its largest component is 1 or -1; NaN where there is no direction.
vec3 scaled_direction(const Ray& ray) {
  const vec3 size = glm::abs(ray.direction);
  return ray.direction / std::max(std::max(size.x, size.y), size.z);
}

/// Of x in [-1, 1] the cell, of 2^kLevels; of any other x, NaN too, one of them.
uint32_t cell_of(float x) {
  constexpr float kCells = 1U << kLevels;
  const float cell = 0.5F * (x + 1.0F) * kCells;
  return static_cast<uint32_t>(cell > 0.0F ? (cell < kCells - 1.0F ? cell : kCells - 1.0F) : 0.0F);
}

/// Puts bit i at 6 i.
constexpr std::array<uint32_t, 1U << kLevels> make_spread_bits() {
  std::array<uint32_t, 1U << kLevels> spread{};
  for (uint32_t x = 0; x < spread.size(); ++x) {
    for (uint32_t bit = 0; bit < kLevels; ++bit) spread[x] |= ((x >> bit) & 1U) << (6 * bit);
  }
  return spread;
}
constexpr std::array<uint32_t, 1U << kLevels> kSpreadBits = make_spread_bits();

uint32_t key_of(const Ray& ray, const SceneCube& cube) {
  const vec3 direction = scaled_direction(ray);
  const vec3 origin = (ray.origin - cube.center) / cube.radius;
  float entry = 0.0F;
  float exit = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1.0F / direction[axis];
    const float t0 = (-1.0F - origin[axis]) * inverse;
    const float t1 = (1.0F - origin[axis]) * inverse;
    entry = std::max(entry, std::min(t0, t1));
    exit = std::min(exit, std::max(t0, t1));
  }
  const vec3 point = origin + entry * direction;
  // Also false where anything is NaN.
  const bool enters =
      entry <= exit && std::isfinite(point.x + point.y + point.z + direction.x + direction.y + direction.z);
  uint32_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key |= kSpreadBits[cell_of(point[axis])] << axis;
    key |= kSpreadBits[cell_of(direction[axis])] << (axis + 3);
  }
  return enters ? key : kMissKey;
}

}  // namespace

bool are_side_by_side(std::span<const Ray> rays, const SceneCube& cube) {
  if (rays.size() < 2) return true;
  const size_t pairs = std::min(kSamplePairs, rays.size() - 1);
  size_t near_pairs = 0;
  for (size_t i = 0; i < pairs; ++i) {
    // Steps by the golden ratio: even ones would all fall on the ends of a picture's rows.
    const size_t first = (i * size_t{0x9E3779B97F4A7C15}) % (rays.size() - 1);
    const Ray& a = rays[first];
    const Ray& b = rays[first + 1];
    const bool is_near = max_abs_component(b.origin - a.origin) <= kNearOrigin * cube.radius &&
                         max_abs_component(scaled_direction(b) - scaled_direction(a)) <= kNearDirection;
    near_pairs += is_near ? 1 : 0;
  }
  return 2 * near_pairs >= pairs;
}

std::vector<uint32_t> sort_rays(std::span<const Ray> rays, const SceneCube& cube) {
  std::vector<KeyedRay> sorted(rays.size());
  for_each_chunk(rays.size(), kChunkRays, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sorted[i] = {key_of(rays[i], cube), static_cast<uint32_t>(i)};
  });

  // A stable counting sort for each digit, the lowest first.
  std::vector<KeyedRay> scattered(rays.size());
  for (uint32_t shift = 0; shift < kKeyBits; shift += kDigitBits) {
    constexpr uint32_t kDigitMask = (1U << kDigitBits) - 1;
    std::array<uint32_t, kDigitMask + 2> begin{};
    for (const KeyedRay& ray : sorted) ++begin[((ray.key >> shift) & kDigitMask) + 1];
    for (uint32_t digit = 1; digit <= kDigitMask; ++digit) begin[digit] += begin[digit - 1];
    for (const KeyedRay& ray : sorted) scattered[begin[(ray.key >> shift) & kDigitMask]++] = ray;
    sorted.swap(scattered);
  }
  std::vector<uint32_t> order(rays.size());
  std::transform(sorted.begin(), sorted.end(), order.begin(), [](const KeyedRay& ray) { return ray.index; });
  return order;
}

}  // namespace promin
