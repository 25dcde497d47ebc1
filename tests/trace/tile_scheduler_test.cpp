// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/tile_scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace promin {
namespace {

View make_tiled_view() {
  View view;
  view.size = uvec2(250, 130);  // 32 x 17 blocks
  view.samples_per_pixel = 50;
  return view;
}

TileScheduler cut(const TileOptions& options) {
  const View view = make_tiled_view();
  return {SceneConstants{}, view, {uvec2(0), view.size}, options};
}

TEST(TileScheduler, CoverEverySampleOnceAndInOrder) {
  for (const double units : {1.0, 100.0, 1050.0, 1e9}) {
    TileScheduler pieces = cut({});
    std::vector<uint32_t> samples_taken(32 * 17);
    while (!pieces.is_done()) {
      const layout::Dispatch& dispatch = pieces.next(units).dispatch;
      for (uint32_t block = dispatch.range.x; block < dispatch.range.y; ++block) {
        ASSERT_EQ(samples_taken[block], dispatch.range.z) << "block " << block;
        ++samples_taken[block];
      }
    }
    for (const uint32_t count : samples_taken) ASSERT_EQ(count, 50U) << units << " units";
    EXPECT_EQ(pieces.fraction_done(), 1.0);
  }
}

// Each ray of a sample takes one step of the stream, for any order in which glass splits rays.
TEST(TileScheduler, StepsSufficeForTheLargestTree) {
  // All light leaves the first surface as a mirror ray and as one ray for each color; each of these is split into a
  // mirror ray and one more ray.
  const auto rays = [](auto& self, uint32_t depth, uint32_t colors) -> uint32_t {
    if (depth == 0) return 0;
    return 1 + self(self, depth - 1, colors) + colors * (1 + self(self, depth - 1, 1));
  };
  for (const uint32_t colors : {1U, 3U}) {
    for (uint32_t depth = 0; depth < 9; ++depth) {
      EXPECT_EQ(most_steps(depth, colors, 0), std::min(rays(rays, depth, colors), layout::MOST_TREE_RAYS));
    }
    EXPECT_EQ(most_steps(100, colors, 7), 107U) << "scenes without glass have no limit";
  }
  EXPECT_EQ(most_steps(5, 0, 7), 12U);
}

TEST(TileScheduler, GroupsSufficeForAllPixels) {
  for (const double units : {1.0, 100.0, 1050.0, 1e9}) {
    TileScheduler pieces = cut({.packet_size = 4, .most_group_rows = 16});
    while (!pieces.is_done()) {
      const TileSample piece = pieces.next(units);
      const uint32_t blocks = piece.dispatch.range.y - piece.dispatch.range.x;
      const uvec2 groups = piece.group_count;
      ASSERT_LE(groups.y, 16U);
      ASSERT_GE(4 * groups.x * groups.y, blocks) << units << " units";
      ASSERT_LT(4 * (groups.x - 1) * groups.y, blocks) << units << " units";
    }
  }
}

// The stream has space for this number of paths.
TEST(TileScheduler, PiecesAreNoLargerThanAsked) {
  for (const double units : {1.0, 1e9}) {
    for (const uint32_t most_blocks : {1U, 100U}) {
      TileScheduler pieces = cut({.most_blocks = most_blocks});
      while (!pieces.is_done()) {
        const layout::Dispatch dispatch = pieces.next(units).dispatch;
        ASSERT_LE(dispatch.range.y - dispatch.range.x, most_blocks) << units << " units";
      }
    }
  }
  View view = make_tiled_view();
  view.size = uvec2(4096);
  TileScheduler pieces(SceneConstants{}, view, {uvec2(0), view.size});
  const layout::Dispatch dispatch = pieces.next(1e9).dispatch;
  EXPECT_EQ(dispatch.range.y - dispatch.range.x, TileOptions::kMaxBlocks);
}

}  // namespace
}  // namespace promin
