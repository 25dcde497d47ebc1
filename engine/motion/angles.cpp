// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace promin {
namespace {

/// The last factor of the series of sine and cosine. The next term is below 1e-17 for angles up to pi/2.
constexpr int kLastFactor = 22;

double cosine(double angle) {
  const double square = angle * angle;
  double sum = 1.0;
  for (int n = kLastFactor; n >= 2; n -= 2) sum = 1.0 - square / (n * (n - 1)) * sum;
  return sum;
}

}  // namespace

double sine(double angle) {
  const double square = angle * angle;
  double sum = 1.0;
  for (int n = kLastFactor + 1; n >= 3; n -= 2) sum = 1.0 - square / (n * (n - 1)) * sum;
  return angle * sum;
}

double sine_of_any(double angle) {
  const double rest = std::remainder(angle, 2.0 * std::numbers::pi);
  const double size = std::abs(rest);
  constexpr double kRight = 0.5 * std::numbers::pi;
  const double value = size <= kRight ? sine(size) : sine(std::max(std::numbers::pi - size, 0.0));
  return rest < 0.0 ? -value : value;
}

double angle_of_sine(double wanted) {
  // Newton's method doubles the number of correct digits in each step. The series gives the first two.
  constexpr int kSteps = 5;
  double angle = wanted * (1.0 + wanted * wanted / 6.0);
  for (int step = 0; step < kSteps; ++step) angle -= (sine(angle) - wanted) / cosine(angle);
  return angle;
}

}  // namespace promin
