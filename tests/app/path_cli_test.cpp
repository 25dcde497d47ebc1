// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run `promin render --path` and check the frames of a camera path.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli_fixture.h"
#include "work/pictures/frame_plan.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

/// The path has three poses in front of the fixture's scenes; kPoses has the options that give each pose alone.
constexpr const char* kCameraPath = R"({"format": "promin camera path", "version": 1, "frames": [
  {"time_s": 0.0, "eye": [0, 0, 4], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45, "near": 0.01},
  {"time_s": 0.1, "eye": [1, 0.5, 3], "look": [-0.28, 0, -0.96], "up": [0, 1, 0], "fov_deg": 60},
  {"time_s": 0.3, "eye": [2, 0, 3], "look": [-0.6, 0, -0.8], "up": [0, 1, 0], "fov_deg": 30}]})";
const OptionValues kPoses[] = {
    {"--eye", "0", "0", "4", "--direction", "0", "0", "-1", "--up", "0", "1", "0", "--fov", "45", "--near", "0.01"},
    {"--eye", "1", "0.5", "3", "--direction", "-0.28", "0", "-0.96", "--up", "0", "1", "0", "--fov", "60", "--near",
     "0"},
    {"--eye", "2", "0", "3", "--direction", "-0.6", "0", "-0.8", "--up", "0", "1", "0", "--fov", "30", "--near", "0"}};

class PathCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("path.json", kCameraPath);
  }

  ProcessResult render_path(OptionValues more) const {
    more.insert(more.begin(), {"render", "square.gltf", "--size", "32", "18", "--path", "path.json"});
    return run(more);
  }
};

