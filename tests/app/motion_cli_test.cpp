// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests render the AOV of motion.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "bar_film.h"

namespace promin {
namespace {

class MotionCliTest : public BarFilmTest {
 protected:
  /// Renders a film of the bar, or a crop of it, with the AOV. Returns the movements of its pixels.
  std::vector<vec2> movements(const OptionValues& more, const std::string& output = "a.exr") const {
    OptionValues words = {"--aov", "motion"};
    words.insert(words.end(), more.begin(), more.end());
    film(words, output);
    return read_movements(output);
  }

  std::vector<vec2> read_movements(const std::string& file) const {
    std::vector<vec2> all;
    for (int axis = 0; axis < 2; ++axis) {
      const std::vector<uint32_t> bits = read_channel(file, axis == 0 ? "motion.X" : "motion.Y");
      all.resize(bits.size());
      for (size_t i = 0; i < all.size(); ++i) all[i][axis] = std::bit_cast<float>(bits[i]);
    }
    return all;
  }
};

TEST_F(MotionCliTest, OfABarIsItsSpeed) {
  // At 1 / 4 s, the bar covers x = 1 to x = 3, the columns 20 to 27. Until the next frame it moves by 2 units of 4
  // pixels.
  const std::vector<vec2> whole = movements({"--fps", "4", "--frames", "1"});
  ASSERT_EQ(whole.size(), 64U * 4U);
  for (uint32_t x = 0; x < 64; ++x) {
    const bool is_bar = x >= 20 && x < 28;
    EXPECT_NEAR(whole[64 + x].x, is_bar ? 8.0F : 0.0F, 1e-5F) << x;
    EXPECT_NEAR(whole[64 + x].y, 0.0F, 1e-5F) << x;
  }
  // The bar rests after the end.
  for (const vec2& movement : movements({"--fps", "4", "--frames", "4"}, "end.exr")) EXPECT_EQ(movement, vec2(0.0F));
}

TEST_F(MotionCliTest, JobsCropsAndErrorTargetsGiveTheSameNumbers) {
  const OptionValues frame = {"--fps", "4", "--frames", "1"};
  const auto with = [&](const OptionValues& more, const std::string& output) {
    OptionValues words = frame;
    words.insert(words.end(), more.begin(), more.end());
    return movements(words, output);
  };
  const std::vector<vec2> whole = with({"-s", "5"}, "a.exr");
  EXPECT_EQ(with({"-s", "5", "--job", "job", "--tiles", "3", "2"}, "b.exr"), whole);
  EXPECT_EQ(with({"--target-error", "0.1"}, "c.exr"), whole);
  const std::vector<vec2> crop = with({"-s", "5", "--crop", "16", "1", "32", "3"}, "d.exr");
  for (size_t i = 0; i < crop.size(); ++i) EXPECT_EQ(crop[i], whole[64 * (1 + i / 16) + 16 + i % 16]);
}

TEST_F(MotionCliTest, OfBlurredFramesBelongsToTheMiddleSample) {
  // Sample 2 of 4 shows the moment 1 / 4 after the frame, in units of the shutter: the bar is one pixel ahead.
  const std::vector<vec2> blurred = movements({"--fps", "4", "--frames", "1", "--shutter", "0.5", "-s", "4"});
  for (uint32_t x = 0; x < 64; ++x) {
    EXPECT_NEAR(blurred[64 + x].x, x >= 21 && x < 29 ? 8.0F : 0.0F, 1e-5F) << x;
  }
}

TEST_F(MotionCliTest, FollowsTheCamera) {
  // The camera of the path looks at the bar from a distance of 4 and moves by 1 to the left and 0.5 upwards. The height
  // of the picture is 4 pixels and 2 * 4 * tan(45 / 2 degrees) units.
  write("path.json", R"({"format": "promin camera path", "version": 1, "fps": 1, "frames": [
    {"time_s": 0, "eye": [0, 0, 4], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45},
    {"time_s": 1, "eye": [-1, 0.5, 4], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45}]})");
  render({"bar.gltf", "--path", "path.json", "--frames", "0", "--size", "8x4", "--aov", "motion"}, "a.exr");
  const std::vector<vec2> moved = read_movements("a.exr");
  ASSERT_EQ(moved.size(), 32U);
  const auto pixel = static_cast<float>(4.0 / (8.0 * std::tan(std::numbers::pi / 8.0)));
  EXPECT_NEAR(moved[8 + 4].x, pixel, 1e-5F);
  EXPECT_NEAR(moved[8 + 4].y, -0.5F * pixel, 1e-5F);
  // A turntable turns around x = 4, the middle of the picture, by 45 degrees a frame. A pixel has a unit. The bar lies
  // in the plane of the axis, so its distances from the middle shrink.
  render({"bar.gltf", "--turntable", "8", "--frames", "0", "--size", "16x16", "-s", "1", "--aov", "motion"}, "b.exr");
  const std::vector<vec2> turned = read_movements("b.exr");
  ASSERT_EQ(turned.size(), 256U);
  EXPECT_NEAR(turned[8 * 16 + 4].x, 3.5F * (1.0F - std::sqrt(0.5F)), 1e-5F);
  EXPECT_NEAR(turned[8 * 16 + 4].y, 0.0F, 1e-5F);
}

TEST_F(MotionCliTest, TheFilesCameraMovesToo) {
  nlohmann::json gltf = nlohmann::json::parse(read("bar.gltf"));
  gltf["animations"][0]["channels"][0]["target"]["node"] = 1;
  gltf["nodes"][0]["translation"] = {0, 0, -4};
  write("bar.gltf", gltf.dump());
  // Its camera moves from x = 0 to x = 8 in a second.
  const std::vector<vec2> moved = movements({"--fps", "4", "--frames", "0"});
  EXPECT_NEAR(moved[64 + 32].x, -8.0F, 1e-5F);
}

}  // namespace
}  // namespace promin
