// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/sampler.h"

#include <algorithm>
#include <cmath>

#include "motion/angles.h"

namespace promin {
namespace {

/// The keys around a time.
struct Interval {
  size_t first = 0;
  /// The same as `first` before the first key and after the last one.
  size_t second = 0;
  /// The place between the keys, 0 to 1.
  double fraction = 0.0;
  double length_s = 0.0;
};

Interval find_interval(std::span<const double> times, double time_s) {
  if (!(time_s > times.front())) return {};
  const size_t last = times.size() - 1;
  if (time_s >= times.back()) return {last, last};
  const auto after = std::upper_bound(times.begin(), times.end(), time_s);
  const auto second = static_cast<size_t>(after - times.begin());
  const double begin = times[second - 1];
  const double length_s = times[second] - begin;
  return {second - 1, second, (time_s - begin) / length_s, length_s};
}

/// Returns the numbers of one key: its value, or one of the tangents beside it.
std::span<const double> key_of(const AnimationSampler& sampler, size_t key, size_t part, size_t count) {
  const size_t parts = numbers_per_component(sampler.interpolation);
  return std::span(sampler.values).subspan((key * parts + part) * count, count);
}

/// Computes a point of a cubic Hermite spline.
void sample_spline(const AnimationSampler& sampler, const Interval& at, std::span<double> value) {
  constexpr size_t kInTangent = 0;
  constexpr size_t kValue = 1;
  constexpr size_t kOutTangent = 2;
  const auto number = [&](size_t key, size_t part) { return key_of(sampler, key, part, value.size()); };
  const double t = at.fraction;
  const double t2 = t * t;
  const double t3 = t2 * t;
  for (size_t i = 0; i < value.size(); ++i) {
    const double from = number(at.first, kValue)[i];
    const double to = number(at.second, kValue)[i];
    const double leaving = at.length_s * number(at.first, kOutTangent)[i];
    const double arriving = at.length_s * number(at.second, kInTangent)[i];
    value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * from + (t3 - 2.0 * t2 + t) * leaving + (3.0 * t2 - 2.0 * t3) * to +
               (t3 - t2) * arriving;
  }
}

dvec4 quaternion_in(std::span<const double> numbers) {
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void put(const dvec4& quaternion, std::span<double> value) {
  for (int i = 0; i < 4; ++i) value[static_cast<size_t>(i)] = quaternion[i];
}

}  // namespace

size_t numbers_per_component(Interpolation interpolation) {
  return interpolation == Interpolation::kCubicSpline ? 3 : 1;
}

dvec4 to_unit_quaternion(const dvec4& quaternion) {
  const double length = std::sqrt(glm::dot(quaternion, quaternion));
  if (length > 0.0 && std::isfinite(length)) return quaternion / length;
  return {0.0, 0.0, 0.0, 1.0};
}

dvec4 slerp(const dvec4& from, const dvec4& to, double fraction) {
  // q and -q are the same rotation. The nearer one is at the shorter arc.
  const dvec4 nearer = glm::dot(from, to) < 0.0 ? -to : to;
  const dvec4 chord = nearer - from;
  // Two unit quaternions with the half angle h differ by 2 sin h. Unlike the arccosine of their product, this is
  // accurate for small angles.
  const double half_angle = angle_of_sine(std::min(0.5 * std::sqrt(glm::dot(chord, chord)), std::sqrt(0.5)));
  const double angle = 2.0 * half_angle;
  constexpr double kStraight = 1e-9;
  if (angle < kStraight) return to_unit_quaternion(from + fraction * chord);
  const dvec4 between = sine((1.0 - fraction) * angle) * from + sine(fraction * angle) * nearer;
  return to_unit_quaternion(between);
}

void sample(const AnimationSampler& sampler, double time_s, bool is_rotation, std::span<double> value) {
  const Interval at = find_interval(sampler.times, time_s);
  const bool is_spline = sampler.interpolation == Interpolation::kCubicSpline;
  const bool is_key = at.first == at.second || sampler.interpolation == Interpolation::kStep;
  const std::span<const double> first = key_of(sampler, at.first, is_spline ? 1 : 0, value.size());
  if (is_key) {
    std::ranges::copy(first, value.begin());
  } else if (is_spline) {
    sample_spline(sampler, at, value);
  } else {
    const std::span<const double> second = key_of(sampler, at.second, 0, value.size());
    if (is_rotation) {
      const dvec4 from = to_unit_quaternion(quaternion_in(first));
      return put(slerp(from, to_unit_quaternion(quaternion_in(second)), at.fraction), value);
    }
    for (size_t i = 0; i < value.size(); ++i) value[i] = (1.0 - at.fraction) * first[i] + at.fraction * second[i];
  }
  if (is_rotation) put(to_unit_quaternion(quaternion_in(value)), value);
}

}  // namespace promin
