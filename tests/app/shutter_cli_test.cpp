// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests render frames with motion blur.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "bar_film.h"
#include "promin/display.h"

namespace promin {
namespace {

class ShutterCliTest : public BarFilmTest {};

/// Matches the bytes of an EXR with this entry of metadata.
testing::Matcher<std::string> has_entry(const std::string& name, const std::string& value) {
  std::string bytes = name + '\0' + "string" + '\0' + static_cast<char>(value.size());
  bytes += std::string(3, '\0') + value;
  return testing::HasSubstr(bytes);
}

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

TEST_F(ShutterCliTest, CryptomatteIsTheMeanOfAllSamples) {
  const OptionValues words = {"--shutter", "0.5", "-s", "16", "--aov", "cryptomatte,object,ambient_occlusion"};
  const Image blurred = film(words, "a.exr");
  std::set<uint32_t> ids;
  size_t partly = 0;
  for (const char* kind : {"CryptoObject", "CryptoMaterial"}) {
    const std::vector<uint32_t> id = read_channel("a.exr", std::string(kind) + "00.R");
    const std::vector<uint32_t> share = read_channel("a.exr", std::string(kind) + "00.G");
    ASSERT_EQ(share.size(), 64U * 4U);
    for (size_t i = 0; i < share.size(); ++i) {
      const auto covered = std::bit_cast<float>(share[i]);
      // The bar is white in front of black.
      EXPECT_EQ(covered, blurred.pixels[i].x) << kind << i;
      if (covered > 0.0F) ids.insert(id[i]);
      partly += covered > 0.0F && covered < 1.0F ? 1 : 0;
    }
  }
  EXPECT_EQ(ids.size(), 2U);
  EXPECT_GT(partly, 2 * 4 * 10U);
  OptionValues job = words;
  job.insert(job.end(), {"--job", "job", "--tiles", "3", "2"});
  film(job, "b.exr");
  for (const char* name : {"CryptoObject00.R", "CryptoObject00.G", "CryptoMaterial00.G", "object", "AO"}) {
    EXPECT_EQ(read_channel("b.exr", name), read_channel("a.exr", name)) << name;
  }
}

/// The frame can be rendered again from the metadata of its picture.
TEST_F(ShutterCliTest, MetadataOfAPictureNameItsMoments) {
  const auto frames = [&](const OptionValues& more, const std::string& output) {
    OptionValues words = {"bar.gltf", "--size", "64x4",        "--shutter", "0.25",
                          "--spp",    "4",      "--animation", "0",         "--loop"};
    words.insert(words.end(), more.begin(), more.end());
    return render(words, output);
  };
  const Image third = frames({"--frames", "3", "--fps", "4"}, "a.exr");
  const std::string bytes = read("a.exr");
  EXPECT_THAT(bytes, has_entry("promin:shutter", "0.25"));
  EXPECT_THAT(bytes, has_entry("promin:fps", "4"));
  EXPECT_THAT(bytes, has_entry("promin:frame", "3"));
  EXPECT_THAT(bytes, has_entry("promin:loop", "true"));
  // The moments depend on the frames per second.
  EXPECT_NE(frames({"--frames", "6", "--fps", "8"}, "b.exr").pixels, third.pixels);
  EXPECT_EQ(frames({"--frames", "3", "--fps", "4"}, "c.exr").pixels, third.pixels);
  // Moments of a turntable depend on them only if the scene moves.
  const OptionValues turn = {"bar.gltf", "--turntable", "8", "--frames",  "1", "--size",
                             "8x8",      "-s",          "2", "--shutter", "1"};
  render(turn, "e.exr");
  EXPECT_THAT(read("e.exr"), has_entry("promin:shutter", "1"));
  EXPECT_THAT(read("e.exr"), testing::Not(testing::HasSubstr("promin:fps")));
  OptionValues moving = turn;
  moving.insert(moving.end(), {"--animation", "0"});
  render(moving, "f.exr");
  EXPECT_THAT(read("f.exr"), has_entry("promin:fps", "24"));
  film({"-s", "1"}, "d.exr");
  for (const char* name : {"promin:shutter", "promin:fps", "promin:loop"}) {
    EXPECT_THAT(read("d.exr"), testing::Not(testing::HasSubstr(name)));
  }
}

TEST_F(ShutterCliTest, AverageExposureIsThatOfTheFirstBlurredFrame) {
  const Image blurred = render({"square.gltf", "--turntable", "8", "--frames", "1", "--size", "24x16", "-s", "4",
                                "--shutter", "1", "--exposure", "average", "--aov", "object"},
                               "a.exr");
  const float stops = average_exposure_ev(blurred.pixels, read_channel("a.exr", "object"));
  EXPECT_NE(stops, 0.0F);
  EXPECT_THAT(read("a.exr"), has_entry("promin:exposure_ev", fmt::format("{:g}", stops)));
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
