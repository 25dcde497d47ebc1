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

TEST(Parallel, PartsComeInOrder) {
  for (const unsigned thread_count : {1U, 4U}) {
    const auto parts = make_parts(10, 4, thread_count, std::vector<size_t>{7},
                                  [](size_t begin, size_t end, std::vector<size_t>& part) {
                                    part.push_back(begin);
                                    part.push_back(end);
                                  });
    EXPECT_THAT(parts, testing::ElementsAre(testing::ElementsAre(7, 0, 4), testing::ElementsAre(7, 4, 8),
                                            testing::ElementsAre(7, 8, 10)));
  }
}

TEST(Parallel, FoundIndicesAreInOrder) {
  EXPECT_THAT(find_indices(0, [](uint32_t) { return true; }), testing::IsEmpty());
  const auto found = find_indices(100'000, [](uint32_t i) { return i % 30'000 == 1; });
  EXPECT_THAT(found, testing::ElementsAre(1, 30'001, 60'001, 90'001));
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
