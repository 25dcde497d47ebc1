// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/srgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "support/thorough.h"

namespace promin {
namespace {

uint8_t byte_of_curve(float light) {
  const double code = linear_to_srgb(static_cast<double>(std::clamp(light, 0.0F, 1.0F)));
  return static_cast<uint8_t>(std::lround(255.0 * code));
}

/// All floats from 0 to 1 take half a minute, so a usual test tries only some.
TEST(SrgbBytes, AreThoseOfTheCurve) {
  const SrgbBytes bytes;
  const uint32_t stride = test::is_thorough() ? 1 : 997;
  for (uint32_t bits = 0; bits <= std::bit_cast<uint32_t>(1.0F); bits += stride) {
    const auto light = std::bit_cast<float>(bits);
    if (bytes(light) != byte_of_curve(light)) FAIL() << light;
  }
}

TEST(SrgbBytes, OfFloatsAtTheStepsAreThoseOfTheCurve) {
  const SrgbBytes bytes;
  for (int byte = 1; byte < 256; ++byte) {
    const auto step = static_cast<float>(srgb_to_linear((byte - 0.5) / 255.0));
    const auto middle = std::bit_cast<uint32_t>(step);
    for (uint32_t bits = middle - 64; bits <= middle + 64; ++bits) {
      const auto light = std::bit_cast<float>(bits);
      ASSERT_EQ(bytes(light), byte_of_curve(light)) << light;
    }
  }
}

TEST(SrgbBytes, ClampLight) {
  const SrgbBytes bytes;
  EXPECT_EQ(bytes(-1.0F), 0);
  EXPECT_EQ(bytes(0.0F), 0);
  EXPECT_EQ(bytes(1.0F), 255);
  EXPECT_EQ(bytes(2.0F), 255);
  EXPECT_EQ(bytes(std::numeric_limits<float>::infinity()), 255);
}

}  // namespace
}  // namespace promin