TEST_F(PathCliTest, EachFrameHasTheBitsOfItsPoseAlone) {
  // The second scene has no lights, so its headlight follows the camera.
  for (const char* scene : {"square.gltf", "triangle.obj"}) {
    const ProcessResult result = run({"render", scene, "--size", "32", "18", "-s", "2", "--path", "path.json", "-o",
                                      "f.##.exr", "--aov", "depth", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (size_t i = 0; i < std::size(kPoses); ++i) {
      OptionValues alone = {scene, "--size", "32", "18", "-s", "2"};
      alone.insert(alone.end(), kPoses[i].begin(), kPoses[i].end());
      const Image expected = render(alone, "alone.exr");
      EXPECT_EQ(read_image(folder() / ("f.0" + std::to_string(i) + ".exr")).pixels, expected.pixels)
          << scene << ", frame " << i;
      EXPECT_NE(expected.pixels, std::vector<vec3>(expected.pixels.size(), vec3(0.0F)));
    }
  }
}

TEST_F(PathCliTest, RangesPickFramesAndNamesTakeTheirNumbers) {
  EXPECT_EQ(render_path({"--frames", "1-2", "-o", "a#.png", "-o", "b.png.####.exr", "--quiet"}).exit_code, 0);
  EXPECT_THAT(files(), UnorderedElementsAre("path.json", "a1.png", "a2.png", "b.png.0001.exr", "b.png.0002.exr"));
  EXPECT_EQ(render_path({"--frames", "2", "-o", "one.exr", "--quiet"}).exit_code, 0);
  EXPECT_THAT(files(), testing::Contains("one.exr"));
  EXPECT_EQ(run({"render", "square.gltf", "--size", "8", "8", "-o", "x.#.exr"}).exit_code, 0);
  EXPECT_THAT(files(), testing::Contains("x.#.exr")) << "an ordinary name without a path";
  EXPECT_EQ(work::number_file("a/f##.#.exr", 123), "a/f##.123.exr");
  EXPECT_EQ(work::number_file("a#/f.exr", 1), "a#/f.exr");
}

TEST_F(PathCliTest, FramesThatAreThereAreSkipped) {
  const OptionValues options = {"--frames", "0-2", "-o", "a#.png", "-o", "a#.exr", "--skip-existing"};
  ASSERT_EQ(render_path(options).exit_code, 0);
  const std::string first = read("a0.exr");
  write("a0.png", "kept");
  std::filesystem::remove(folder() / "a1.exr");
  const ProcessResult again = render_path(options);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("skipped 2 of 3 frames, whose pictures exist already"));
  EXPECT_THAT(again.out, HasSubstr("1 frame, "));
  EXPECT_EQ(read("a0.png"), "kept");
  EXPECT_THAT(files(), testing::Contains("a1.exr"));
  const ProcessResult nothing = render_path(options);
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_THAT(nothing.err, HasSubstr("skipped 3 of 3 frames"));
  // An empty file is not a picture, and neither is a folder.
  write("a1.png", "");
  OptionValues with_stats = options;
  with_stats.insert(with_stats.end(), {"--stats", "s.json"});
  EXPECT_THAT(render_path(with_stats).err, HasSubstr("skipped 2 of 3 frames"));
  EXPECT_THAT(files(), testing::Contains("s.json"));
  EXPECT_THAT(render_path(with_stats).err, HasSubstr("s.json is not written, because nothing was traced"));
  std::filesystem::remove(folder() / "a2.exr");
  std::filesystem::create_directory(folder() / "a2.exr");
  expect_failure(render_path(options), 1, "output.kind a2.exr:");
}

TEST_F(PathCliTest, FramesHaveTheScenesNameByDefault) {
  ASSERT_EQ(render_path({"--frames", "0-1"}).exit_code, 0);
  EXPECT_THAT(files(), UnorderedElementsAre("path.json", "square.0000.exr", "square.0000.png", "square.0001.exr",
                                            "square.0001.png"));
  std::filesystem::remove(folder() / "square.0000.exr");
  write("square.0000.png", "notes");
  expect_failure(render_path({"--frames", "0-1"}), 2, "output.foreign square.0000.png square.gltf");
  EXPECT_EQ(render_path({"--frames", "2", "--quiet"}).exit_code, 0) << "another frame";
}

TEST_F(PathCliTest, EachFrameOfATimeLimitTellsTheTargetThatGivesItAgain) {
  // Edges with the greatest number of samples take seconds. An empty view reaches the smallest error immediately.
  write("path.json", R"({"format": "promin camera path", "version": 1, "frames": [
    {"time_s": 0.0, "eye": [0, 0, 4], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45, "near": 0.01},
    {"time_s": 0.1, "eye": [0, 0, 4], "look": [0, 0, 1], "up": [0, 1, 0], "fov_deg": 45, "near": 0.01}]})");
  const ProcessResult limited = render_path({"--frames", "0-1", "-o", "limited#.exr", "--time-limit", "3s", "--size",
                                             "320", "180", "--max-spp", "32768", "--background", "0", "0", "0"});
  ASSERT_EQ(limited.exit_code, 0) << limited.err;
  EXPECT_THAT(limited.err, HasSubstr("of frame 1 again: --target-error 1.5258789e-05 "));
  EXPECT_THAT(limited.err, Not(HasSubstr("of frame 0 again: --target-error 1.5258789e-05 ")));
  for (const std::string number : {"0", "1"}) {
    const std::string before = "the same picture of frame " + number + " again: ";
    const size_t place = limited.err.find(before);
    ASSERT_NE(place, std::string::npos) << limited.err;
    const size_t begin = place + before.size();
    std::istringstream line(limited.err.substr(begin, limited.err.find('\n', begin) - begin));
    OptionValues again = {"--frames", number, "-o", "again.exr", "--size", "320", "180", "--background", "0", "0", "0"};
    std::string word;
    while (line >> word) again.push_back(word);
    ASSERT_EQ(render_path(again).exit_code, 0) << limited.err;
    EXPECT_EQ(read("again.exr"), read("limited" + number + ".exr")) << limited.err;
  }
}

TEST_F(PathCliTest, FpsTakesThePathByTime) {
  EXPECT_EQ(render_path({"--fps", "10", "-o", "t#.exr", "--quiet"}).exit_code, 0);
  EXPECT_THAT(files(), UnorderedElementsAre("path.json", "t0.exr", "t1.exr", "t2.exr", "t3.exr"));
  EXPECT_EQ(render_path({"--frames", "0-2", "-o", "s#.exr", "--quiet"}).exit_code, 0);
  const auto pixels = [&](const char* name) { return read_image(folder() / name).pixels; };
  EXPECT_EQ(pixels("t0.exr"), pixels("s0.exr"));
  EXPECT_EQ(pixels("t1.exr"), pixels("s1.exr"));
  EXPECT_NE(pixels("t2.exr"), pixels("s1.exr")) << "half way between";
  EXPECT_NE(pixels("t2.exr"), pixels("s2.exr"));
  EXPECT_EQ(pixels("t3.exr"), pixels("s2.exr"));

  std::string path = kCameraPath;
  path.insert(path.find("\"frames\""), "\"fps\": 10, ");
  write("path.json", path);
  expect_failure(render_path({"-o", "f#.exr", "--frames", "4"}), 2, "path.frame.missing path.json: 4 0 3");
  EXPECT_EQ(render_path({"--fps", "stored", "-o", "f#.exr", "--quiet"}).exit_code, 0);
  EXPECT_EQ(pixels("f2.exr"), pixels("s2.exr"));
}

