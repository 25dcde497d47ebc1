// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/pack_sky.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "core/parallel.h"
#include "core/radical_inverse.h"
#include "environment/octahedron.h"
#include "environment/shrink_panorama.h"
#include "environment/sky_map.h"
#include "environment/sky_pyramid.h"
#include "environment/sky_radiance.h"
#include "shared/layout.h"

namespace promin {
namespace {

using std::numbers::pi;

constexpr float kLargestHalf = 65504.0F;

struct SkyLevel {
  double roughness;
  uint32_t shift;
};
constexpr SkyLevel kLevels[] = {
#define PROMIN_SKY_LEVEL(ROUGHNESS, SHIFT) {ROUGHNESS, SHIFT},
#include "shade/sky_levels.def"
};
constexpr uint32_t kLevelCount = std::size(kLevels);

/// Number of directions of a lobe for a texel of each level except the sharpest. Few directions are enough, because the
/// sky is blurred beforehand; a panorama, which may contain a sun, gets twice as many.
constexpr uint32_t kLobeSamples[kLevelCount] = {0, 16, 32, 64, 192, 512};

/// Side of the sharpest level for the studio and gradients, whose edges are some degrees wide. Compared with an
/// integration over 20,000 directions, the studio's error is .014 (rms) at roughness 0, .018 at .1 and .2, and .003 at
/// 1; the mean radiance is .48.
constexpr uint32_t kSmoothSide = 256;
constexpr uint32_t kLeastPanoramaSide = 128;
constexpr uint32_t kMostSide = 512;
uint32_t side_of(const Environment& environment) {
  struct Side {
    uint32_t operator()(std::monostate) const { return 0; }
    uint32_t operator()(const Studio&) const { return kSmoothSide; }
    uint32_t operator()(const GradientSky&) const { return kSmoothSide; }
    uint32_t operator()(const Panorama& panorama) const {
      // The horizon has the panorama's width, and is as long as two sides of the square.
      return std::clamp(std::bit_ceil((panorama.image->size.x + 1) / 2), kLeastPanoramaSide, kMostSide);
    }
  };
  return std::visit(Side(), environment.sky);
}

/// Returns the number of levels of the pyramid. Smooth skies need squares of a few degrees. A panorama may have a sun,
/// so its squares are its texels.
uint32_t pyramid_levels_of(const Environment& environment) {
  constexpr uint32_t kSmoothLevels = 6;
  const auto side_bits = static_cast<uint32_t>(std::bit_width(side_of(environment)));
  if (side_bits == 0) return 0;
  return std::holds_alternative<Panorama>(environment.sky) ? side_bits - 1 : kSmoothLevels;
}

/// Returns the mean radiance of each texel, from `count` x `count` lookups in the texel.
SkyMap look_up_sky(const Environment& environment, uint32_t side, int count, unsigned thread_count) {
  SkyMap map(static_cast<int>(side));
  const double step = 1.0 / (count * static_cast<double>(side));
  for_each_index(side, thread_count, [&](size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < map.side(); ++x) {
      dvec3 sum(0.0);
      double weights = 0.0;
      for (int i = 0; i < count * count; ++i) {
        const dvec2 sample(count * x + i % count, count * y + i / count);
        const dvec2 place = step * (sample + 0.5);
        const double weight = solid_angle_density(place);
        sum += weight * sky_radiance(environment, octahedral_point(place));
        weights += weight;
      }
      map.at(x, y) = vec4(vec3(sum / weights), 0.0F);
    }
  });
  map.fill_border();
  return map;
}

/// Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001: Returns the
/// bands 0, 1 and 2 of the radiance, multiplied by 1, 2/3 and 1/4, which are the cosine's coefficients divided by pi.
std::array<vec4, 9> project_irradiance(const SkyMap& map) {
  std::array<dvec3, 9> sums{};
  double weights = 0.0;
  for (int y = 0; y < map.side(); ++y) {
    for (int x = 0; x < map.side(); ++x) {
      const dvec2 place = (dvec2(x, y) + 0.5) / static_cast<double>(map.side());
      const dvec3 n = glm::normalize(octahedral_point(place));
      const double weight = solid_angle_density(place);
      const dvec3 light = weight * dvec3(vec3(map.at(x, y)));
      const double basis[9] = {1.0,
                               2.0 * n.y,
                               2.0 * n.z,
                               2.0 * n.x,
                               3.75 * n.x * n.y,
                               3.75 * n.y * n.z,
                               0.3125 * (3.0 * n.z * n.z - 1.0),
                               3.75 * n.z * n.x,
                               0.9375 * (n.x * n.x - n.y * n.y)};
      for (int i = 0; i < 9; ++i) sums[i] += basis[i] * light;
      weights += weight;
    }
  }
  std::array<vec4, 9> result{};
  for (int i = 0; i < 9; ++i) result[i] = vec4(vec3(sums[i] / weights), 0.0F);
  return result;
}

/// A direction of a lobe around +Z, and the map from which its radiance is read.
struct LobeSample {
  vec3 direction;
  float weight;
  uint32_t map;
  /// The weight of the next coarser map.
  float coarser;
};

/// Returns samples of a lobe: half vectors that are distributed by GGX at Hammersley points. A sample stands for the
/// solid angle 4 / (n D) and is read from the map whose texels have this size (Colbert and Krivanek, GPU Gems 3, ch.
/// 20). The weights add up to 1.
std::vector<LobeSample> sample_lobe(double roughness, uint32_t count, const std::vector<SkyMap>& maps) {
  const double alpha = roughness * roughness;
  std::vector<LobeSample> samples;
  double weights = 0.0;
  for (uint32_t i = 0; i < count; ++i) {
    const double xi = (i + 0.5) / count;
    const double azimuth = 2.0 * pi * radical_inverse(i);
    const double cosine2 = (1.0 - xi) / (1.0 + (alpha * alpha - 1.0) * xi);
    const double cosine_to_light = 2.0 * cosine2 - 1.0;
    if (!(cosine_to_light > 0.0)) continue;
    const double sine_to_light = std::sqrt(1.0 - cosine_to_light * cosine_to_light);
    const double spread = cosine2 * (alpha * alpha - 1.0) + 1.0;
    const double density = alpha * alpha / (pi * spread * spread);
    const double texels = 4.0 / (count * density) * std::pow(maps.front().side(), 2) / (4.0 * pi);
    // The level is half a level sharper, because interpolation blurs too.
    const double level = std::clamp(0.5 * std::log2(texels) - 0.5, 0.0, static_cast<double>(maps.size()) - 1.001);
    const double map = std::floor(level);
    samples.push_back(
        {vec3(dvec3(sine_to_light * std::cos(azimuth), sine_to_light * std::sin(azimuth), cosine_to_light)),
         static_cast<float>(cosine_to_light), static_cast<uint32_t>(map), static_cast<float>(level - map)});
    weights += cosine_to_light;
  }
  for (LobeSample& sample : samples) sample.weight /= static_cast<float>(weights);
  return samples;
}

/// Returns two unit vectors that are perpendicular to n and to each other.
std::pair<vec3, vec3> make_frame(const vec3& n) {
  const vec3 other = std::abs(n.y) < 0.9F ? vec3(0.0F, 1.0F, 0.0F) : vec3(1.0F, 0.0F, 0.0F);
  const vec3 tangent = glm::normalize(glm::cross(other, n));
  return {tangent, glm::cross(n, tangent)};
}

/// Blurs the sky with a lobe. `maps` are the sky at decreasing resolutions.
SkyMap blur(const std::vector<SkyMap>& maps, uint32_t side, const std::vector<LobeSample>& lobe,
            unsigned thread_count) {
  SkyMap blurred(static_cast<int>(side));
  for_each_index(side, thread_count, [&](size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < blurred.side(); ++x) {
      const dvec2 place = (dvec2(x, y) + 0.5) / static_cast<double>(side);
      const vec3 normal(glm::normalize(octahedral_point(place)));
      const auto [tangent, bitangent] = make_frame(normal);
      vec4 sum(0.0F);
      for (const LobeSample& sample : lobe) {
        const vec3 direction =
            sample.direction.x * tangent + sample.direction.y * bitangent + sample.direction.z * normal;
        vec4 radiance = maps[sample.map].look_up(direction);
        if (sample.coarser > 0.0F) {
          radiance += sample.coarser * (maps[sample.map + 1].look_up(direction) - radiance);
        }
        sum += sample.weight * radiance;
      }
      blurred.at(x, y) = sum;
    }
  });
  blurred.fill_border();
  return blurred;
}

