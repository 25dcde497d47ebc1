// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace promin::measure {

/// Of some measurements; between two of them linearly.
struct Quartiles {
  double lower = 0.0;
  double median = 0.0;
  double upper = 0.0;
};

/// Of one value or more.
inline Quartiles quartiles_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {
    const double place = fraction * static_cast<double>(values.size() - 1);
    const auto below = static_cast<size_t>(place);
    const size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], place - static_cast<double>(below));
  };
  return {at(0.25), at(0.5), at(0.75)};
}

/// The median and an interval that holds the median of all that might be measured, whatever their distribution.
struct MedianInterval {
  double lower = 0.0;
  double median = 0.0;
  double upper = 0.0;
  /// How often such an interval holds it, 0...1.
  double confidence = 0.0;
};

/// Of one value or more: between the k-th least and the k-th largest value, which miss the median as often as fewer
/// than k of n throws of a coin are heads: 1 - 2 sum_{i<k} C(n, i) / 2^n. The narrowest of at least 95 %; of fewer than
/// 6 values none has that, and it is from the least to the largest (Conover, Practical Nonparametric Statistics, 3.2).
inline MedianInterval median_interval_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t count = values.size();
  // Probabilities of i heads and of at most i.
  double exactly = std::exp2(-static_cast<double>(count));
  double tail = exactly;
  size_t k = 1;
  double confidence = 1.0 - 2.0 * tail;
  for (size_t i = 1; 2 * i < count; ++i) {
    exactly *= static_cast<double>(count - i + 1) / static_cast<double>(i);
    tail += exactly;
    if (1.0 - 2.0 * tail < 0.95) break;
    k = i + 1;
    confidence = 1.0 - 2.0 * tail;
  }
  return {values[k - 1], quartiles_of(values).median, values[count - k], std::max(0.0, confidence)};
}

/// The protocol of everything that is timed: each contestant once as a warm-up, whose time is thrown away, then all of
/// them in turns, so that what else the machine does falls on all alike; each turn in another order, as what ran just
/// before has caches full of its own: with one order for all, a depth of 16 seemed 4 % faster than 5. A contestant
/// returns its milliseconds; the result has those of each contestant, `runs` of them.
inline std::vector<std::vector<double>> time_in_turns(std::span<const std::function<double()>> contestants,
                                                      uint32_t runs) {
  for (const std::function<double()>& contestant : contestants) contestant();
  std::vector<std::vector<double>> times_ms(contestants.size());
  std::vector<size_t> order(contestants.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::mt19937 generator(1);
  for (uint32_t run = 0; run < runs; ++run) {
    std::shuffle(order.begin(), order.end(), generator);
    for (const size_t i : order) times_ms[i].push_back(contestants[i]());
  }
  return times_ms;
}

/// Of each turn, one contestant's time over another's: what falls on both alike is no longer in it.
inline std::vector<double> ratios_of(std::span<const double> times, std::span<const double> others) {
  std::vector<double> ratios;
  for (size_t i = 0; i < times.size(); ++i) ratios.push_back(times[i] / others[i]);
  return ratios;
}

}  // namespace promin::measure
