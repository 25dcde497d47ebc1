// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/sky_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "oracle/samples.h"

namespace promin::oracle {
namespace {

constexpr Real kHalfTurn = std::numbers::pi_v<Real>;

/// Returns the point of the octahedron whose faces are x + y + z = 1 and their mirror images. The map is the octahedron
/// seen from +Y, with the lower faces folded outwards.
Vector octahedron_at(const std::array<Real, 2>& place) {
  const Real a = 2 * place[0] - 1;
  const Real b = 2 * place[1] - 1;
  const Real height = 1 - std::abs(a) - std::abs(b);
  if (height >= 0) return {a, height, b};
  return {(a < 0 ? -1 : 1) * (1 - std::abs(b)), height, (b < 0 ? -1 : 1) * (1 - std::abs(a))};
}

std::array<Real, 2> place_of(const Vector& direction) {
  const Vector point = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  Real a = point.x;
  Real b = point.z;
  if (point.y < 0) {
    a = (point.x < 0 ? -1 : 1) * (1 - std::abs(point.z));
    b = (point.z < 0 ? -1 : 1) * (1 - std::abs(point.x));
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

/// Returns the mean of max(x, 0) over the interval of this half width about the middle.
Real mean_of_positive(Real middle, Real half_width) {
  const Real lo = std::max(middle - half_width, Real(0));
  const Real hi = std::max(middle + half_width, Real(0));
  return (hi * hi - lo * lo) / (4 * half_width);
}

}  // namespace

SkyLight::SkyLight(const Environment& environment)
    : exists_(environment.has_sky() ? environment.intensity > 0 : environment.ambient != vec3(0.0F)),
      ambient_(environment.ambient),
      sky_(pack_sky(environment)) {}

std::array<Real, 4> SkyLight::chances(const Vector& normal, size_t entry, uint32_t level,
                                      const std::array<Real, 2>& corner) const {
  const Real side = std::ldexp(Real(1), -static_cast<int>(level) - 1);
  const Real half_width = std::min(4.25L * side, static_cast<Real>(1.41421366F));
  const Real usual_half_width = std::min(2.5L * side, static_cast<Real>(1.05F));
  std::array<Real, 4> chances{};
  Real sum = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Vector middle =
        octahedron_at({corner[0] + side * ((quarter % 2) + 0.5L), corner[1] + side * ((quarter / 2) + 0.5L)});
    const Real cosine = glm::dot(normal, glm::normalize(middle));
    Real& chance = chances[static_cast<size_t>(quarter)];
    chance = std::bit_cast<float>(sky_.texels[entry][quarter]) *
             std::max(mean_of_positive(cosine, usual_half_width), mean_of_positive(cosine, half_width) / 16);
    sum += chance;
  }
  if (sum > 0) {
    for (Real& chance : chances) chance /= sum;
  }
  return chances;
}

SkyLight::Choice SkyLight::choose(const Vector& normal, const std::array<Real, 2>& u) const {
  if (sky_.side == 0) {
    const auto [x, y] = place_on_disc(u);
    const Vector helper = std::abs(normal.x) < 0.57L ? Vector(1, 0, 0) : Vector(0, 1, 0);
    const Vector across = glm::normalize(glm::cross(normal, helper));
    const Real cosine = std::sqrt(std::max(1 - x * x - y * y, Real(0)));
    return {x * across + y * glm::cross(normal, across) + cosine * normal, cosine / kHalfTurn};
  }
  std::array<Real, 2> corner{};
  std::array<Real, 2> rest = u;
  size_t entry = 0;
  for (uint32_t level = 0; level < sky_.pyramid_levels; ++level) {
    const std::array<Real, 4> chance = chances(normal, sky_.first_of_pyramid + entry, level, corner);
    const Real left = chance[0] + chance[2];
    const bool is_right = rest[0] >= left && chance[1] + chance[3] > 0;
    const Real column = is_right ? 1 - left : left;
    rest[0] = is_right ? (rest[0] - left) / column : rest[0] / column;
    const Real upper = is_right ? chance[1] : chance[0];
    const Real lower = is_right ? chance[3] : chance[2];
    const bool is_lower = rest[1] * (upper + lower) >= upper && lower > 0;
    rest[1] = is_lower ? (rest[1] * (upper + lower) - upper) / lower : rest[1] * (upper + lower) / upper;
    const Real side = std::ldexp(Real(1), -static_cast<int>(level) - 1);
    corner[0] += is_right ? side : 0;
    corner[1] += is_lower ? side : 0;
    entry = 4 * entry + 1 + (is_right ? 1 : 0) + (is_lower ? 2 : 0);
  }
  const Real side = std::ldexp(Real(1), -static_cast<int>(sky_.pyramid_levels));
  const Vector direction = glm::normalize(octahedron_at({corner[0] + side * rest[0], corner[1] + side * rest[1]}));
  return {direction, density(normal, direction)};
}

Real SkyLight::density(const Vector& normal, const Vector& direction) const {
  if (sky_.side == 0) return std::max(glm::dot(normal, direction), Real(0)) / kHalfTurn;
  const std::array<Real, 2> place = place_of(direction);
  std::array<Real, 2> corner{};
  Real chance = 1;
  size_t entry = 0;
  for (uint32_t level = 0; level < sky_.pyramid_levels; ++level) {
    const std::array<Real, 4> of_quarters = chances(normal, sky_.first_of_pyramid + entry, level, corner);
    const Real side = std::ldexp(Real(1), -static_cast<int>(level) - 1);
    const size_t quarter = (place[0] >= corner[0] + side ? 1 : 0) + (place[1] >= corner[1] + side ? 2 : 0);
    chance *= of_quarters[quarter];
    corner[0] += quarter % 2 == 1 ? side : 0;
    corner[1] += quarter / 2 == 1 ? side : 0;
    entry = 4 * entry + 1 + quarter;
  }
  // A face of the octahedron has the area sqrt(3) for the area 1 seen from +Y, lies at the distance 1 / sqrt(3), and is
  // seen at the cosine (1 / sqrt(3)) / |p|.
  const Real distance = glm::length(octahedron_at(place));
  const Real angle_by_area = 4 / (distance * distance * distance);
  return chance * std::ldexp(Real(1), 2 * static_cast<int>(sky_.pyramid_levels)) / angle_by_area;
}

Vector SkyLight::texel(int64_t column, int64_t row) const {
  // Columns and rows count from the border, so an entry's two texels are those of its column and of the next one.
  const int64_t entries = int64_t{sky_.side} + 1;
  const bool is_second = column == entries;
  const glm::uvec4& entry = sky_.texels[static_cast<size_t>(row * entries + column - (is_second ? 1 : 0))];
  const std::array<uint32_t, 6> halves = {entry.x & 0xFFFF, entry.x >> 16,    entry.y & 0xFFFF,
                                          entry.y >> 16,    entry.z & 0xFFFF, entry.z >> 16};
  const size_t first = is_second ? 3 : 0;
  Vector value(0);
  for (int i = 0; i < 3; ++i) {
    value[i] = glm::unpackHalf1x16(static_cast<uint16_t>(halves[first + static_cast<size_t>(i)]));
  }
  return value;
}

Vector SkyLight::radiance(const Vector& direction) const {
  if (sky_.side == 0) return ambient_;
  const std::array<Real, 2> place = place_of(direction);
  const Real x = place[0] * sky_.side + 0.5L;
  const Real y = place[1] * sky_.side + 0.5L;
  const auto column = static_cast<int64_t>(std::floor(x));
  const auto row = static_cast<int64_t>(std::floor(y));
  const Vector upper = glm::mix(texel(column, row), texel(column + 1, row), x - static_cast<Real>(column));
  const Vector lower = glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - static_cast<Real>(column));
  return glm::mix(upper, lower, y - static_cast<Real>(row));
}

}  // namespace promin::oracle
