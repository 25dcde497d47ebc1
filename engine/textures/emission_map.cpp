// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/emission_map.h"

#include <algorithm>
#include <cmath>

#include "core/divide_up.h"
#include "core/rounding.h"
#include "core/srgb.h"

namespace promin {
namespace {

/// The largest number of squares along a side of the finest level.
constexpr uint32_t kMostSquares = 256;

/// The largest number of squares along a side of a triangle's box.
constexpr int kMostAcross = 8;

/// The smallest mean of a triangle that may show light, as a share of the mean over its box.
constexpr float kLeastTexelShare = 1.0F / 16.0F;

/// Returns the index of the square inside the image for one outside.
int wrap_square(int i, int count, TextureWrap mode) {
  if (mode == TextureWrap::kClampToEdge) return std::clamp(i, 0, count - 1);
  const int period = mode == TextureWrap::kMirroredRepeat ? 2 * count : count;
  const int rest = ((i % period) + period) % period;
  return rest < count ? rest : period - 1 - rest;
}

/// Returns the distance by which an interval of texels is moved so that it begins in the first period of the image, or
/// next to the image if that does not repeat. The interval shows the same texels there.
double way_to_image(double lo, double hi, uint32_t size, TextureWrap mode) {
  if (mode == TextureWrap::kClampToEdge) return lo > size ? size - lo : std::max(-1.0 - hi, 0.0);
  const double period = mode == TextureWrap::kMirroredRepeat ? 2.0 * size : size;
  return -period * std::floor(lo / period);
}

double cross_of(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool is_inside_corners(const std::array<dvec2, 3>& corners, const dvec2& point) {
  const double ab = cross_of(corners[1] - corners[0], point - corners[0]);
  const double bc = cross_of(corners[2] - corners[1], point - corners[1]);
  const double ca = cross_of(corners[0] - corners[2], point - corners[2]);
  return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

}  // namespace

EmissionMap::EmissionMap(std::span<const uint32_t> texels, const uvec2& size)
    : size_(size), side_(divide_up(std::max(size.x, size.y), kMostSquares)) {
  std::array<float, 256> light{};
  for (size_t code = 0; code < 256; ++code) {
    light[code] = static_cast<float>(srgb_to_linear(static_cast<double>(code) / 255.0));
  }
  Level level;
  level.size = glm::ivec2(divide_up(size.x, side_), divide_up(size.y, side_));
  const size_t count = static_cast<size_t>(level.size.x) * static_cast<size_t>(level.size.y);
  level.means.resize(count);
  level.largest.resize(count);
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) {
      const uint32_t word = texels[size_t{y} * size.x + x];
      const vec3 color(light[word & 0xFF], light[word >> 8 & 0xFF], light[word >> 16 & 0xFF]);
      const size_t square = size_t{y / side_} * static_cast<size_t>(level.size.x) + x / side_;
      level.means[square] += color;
      level.largest[square] = std::max(level.largest[square], max_component(color));
    }
  }
  for (vec3& mean : level.means) mean /= static_cast<float>(side_ * side_);
  levels_.push_back(std::move(level));
  while (levels_.back().size != glm::ivec2(1)) add_level();
}

void EmissionMap::add_level() {
  const Level& finer = levels_.back();
  Level level;
  level.size = (finer.size + 1) / 2;
  const size_t count = static_cast<size_t>(level.size.x) * static_cast<size_t>(level.size.y);
  level.means.resize(count);
  level.largest.resize(count);
  for (int y = 0; y < finer.size.y; ++y) {
    for (int x = 0; x < finer.size.x; ++x) {
      const size_t from = static_cast<size_t>(y) * static_cast<size_t>(finer.size.x) + static_cast<size_t>(x);
      const size_t to = static_cast<size_t>(y / 2) * static_cast<size_t>(level.size.x) + static_cast<size_t>(x / 2);
      level.means[to] += 0.25F * finer.means[from];
      level.largest[to] = std::max(level.largest[to], finer.largest[from]);
    }
  }
  levels_.push_back(std::move(level));
}

vec3 EmissionMap::mean_on(const std::array<dvec2, 3>& corners, const Texture& texture) const {
  // The corners and their box in texels. Interpolation reaches one texel further.
  std::array<dvec2, 3> places = corners;
  for (dvec2& place : places) place *= dvec2(size_);
  dvec2 lo = glm::min(glm::min(places[0], places[1]), places[2]) - 1.0;
  dvec2 hi = glm::max(glm::max(places[0], places[1]), places[2]) + 1.0;
  const Level& whole = levels_.back();
  if (!(hi.x - lo.x < size_.x && hi.y - lo.y < size_.y)) return whole.means[0];
  // The period of an image is no multiple of the squares' side, so its squares are those of the plane only in the first
  // period. The triangle is moved there.
  const dvec2 way(way_to_image(lo.x, hi.x, size_.x, texture.wrap_u), way_to_image(lo.y, hi.y, size_.y, texture.wrap_v));
  for (dvec2& place : places) place += way;
  lo += way;
  hi += way;
  size_t number = 0;
  double side = side_;
  glm::ivec2 first;
  glm::ivec2 last;
  for (;; ++number, side *= 2.0) {
    first = glm::ivec2(glm::floor(lo / side));
    last = glm::ivec2(glm::floor(hi / side));
    if (number + 1 == levels_.size()) return whole.means[0];
    if (std::max(last.x - first.x, last.y - first.y) < kMostAcross) break;
  }
  const Level& level = levels_[number];
  dvec3 inside(0.0);
  dvec3 all(0.0);
  int inside_count = 0;
  int count = 0;
  float largest = 0.0F;
  const auto texel_of = [](double place, uint32_t texels, TextureWrap mode) {
    return wrap_square(static_cast<int>(std::floor(place)), static_cast<int>(texels), mode);
  };
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      const dvec2 middle = (dvec2(x, y) + 0.5) * side;
      // A square of the plane may lie over several squares of the image where the image repeats.
      for (int corner = 0; corner < 4; ++corner) {
        // Behind the end of the box a mirrored image may hide a square.
        const dvec2 to(corner % 2, corner / 2);
        const dvec2 at = glm::min((dvec2(x, y) + to) * side - to * 1e-6, hi);
        const int column = texel_of(at.x, size_.x, texture.wrap_u) / static_cast<int>(side);
        const int row = texel_of(at.y, size_.y, texture.wrap_v) / static_cast<int>(side);
        const size_t square =
            static_cast<size_t>(row) * static_cast<size_t>(level.size.x) + static_cast<size_t>(column);
        largest = std::max(largest, level.largest[square]);
        all += dvec3(level.means[square]);
        ++count;
        if (corner > 0 || !is_inside_corners(places, middle)) continue;
        inside += dvec3(level.means[square]);
        ++inside_count;
      }
    }
  }
  if (largest == 0.0F) return vec3(0.0F);
  const vec3 of_box(all / static_cast<double>(count));
  return inside_count == 0 ? of_box
                           : glm::max(vec3(inside / static_cast<double>(inside_count)), kLeastTexelShare * of_box);
}

}  // namespace promin