TEST_F(PathCliTest, StatsTellOfEachFrame) {
  const ProcessResult result = render_path({"--repeat", "2", "-o", "f#.exr", "--stats", "s.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("32x18, 8 spp, 3 frames, "));
  const json stats = json::parse(read("s.json"));
  std::vector<double> times;
  for (const json& frame : stats.at("frames")) {
    EXPECT_EQ(frame.at("frame"), times.size());
    times.push_back(frame.at("trace_ms"));
  }
  ASSERT_EQ(times.size(), 3U);
  EXPECT_EQ(stats.at("rays").at("primary"), 3 * 32 * 18 * 8);
  const double total_ms = times[0] + times[1] + times[2];
  std::sort(times.begin(), times.end());
  EXPECT_EQ(stats.at("times_ms").at("trace"), times[1]) << "the median";
  const double rays = stats.at("rays").at("primary").get<double>() + stats.at("rays").at("shadow").get<double>();
  EXPECT_NEAR(stats.at("mrays_per_s").get<double>(), rays / total_ms / 1e3, 1e-6 * rays / total_ms);
}

TEST_F(PathCliTest, WrongUseIsRefused) {
  const std::pair<OptionValues, std::string> cases[] = {
      {{"-o", "a.exr"}, "output.frames.one a.exr: 3 ####"},
      {{"-o", "a#/f.exr"}, "output.frames.one 3"},
      {{"-o", "f#.exr", "--camera", "main"}, "usage.options.contradict --path --camera"},
      {{"-o", "f#.exr", "--near", "1"}, "usage.options.contradict --path --camera"},
      {{"-o", "f#.exr", "--frames", "1-3"}, "path.frame.missing path.json: 3 0 2"},
      {{"-o", "f#.exr", "--frames", "2-1"}, "usage.option.value --frames"},
      {{"-o", "f#.exr", "--frames", "1-"}, "--frames takes a whole number from 0 to 9999999, not \"\" in \"1-\""},
      {{"-o", "f#.exr", "--frames", "x"}, "from 0 to 9999999, not \"x\""},
      {{"-o", "f#.exr", "--frames", "-1"}, "--frames takes a whole number"},
      {{"-o", "f#.exr", "--fps", "0"}, "--fps takes"},
      {{"-o", "f#.exr", "--fps", "often"}, "--fps takes"},
      {{"-o", "f0.exr", "-o", "f#.exr", "--frames", "0"}, "output.twice"},
      {{"-o", "f#.exr", "--stats", "path.json"}, "output.input"},
  };
  for (const auto& [arguments, part] : cases) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(render_path(arguments), 2, part);
    EXPECT_THAT(files(), testing::ElementsAre("path.json"));
  }
  expect_failure(run({"render", "square.gltf", "-o", "a.exr", "--frames", "0"}), 2, "animation.missing square.gltf");
  expect_failure(run({"render", "square.gltf", "-o", "a.exr", "--fps", "9"}), 2, "animation.missing square.gltf");
  write("path.json", "{}");
  const ProcessResult bad = render_path({"-o", "f#.exr"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("(1 of 3 problems)"));
}

TEST_F(PathCliTest, AFailureKeepsTheFramesDoneAndNamesItsOwn) {
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  // The first frame is empty, so its file is small.
  std::string path = kCameraPath;
  path.replace(path.find("[0, 0, -1]"), 10, "[0, 0, 1]");
  write("path.json", path);
  fill_disk(2000);
  expect_failure(render_path({"--size", "300", "300", "-o", "f#.png", "--quiet"}), 1, "f1.png: frame 1: ");
  EXPECT_THAT(files(), UnorderedElementsAre("path.json", "f0.png"));
  EXPECT_EQ(read_image(folder() / "f0.png").size, uvec2(300, 300));
}

}  // namespace
}  // namespace promin
