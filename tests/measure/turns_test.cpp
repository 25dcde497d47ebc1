// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "measure/samples.h"

namespace promin::measure {
namespace {

TEST(TurnsTest, EachHasAllInAnotherOrder) {
  std::vector<int> ran;
  std::vector<std::function<double()>> contestants;
  for (int i = 0; i < 4; ++i) {
    contestants.emplace_back([&ran, i] {
      ran.push_back(i);
      return static_cast<double>(i);
    });
  }
  const std::vector<std::vector<double>> times = time_in_turns(contestants, 20);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(times[i], std::vector<double>(20, i));
  std::set<std::vector<int>> orders;
  for (size_t first = 4; first < ran.size(); first += 4) {
    const std::vector<int> order(ran.begin() + static_cast<std::ptrdiff_t>(first),
                                 ran.begin() + static_cast<std::ptrdiff_t>(first + 4));
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 4U);
    orders.insert(order);
  }
  EXPECT_GE(orders.size(), 10U);
}

}  // namespace
}  // namespace promin::measure