uint32_t pack_halves(float low, float high) {
  const auto half = [](float x) { return uint32_t{glm::packHalf1x16(std::clamp(x, 0.0F, kLargestHalf))}; };
  return half(low) | half(high) << 16;
}

void append(const SkyMap& map, std::vector<uvec4>& texels) {
  for (int y = -1; y <= map.side(); ++y) {
    for (int x = -1; x < map.side(); ++x) {
      const vec4& a = map.at(x, y);
      const vec4& b = map.at(x + 1, y);
      texels.emplace_back(pack_halves(a.x, a.y), pack_halves(a.z, b.x), pack_halves(b.y, b.z), 0);
    }
  }
}

}  // namespace

uint32_t side_of_level(uint32_t sharpest_side, uint32_t level) {
  return std::max(sharpest_side >> kLevels[level].shift, std::min(sharpest_side, layout::LEAST_SKY_SIDE));
}

PackedSky pack_sky(const Environment& environment, unsigned thread_count) {
  PackedSky packed;
  packed.side = side_of(environment);
  if (packed.side == 0) return packed;
  // A panorama may contain any detail, so it gets more lookups than smooth skies.
  Environment looked_up = environment;
  auto* panorama = std::get_if<Panorama>(&looked_up.sky);
  const uint32_t factor = panorama == nullptr ? 1 : 2;
  if (panorama != nullptr) *panorama = shrink_panorama(*panorama, 2 * packed.side, thread_count);
  std::vector<SkyMap> maps = {look_up_sky(looked_up, packed.side, panorama == nullptr ? 2 : 3, thread_count)};
  packed.irradiance = project_irradiance(maps.front());
  while (maps.back().side() > 4) maps.push_back(halve(maps.back()));
  packed.texels.reserve(packed_sky_bytes(environment) / sizeof(uvec4));
  append(maps.front(), packed.texels);
  for (uint32_t level = 1; level < kLevelCount; ++level) {
    const std::vector<LobeSample> lobe = sample_lobe(kLevels[level].roughness, factor * kLobeSamples[level], maps);
    append(blur(maps, side_of_level(packed.side, level), lobe, thread_count), packed.texels);
  }
  packed.first_of_pyramid = static_cast<uint32_t>(packed.texels.size());
  packed.pyramid_levels = pyramid_levels_of(environment);
  const std::vector<uvec4> pyramid = make_sky_pyramid(maps.front(), packed.pyramid_levels);
  packed.texels.insert(packed.texels.end(), pyramid.begin(), pyramid.end());
  return packed;
}

uint64_t packed_sky_bytes(const Environment& environment) {
  const uint32_t sharpest = side_of(environment);
  if (sharpest == 0) return 0;
  uint64_t entries = 0;
  for (uint32_t level = 0; level < kLevelCount; ++level) {
    const uint64_t side = side_of_level(sharpest, level);
    entries += (side + 1) * (side + 2);
  }
  // A pyramid of n levels has 1 + 4 + ... + 4^(n - 1) entries.
  entries += ((uint64_t{1} << (2 * pyramid_levels_of(environment))) - 1) / 3;
  return entries * sizeof(uvec4);
}

}  // namespace promin
