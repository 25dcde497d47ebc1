// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// Holds whole pictures against POV-Ray's: another renderer, by other people, that shades by the same formulas.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <limits>

#include "cpu/process.h"
#include "image/compare.h"
#include "image/image.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr const char* kSize = "1024";
/// Bounces, as promin counts them.
constexpr const char* kMaxDepth = "6";

/// POV-Ray's EXR has half floats, and edges may fall to either side of a pixel's centre.
constexpr CompareOptions kTolerance = {
    .fail = 0.02F, .fail_percent = 0.5, .hard_fail = std::numeric_limits<float>::infinity()};
constexpr double kMeanTolerance = 0.002;

class PovrayTest : public testing::Test {
 protected:
  void SetUp() override {
    if (*PROMIN_POVRAY == '\0') GTEST_SKIP() << "POV-Ray was not installed when this was configured";
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void run(const fs::path& program, const Words& arguments) const {
    ProcessOptions options;
    options.folder = folder_;
    const ProcessResult result = Process(program, arguments, options).wait();
    ASSERT_EQ(result.exit_code, 0) << program << "\n" << result.err;
  }

  void run_tool(const std::string& name, Words arguments) const {
    arguments.insert(arguments.begin(), std::string(PROMIN_TOOLS_DIR) + "/" + name);
    run(PROMIN_PYTHON, arguments);
  }

  void expect_same_picture(const fs::path& scene) const {
    ASSERT_NO_FATAL_FAILURE(run_tool("scene_to_pov.py", {scene, "-o", "scene.pov", "--max-depth", kMaxDepth}));
    const Words settings = {
        "+Iscene.pov", "+Opovray.exr", "+FE", "-A", "-D", "-GA", std::string("+W") + kSize, std::string("+H") + kSize};
    ASSERT_NO_FATAL_FAILURE(run(PROMIN_POVRAY, settings));
    ASSERT_NO_FATAL_FAILURE(run(PROMIN_EXECUTABLE, {"render", scene, "-o", "promin.exr", "--size", kSize, kSize,
                                                    "--max-depth", kMaxDepth, "--quiet"}));
    const ImageDifference difference =
        compare_images(read_image(folder_ / "promin.exr"), read_image(folder_ / "povray.exr"), kTolerance);
    std::cout << difference.summary() << '\n';
    EXPECT_TRUE(difference.is_equal);
    EXPECT_LE(difference.mean_absolute, kMeanTolerance);
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("promin_povray_" + std::to_string(getpid()));
};

TEST_F(PovrayTest, AllPrimitives) {
  expect_same_picture(fs::path(PROMIN_SCENES_DIR) / "all_primitives.gltf");
}

TEST_F(PovrayTest, Sphereflake) {
  ASSERT_NO_FATAL_FAILURE(run_tool("make_scenes.py", {"--sphereflake", "4", "-o", "sphereflake.gltf"}));
  expect_same_picture(folder_ / "sphereflake.gltf");
}

}  // namespace
}  // namespace promin
