// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/angles.h"

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

double angle_of_sine(double wanted) {
  // Newton's method doubles the number of correct digits in each step. The series gives the first two.
  constexpr int kSteps = 5;
  double angle = wanted * (1.0 + wanted * wanted / 6.0);
  for (int step = 0; step < kSteps; ++step) angle -= (sine(angle) - wanted) / cosine(angle);
  return angle;
}

}  // namespace promin
