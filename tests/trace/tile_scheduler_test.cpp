// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/tile_scheduler.h"

#include <gtest/gtest.h>

#include <vector>

namespace promin {
namespace {

View make_view() {
  View view;
  view.size = uvec2(250, 130);  // 32 x 17 blocks
  view.samples_per_pixel = 50;
  return view;
}

TileScheduler cut(const TileOptions& options) {
  const View view = make_view();
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

TEST(TileScheduler, GroupsOfEachStageSufficeForAllPixels) {
  for (const double units : {1.0, 100.0, 1050.0, 1e9}) {
    TileScheduler pieces = cut({.packet_size = 4, .most_group_rows = 16, .wanted_groups = 16, .most_paths_a_lane = 16});
    while (!pieces.is_done()) {
      const TileSample piece = pieces.next(units);
      const uint32_t blocks = piece.dispatch.range.y - piece.dispatch.range.x;
      const uvec2 groups = piece.group_counts[0];
      ASSERT_LE(groups.y, 16U);
      ASSERT_GE(4 * groups.x * groups.y, blocks) << units << " units";
      ASSERT_LT(4 * (groups.x - 1) * groups.y, blocks) << units << " units";
      ASSERT_GE(piece.group_counts[1].x * piece.dispatch.queue.w, blocks) << units << " units";
    }
  }
}

// llvmpipe ends loops that turn too often, without a word; and threads want groups to share.
TEST(TileScheduler, ALaneTakesSeveralPathsWhereThereAreGroupsEnough) {
  const TileOptions options{.wanted_groups = 16, .most_paths_a_lane = 16};
  EXPECT_EQ(cut(options).next(64.0).dispatch.queue.w, 4U);
  EXPECT_EQ(cut(options).next(1e9).dispatch.queue.w, 16U);
  EXPECT_EQ(cut({.wanted_groups = 1000, .most_paths_a_lane = 16}).next(64.0).dispatch.queue.w, 1U);
}

TEST(TileScheduler, TheQueueOfPathsIsBounded) {
  View view = make_view();
  view.size = uvec2(4096);
  TileScheduler pieces(SceneConstants{}, view, {uvec2(0), view.size});
  const layout::Dispatch dispatch = pieces.next(1e9).dispatch;
  EXPECT_EQ(dispatch.range.y - dispatch.range.x, TileScheduler::kMaxBlocks);
}

}  // namespace
}  // namespace promin
