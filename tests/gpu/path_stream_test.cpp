// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/path_stream.h"

#include <gtest/gtest.h>

namespace promin {
namespace {

TEST(StreamShapeTest, ItsMemoryIsBoundedWhateverTheLights) {
  for (const uint32_t lights : {0U, 1U, 3U, 16U, 17U, 1000U}) {
    SCOPED_TRACE(lights);
    const StreamShape shape = StreamShape::of(lights, layout::FEATURE_SHADOWS, 1U << 18, 5);
    EXPECT_LE(shape.path_bytes() * shape.most_paths, StreamShape::kMostBytes);
    EXPECT_EQ(shape.most_paths % StreamShape::kLanes, 0U);
    EXPECT_GE(shape.most_paths, 1U << 16);
    EXPECT_LE(shape.most_paths, 1U << 18);
    // Each source is handled in exactly one turn.
    EXPECT_GE(shape.sources * shape.turns_of_bounce, lights);
    EXPECT_LT(shape.sources * (shape.turns_of_bounce - 1), std::max(lights, 1U));
  }
}

TEST(StreamShapeTest, WithoutShadowsNoSourceTakesRoom) {
  const StreamShape shape = StreamShape::of(1000, FeatureMask(), 64, 5);
  EXPECT_EQ(shape.sources, 0U);
  EXPECT_EQ(shape.turns_of_bounce, 1U);
  EXPECT_EQ(shape.path_bytes(), 124U);
  EXPECT_EQ(shape.most_paths, 64U);
}

// A path's records fill a cache line, however many sources there are. With glass its shadow rays have a kernel of their
// own.
TEST(StreamShapeTest, ScatteredPathsHaveNoRecordsOfSources) {
  const FeatureMask features = FeatureMask(layout::FEATURE_SHADOWS) | layout::FEATURE_SCATTERING;
  const StreamShape shape = StreamShape::of(3, features, 64, 5);
  EXPECT_EQ(shape.sources, 0U);
  EXPECT_EQ(shape.records_of_path(), 4U);
  EXPECT_EQ(StreamShape::of(3, features | layout::FEATURE_TEXTURES, 64, 5).records_of_path(), 5U);
  EXPECT_EQ(StreamShape::of(3, features | layout::FEATURE_GLASS, 64, 5).sources, 3U);
}

}  // namespace
}  // namespace promin
