// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace promin::report {

/// y = c x^exponent by least squares of the logarithms, with the 95 % interval of the exponent by Student's t. It takes
/// the points' distances from the line for noise; a curve that is no power of x has a wide interval, too.
struct PowerFit {
  double exponent = 0.0;
  double lower = 0.0;
  double upper = 0.0;
};

/// Of three points or more, all positive.
PowerFit fit_power(std::span<const double> xs, std::span<const double> ys);

}  // namespace promin::report
