// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests run `promin compare`.
#include <gmock/gmock.h>

#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/cli_fixture.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class CompareCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    Image image{uvec2(16, 12), std::vector<vec3>(16 * 12, vec3(0.5F))};
    write_image(folder() / "a.exr", image);
    write_image(folder() / "a.png", image);
    image.at(3, 2) = vec3(0.5F, 0.25F, 0.5F);
    image.at(9, 7) = vec3(0.5F, 0.5F, 0.875F);
    write_image(folder() / "b.exr", image);
    write_image(folder() / "b.png", image);
  }

  ProcessResult compare(const OptionValues& more) const {
    // At such a low resolution FLIP's filters are small and fast.
    OptionValues arguments = {"compare", "--pixels-per-degree", "5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(CompareCliTest, TellsTheFigures) {
  const ProcessResult same = compare({"a.exr", "a.exr", "--fail", "0"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("PSNR        inf dB"));
  const ProcessResult other = compare({"a.exr", "b.exr"});
  EXPECT_EQ(other.exit_code, 0) << "without a limit";
  EXPECT_THAT(other.out, HasSubstr("largest     0.375, at pixel 9 7\n"));
  EXPECT_THAT(other.out, HasSubstr("over        2 pixels (1.042 %) differ by more than 0\n"));
  const json figures = json::parse(compare({"a.exr", "b.exr", "--json", "--fail", "0.3", "--fail-percent", "1"}).out);
  EXPECT_DOUBLE_EQ(figures.at("mean"), 0.625 / 576);
  EXPECT_EQ(figures.at("different"), 1);
  EXPECT_EQ(figures.at("largest_at"), json({9, 7}));
  EXPECT_GT(figures.at("flip"), 0.0);
  EXPECT_EQ(json::parse(compare({"a.exr", "a.exr", "--json"}).out).at("psnr_db"), nullptr);
  // FLIP compares displayed colours, so light and its codes give the same result except for rounding.
  const json coded = json::parse(compare({"a.png", "b.png", "--json"}).out);
  EXPECT_NEAR(coded.at("flip"), figures.at("flip"), 2e-4);
}

TEST_F(CompareCliTest, MoreThanTheLimitIsFive) {
  EXPECT_EQ(compare({"a.exr", "b.exr", "--fail", "0.375"}).exit_code, 0);
  const ProcessResult quiet = compare({"a.exr", "b.exr", "--fail", "0.25", "--quiet"});
  EXPECT_EQ(std::pair(quiet.exit_code, quiet.out), std::pair(5, std::string()));
  const ProcessResult over = compare({"a.exr", "b.exr", "--fail", "0.25"});
  EXPECT_EQ(over.exit_code, 5);
  EXPECT_THAT(over.err, HasSubstr("promin: b.exr compared with a.exr: 1 pixel differs by more than 0.25, with the "
                                  "largest difference at pixel 9 7 (0.375)\n"));
  EXPECT_EQ(compare({"a.exr", "b.exr", "--fail", "0.25", "--fail-percent", "0.53"}).exit_code, 0) << "1 of 192";
  const ProcessResult share = compare({"a.exr", "b.exr", "--fail", "0.25", "--fail-percent", "0.52"});
  EXPECT_EQ(share.exit_code, 5);
  EXPECT_THAT(share.err, HasSubstr("1 pixel differs by more than 0.25, 0.520833 % where 0.52 % is allowed, with "
                                   "the largest difference at"));
}

TEST_F(CompareCliTest, LimitsOfCodesAreFractions) {
  EXPECT_EQ(compare({"a.exr", "b.exr", "--fail", "3/8"}).exit_code, 0);
  EXPECT_EQ(compare({"a.exr", "b.exr", "--fail", "2.99/8"}).exit_code, 5);
  const ProcessResult whole = compare({"a.png", "b.png", "--fail", "2"});
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_THAT(
      whole.err,
      HasSubstr("promin: warning: --fail 2 never fails, because the values of these files are from 0 to 1; 2 of 255 "
                "is --fail 2/255"));
  EXPECT_EQ(compare({"a.exr", "b.exr", "--fail", "2"}).err, "") << "light has no most";
  EXPECT_EQ(compare({"a.png", "a.png", "--fail", "2/255"}).err, "");
  expect_failure(compare({"a.png", "b.png", "--fail", "2/0"}), 2, "not \"0\" in \"2/0\"");
}

TEST_F(CompareCliTest, WritesWhereTheyDiffer) {
  ASSERT_EQ(compare({"a.exr", "b.exr", "-o", "d.exr"}).exit_code, 0);
  const Image difference = read_image(folder() / "d.exr");
  EXPECT_EQ(difference.at(3, 2), vec3(0, 0.25F, 0));
  EXPECT_EQ(difference.at(9, 7), vec3(0, 0, 0.375F));
  EXPECT_EQ(difference.at(0, 0), vec3(0));
  EXPECT_THAT(read("d.exr"), HasSubstr("flip"));
  ASSERT_EQ(compare({"a.png", "b.png", "-o", "d.png"}).exit_code, 0);
  const Image shown = read_image(folder() / "d.png");
  EXPECT_GT(shown.at(9, 7).x, 0.05F);
  EXPECT_LT(shown.at(0, 11).x, 0.02F) << "far from both";
  expect_failure(compare({"a.exr", "b.exr", "-o", "a.exr"}), 2, "output.input");
  expect_failure(compare({"a.exr", "b.exr", "-o", "d.txt"}), 2, "output.extension");
}

TEST_F(CompareCliTest, WhatCannotBeComparedIsSaid) {
  expect_failure(compare({"a.exr", "c.exr"}), 3, "file.missing c.exr:");
  expect_failure(compare({"a.exr", "a.png"}), 3, "picture.pair.spaces");
  write_image(folder() / "small.exr", {uvec2(16, 11), std::vector<vec3>(16 * 11)});
  expect_failure(compare({"a.exr", "small.exr"}), 3, "picture.pair.sizes 16x12 16x11");
  const Channel depth{"Z", false, std::vector<uint32_t>(16 * 12)};
  write_image(folder() / "deep.exr", read_image(folder() / "a.exr"), {}, std::nullopt, {&depth, 1});
  expect_failure(compare({"a.exr", "deep.exr"}), 3, "picture.pair.channels deep.exr Z");
  write("text.exr", "no picture");
  expect_failure(compare({"a.exr", "text.exr"}), 3, "the picture cannot be read");
  expect_failure(compare({"a.exr", "b.exr", "--fail-percent", "3"}), 2, "usage.option.needs --fail-percent --fail");
  expect_failure(compare({"a.exr", "b.exr", "--fail", "-1"}), 2, "--fail takes a number from 0");
}

/// The fixture has two EXRs of the same colours, one in one part and one in several. They have 200 rows, more than the
/// program holds in memory at a time.
class CompareChannelsCliTest : public CompareCliTest {
 protected:
  static constexpr uvec2 kSize{600, 200};
  static constexpr size_t kPixels = size_t{kSize.x} * kSize.y;

  void SetUp() override {
    CompareCliTest::SetUp();
    channels_ = {{"Z", false, std::vector<uint32_t>(kPixels, std::bit_cast<uint32_t>(0.5F))},
                 {"object", true, std::vector<uint32_t>(kPixels, 7)}};
    for (const char* letter : {"X", "Y", "Z"}) {
      for (const char* name : {"N.", "P.", "shading_normal."}) {
        channels_.push_back({name + std::string(letter), false, std::vector<uint32_t>(kPixels)});
      }
    }
    channels_.front().values.front() = std::bit_cast<uint32_t>(std::numeric_limits<float>::infinity());
    write_channels("one.exr");
  }

  void write_channels(const std::string& file) const {
    const Image image{kSize, std::vector<vec3>(kPixels, vec3(0.5F))};
    write_image(folder() / file, image, {}, std::nullopt, channels_);
  }

  std::vector<Channel> channels_;
};

TEST_F(CompareChannelsCliTest, EveryChannelIsCompared) {
  channels_[0].values[kPixels - 3] = std::bit_cast<uint32_t>(0.75F);
  channels_[1].values[5] = 9;
  write_channels("other.exr");
  const ProcessResult other = compare({"one.exr", "other.exr", "--fail", "0.25"});
  EXPECT_EQ(other.exit_code, 5);
  EXPECT_THAT(other.err,
              AllOf(HasSubstr("other.exr compared with"),
                    HasSubstr("differs by more than 0.25 in object, with the largest difference at pixel 5 0 (2)\n")));
  EXPECT_THAT(other.out, HasSubstr("mean        0\n"));
  EXPECT_THAT(other.out, HasSubstr("Z: largest 0.25, at pixel 597 199; "));
  EXPECT_THAT(other.out, HasSubstr("object: largest 2, at pixel 5 0; "));
  EXPECT_THAT(other.out, HasSubstr("9 in addition to R, G and B are equal\n"));
  EXPECT_EQ(compare({"one.exr", "other.exr", "--fail", "2"}).exit_code, 0);
  const ProcessResult nearer = compare({"one.exr", "other.exr", "--json", "--fail", "0.125"});
  EXPECT_EQ(nearer.exit_code, 5);
  EXPECT_THAT(nearer.err,
              HasSubstr("differs by more than 0.125 in Z, with the largest difference at pixel 597 199 (0.25)"));
  const json figures = json::parse(nearer.out).at("channels");
  EXPECT_EQ(figures.size(), 11U);
  EXPECT_EQ(figures.at("Z"), json({{"largest", 0.25}, {"largest_at", {597, 199}}, {"different", 1}}));
  EXPECT_EQ(figures.at("N.X").at("different"), 0);
  // If only one side is infinite, the difference is not a number.
  channels_[0].values.front() = 0;
  write_channels("other.exr");
  const ProcessResult infinite = compare({"one.exr", "other.exr", "--json", "--fail", "1e9"});
  EXPECT_EQ(infinite.exit_code, 5);
  EXPECT_THAT(infinite.err, HasSubstr("in Z, with the largest difference at pixel 0 0 (inf)"));
  EXPECT_EQ(json::parse(infinite.out)["channels"]["Z"]["largest"], nullptr);
}

TEST_F(CompareChannelsCliTest, ChannelsThatOneHasAreSaid) {
  channels_.resize(1);
  write_channels("other.exr");
  expect_failure(compare({"other.exr", "one.exr"}), 3,
                 "the pictures have different channels: only one.exr has N.X N.Y N.Z P.X P.Y and 5 more");
}

}  // namespace
}  // namespace promin
