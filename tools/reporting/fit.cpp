// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/fit.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace promin::report {
namespace {

/// 97.5 % of Student's t for 1, 2, ... degrees of freedom; beyond the last nearly the normal distribution's.
constexpr std::array kStudent = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};

}  // namespace

PowerFit fit_power(std::span<const double> xs, std::span<const double> ys) {
  assert(xs.size() == ys.size() && xs.size() >= 3);
  const auto count = static_cast<double>(xs.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (size_t i = 0; i < xs.size(); ++i) {
    mean_x += std::log(xs[i]) / count;
    mean_y += std::log(ys[i]) / count;
  }
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (size_t i = 0; i < xs.size(); ++i) {
    const double dx = std::log(xs[i]) - mean_x;
    sum_xx += dx * dx;
    sum_xy += dx * (std::log(ys[i]) - mean_y);
  }
  PowerFit fit;
  fit.exponent = sum_xy / sum_xx;
  double residual2 = 0.0;
  for (size_t i = 0; i < xs.size(); ++i) {
    const double residual = std::log(ys[i]) - mean_y - fit.exponent * (std::log(xs[i]) - mean_x);
    residual2 += residual * residual;
  }
  const size_t freedom = xs.size() - 2;
  const double error = std::sqrt(residual2 / static_cast<double>(freedom) / sum_xx);
  const double student = kStudent[std::min(freedom, kStudent.size()) - 1];
  fit.lower = fit.exponent - student * error;
  fit.upper = fit.exponent + student * error;
  return fit;
}

}  // namespace promin::report
