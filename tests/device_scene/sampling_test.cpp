// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/sampling.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace promin {
namespace {

/// Row of the i-th sample, as shaders/camera.glsl has it.
uint32_t row_of(uint32_t index, uint32_t count, uint32_t generator) {
  return static_cast<uint32_t>((static_cast<uint64_t>(generator) * (index + 1)) % (count + 1)) - 1;
}

class SamplingTest : public testing::TestWithParam<uint32_t> {};

TEST_P(SamplingTest, EachRowHasOneSampleAndTheCentreIsTheMean) {
  const uint32_t count = GetParam();
  const uint32_t generator = lattice_generator(count);
  std::vector<int> hits(count, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t row = row_of(i, count, generator);
    ASSERT_LT(row, count);
    ++hits[row];
    EXPECT_EQ(row + row_of(count - 1 - i, count, generator), count - 1) << "not symmetric about the centre";
  }
  for (const int hit : hits) EXPECT_EQ(hit, 1);
}

INSTANTIATE_TEST_SUITE_P(Counts, SamplingTest,
                         testing::Values(1U, 2U, 3U, 4U, 5U, 8U, 16U, 64U, 100U, 128U, 129U, 1000U, 65535U));

TEST(SampleLatticeTest, FourSamplesAreTheRotatedGrid) {
  const uint32_t generator = lattice_generator(4);
  std::vector<uint32_t> rows;
  for (uint32_t i = 0; i < 4; ++i) rows.push_back(row_of(i, 4, generator));
  EXPECT_TRUE(rows == (std::vector<uint32_t>{1, 3, 0, 2}) || rows == (std::vector<uint32_t>{2, 0, 3, 1}));
}

}  // namespace
}  // namespace promin
