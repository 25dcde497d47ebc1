// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace promin {
namespace {

TEST(Parallel, EveryIndexIsCalledOnce) {
  for (const unsigned thread_count : {0U, 1U, 2U, 7U}) {
    for (const size_t count : {0U, 1U, 2U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      for_each_index(count, thread_count, [&](size_t i) { calls[i] += 1; });
      for (const std::atomic<int>& number : calls) EXPECT_EQ(number, 1);
    }
  }
}

TEST(Parallel, OneThreadKeepsTheOrder) {
  std::vector<size_t> order;
  for_each_index(4, 1, [&](size_t i) { order.push_back(i); });
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3));
}

TEST(Parallel, AnExceptionStopsTheRestAndArrives) {
  for (const unsigned thread_count : {1U, 4U}) {
    std::atomic<int> calls = 0;
    const auto fail = [&](size_t) {
      calls += 1;
      throw std::runtime_error("of a task");
    };
    EXPECT_THROW(for_each_index(1000, thread_count, fail), std::runtime_error);
    EXPECT_LE(calls, static_cast<int>(thread_count));
  }
}

}  // namespace
}  // namespace promin
