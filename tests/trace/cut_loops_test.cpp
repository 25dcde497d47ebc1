// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/cut_loops.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace promin {
namespace {

std::string refusal_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(CutLoopsTest, PicturesAreTracedAgainWithOnePathALaneAndThenRefused) {
  CutLoops cut_loops = CutLoops::of_pictures();
  const TileOptions wanted{.most_paths_a_lane = 16};
  EXPECT_FALSE(cut_loops.must_trace_again(false, true));
  EXPECT_EQ(cut_loops.limit(wanted).most_paths_a_lane, 16U);
  EXPECT_TRUE(cut_loops.must_trace_again(true, true));
  EXPECT_FALSE(cut_loops.takes_many_paths());
  EXPECT_EQ(cut_loops.limit(wanted).most_paths_a_lane, 1U);
  // What was under way with many paths meanwhile is traced again as well.
  EXPECT_TRUE(cut_loops.must_trace_again(true, true));
  EXPECT_FALSE(cut_loops.must_trace_again(false, false));
  EXPECT_THAT(refusal_of([&] { cut_loops.must_trace_again(true, false); }), testing::HasSubstr("a smaller depth or"));
}

TEST(CutLoopsTest, PixelsAndRaysAreRefusedAtOnce) {
  CutLoops pixels = CutLoops::of_pixels();
  const CutLoops rays = CutLoops::of_rays();
  EXPECT_FALSE(pixels.takes_many_paths());
  EXPECT_THAT(refusal_of([&] { pixels.must_trace_again(true, pixels.takes_many_paths()); }),
              testing::HasSubstr("smaller depth"));
  EXPECT_THAT(refusal_of([&] { pixels.check(true); }), testing::HasSubstr("65535"));
  EXPECT_THAT(refusal_of([&] { rays.check(true); }), testing::HasSubstr("another device"));
  rays.check(false);
  pixels.check(false);
}

}  // namespace
}  // namespace promin
