// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests render frames with motion blur.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bar_film.h"

namespace promin {
namespace {

class ShutterCliTest : public BarFilmTest {};

TEST_F(ShutterCliTest, AMovingBarLeavesItsStreak) {
  constexpr uint32_t kSamples = 16;
  // The bar covers x - 1 to x + 1. It moves by 4 units, which are 16 pixels, while the shutter is open.
  const Image blurred = film({"--shutter", "0.5", "-s", std::to_string(kSamples)}, "a.exr");
  for (uint32_t x = 0; x < 64; ++x) {
    const double place = (x + 0.5) / 4.0 - 4.0;
    const double covered = std::clamp(std::min(place + 1.0, 4.0) - std::max(place - 1.0, 0.0), 0.0, 2.0) / 4.0;
    // The ends of the streak lie within 16 / 16 pixels of their places; the sample's place in the pixel adds to this.
    EXPECT_NEAR(static_cast<double>(blurred.at(x, 2).x), covered, 2.5 / kSamples) << x;
  }
  const Image sharp = film({"-s", std::to_string(kSamples)}, "b.exr");
  EXPECT_EQ(sharp.at(17, 2).x, 1.0F);
  EXPECT_EQ(sharp.at(24, 2).x, 0.0F);
}

TEST_F(ShutterCliTest, JobsAndCropsGiveTheSamePixels) {
  const Image whole = film({"--shutter", "1", "-s", "4"}, "a.exr");
  const Image cropped = film({"--shutter", "1", "-s", "4", "--crop", "10", "1", "30", "3"}, "b.exr");
  for (uint32_t y = 0; y < 2; ++y) {
    for (uint32_t x = 0; x < 20; ++x) EXPECT_EQ(cropped.at(x, y), whole.at(x + 10, y + 1));
  }
  const Image merged = film({"--shutter", "1", "-s", "4", "--job", "job", "--tiles", "3", "2"}, "c.exr");
  EXPECT_EQ(merged.pixels, whole.pixels);
}

TEST_F(ShutterCliTest, AllSamplesOfARestingSceneAreThePicture) {
  write("path.json", R"({"format": "promin camera path", "version": 1, "fps": 1, "frames": [
    {"time_s": 0, "eye": [4, 0, 6], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45},
    {"time_s": 1, "eye": [4, 0, 6], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45}]})");
  const OptionValues rest = {"bar.gltf", "--path", "path.json", "--frames", "0",     "--size",
                             "24x16",    "-s",     "8",         "--alpha",  "--aov", "depth"};
  OptionValues open = rest;
  open.insert(open.end(), {"--shutter", "1"});
  const Image picture = render(rest, "a.exr");
  const Image blurred = render(open, "b.exr");
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(blurred.pixels[i][c], picture.pixels[i][c], 1e-6F);
  }
  const ProcessResult compared = run({"compare", "a.exr", "b.exr", "--fail", "0.000001"});
  EXPECT_EQ(compared.exit_code, 0) << compared.out;
}

TEST_F(ShutterCliTest, ATurningCameraBlursToo) {
  const auto turn = [&](const OptionValues& more, const std::string& output) {
    OptionValues words = {"bar.gltf", "--turntable", "4", "--frames", "1", "--size", "32x24", "-s", "8"};
    words.insert(words.end(), more.begin(), more.end());
    return render(words, output);
  };
  EXPECT_NE(turn({}, "a.exr").pixels, turn({"--shutter", "0.5"}, "b.exr").pixels);
}

}  // namespace
}  // namespace promin
