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

/// Quartiles of some measurements, interpolated linearly between two of them. Programs print them in tables;
/// tools/lab/stats.py computes the statistics of documents and pages.
struct Quartiles {
  double lower = 0.0;
  double median = 0.0;
  double upper = 0.0;
};

/// Returns the quartiles of one value or more.
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

/// Times contestants, in the same way for every measurement. Each contestant first runs once as a warm-up, whose time
/// is dropped. Then all run in turns, so that other work of the machine affects all equally. Each turn has another
/// order, because the caches are full of the last contestant's data: with one order for all, a depth of 16 seemed 4 %
/// faster than 5. A contestant returns its milliseconds. The function returns `runs` times for each contestant.
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

/// Returns for each turn the ratio of one contestant's time to another's. Influences that slow both equally cancel out.
inline std::vector<double> ratios_of(std::span<const double> times, std::span<const double> others) {
  std::vector<double> ratios;
  for (size_t i = 0; i < times.size(); ++i) ratios.push_back(times[i] / others[i]);
  return ratios;
}

}  // namespace promin::measure
