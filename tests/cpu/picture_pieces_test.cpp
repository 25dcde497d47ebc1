// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/picture_pieces.h"

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

PicturePieces cut(const PieceOptions& options) {
  const View view = make_view();
  return {layout::Frame{}, layout::Dispatch{}, view, {uvec2(0), view.size}, options};
}

TEST(PicturePieces, CoverEverySampleOnceAndInOrder) {
  for (const double units : {1.0, 100.0, 1050.0, 1e9}) {
    PicturePieces pieces = cut({.wanted_groups = 16});
    std::vector<uint32_t> samples_taken(32 * 17);
    while (!pieces.is_done()) {
      const PicturePiece piece = pieces.next(units);
      const layout::Dispatch& dispatch = piece.dispatch;
      for (uint32_t block = dispatch.range.x; block < dispatch.share.x; ++block) {
        ASSERT_EQ(samples_taken[block], dispatch.range.y) << "block " << block;
        samples_taken[block] += dispatch.range.z;
      }
    }
    for (const uint32_t count : samples_taken) ASSERT_EQ(count, 50U) << units << " units";
    EXPECT_EQ(pieces.fraction_done(), 1.0);
  }
}

// llvmpipe ends loops that turn too often, without a word.
TEST(PicturePieces, NoLaneTakesLong) {
  for (const double units : {1.0, 1050.0, 1e9}) {
    PicturePieces pieces = cut({.wanted_groups = 16});
    while (!pieces.is_done()) {
      const PicturePiece piece = pieces.next(units);
      const uint32_t blocks = piece.dispatch.share.x - piece.dispatch.range.x;
      const uint32_t blocks_a_group = (blocks + piece.group_count - 1) / piece.group_count;
      ASSERT_LE(blocks_a_group * piece.dispatch.range.z, 16U) << units << " units";
    }
  }
}

}  // namespace
}  // namespace promin
