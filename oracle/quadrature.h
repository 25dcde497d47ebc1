// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "oracle/oracle.h"

namespace promin::oracle {

/// A position in an interval, and the weight of the function's value there.
struct QuadratureNode {
  Real place = 0;
  Real weight = 0;
};

/// Returns the nodes of Gauss and Legendre on [0, 1], which are exact up to the degree 2 kOrder - 1. The positions are
/// the roots of Legendre's polynomial, found by Newton's method (Abramowitz and Stegun, 25.4.29).
template <int kOrder>
std::array<QuadratureNode, kOrder> make_gauss_nodes() {
  std::array<QuadratureNode, kOrder> nodes;
  for (int i = 0; i < kOrder; ++i) {
    Real x = std::cos(std::numbers::pi_v<Real> * (i + 0.75L) / (kOrder + 0.5L));
    Real slope = 1;
    for (int step = 0; step < 50; ++step) {
      Real last = 1;
      Real value = x;
      for (int n = 2; n <= kOrder; ++n) {
        const Real next = ((2 * n - 1) * x * value - (n - 1) * last) / n;
        last = value;
        value = next;
      }
      slope = kOrder * (x * value - last) / (x * x - 1);
      x -= value / slope;
    }
    nodes[static_cast<size_t>(i)] = {(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)};
  }
  return nodes;
}

/// Returns the nodes of Gauss and Legendre on [a, b].
template <int kOrder>
std::array<QuadratureNode, kOrder> gauss_nodes(Real a, Real b) {
  static const std::array<QuadratureNode, kOrder> kNodes = make_gauss_nodes<kOrder>();
  std::array<QuadratureNode, kOrder> nodes = kNodes;
  for (QuadratureNode& node : nodes) node = {a + node.place * (b - a), node.weight * (b - a)};
  return nodes;
}

}  // namespace promin::oracle
