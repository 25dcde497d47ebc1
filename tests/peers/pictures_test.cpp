// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests compare whole pictures with those of POV-Ray and Tachyon. These independent renderers shade with the same
// formulas.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <limits>

#include "measure/compare_images.h"
#include "promin/image.h"
#include "support/process.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using OptionValues = std::vector<std::string>;

constexpr const char* kSize = "1024";
/// The number of bounces, as promin counts them.
constexpr const char* kMaxDepth = "6";

/// The limits of differences. POV-Ray's EXR has half floats and Tachyon's picture has 16 bits, and edges may fall to
/// either side of a pixel's centre.
constexpr CompareOptions kTolerance = {
    .fail = 0.02F, .fail_percent = 0.5, .hard_fail = std::numeric_limits<float>::infinity()};
constexpr double kMeanTolerance = 0.002;

/// Another renderer, with the programs that write a scene in its language and read its picture.
struct Peer {
  std::string name;
  /// The renderer's program; empty if it was not installed when this build was configured.
  fs::path program;
  std::string converter;
  std::string scene;
  OptionValues arguments;
  std::string picture;
};

Peer povray() {
  const std::string size(kSize);
  return {"POV-Ray",
          PROMIN_POVRAY,
          "scene_to_pov.py",
          "scene.pov",
          {"+Iscene.pov", "+Opovray.exr", "+FE", "-A", "-D", "-GA", "+W" + size, "+H" + size},
          "povray.exr"};
}

Peer tachyon() {
  return {"Tachyon",
          PROMIN_TACHYON,
          "scene_to_tachyon.py",
          "scene.dat",
          {"scene.dat", "-fullshade", "-shade_phong", "-format", "PPM48", "-res", kSize, kSize, "-o", "tachyon.ppm"},
          "tachyon.ppm"};
}

/// Limits a picture to the range that a picture of few bits can show.
Image clamp(Image image) {
  for (vec3& pixel : image.pixels) pixel = glm::clamp(pixel, 0.0F, 1.0F);
  return image;
}

class PeerPictureTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void run(const fs::path& program, const OptionValues& arguments) const {
    ProcessOptions options;
    options.folder = folder_;
    const ProcessResult result = Process(program, arguments, options).wait();
    ASSERT_EQ(result.exit_code, 0) << program << "\n" << result.err;
  }

  void run_tool(const std::string& name, OptionValues arguments) const {
    arguments.insert(arguments.begin(), std::string(PROMIN_TOOLS_DIR) + "/" + name);
    run(PROMIN_PYTHON, arguments);
  }

  void expect_same_picture(const Peer& peer, const fs::path& scene) const {
    if (peer.program.empty()) GTEST_SKIP() << peer.name << " was not installed when this was configured";
    ASSERT_NO_FATAL_FAILURE(run_tool(peer.converter, {scene, "-o", peer.scene, "--max-depth", kMaxDepth}));
    ASSERT_NO_FATAL_FAILURE(run(peer.program, peer.arguments));
    ASSERT_NO_FATAL_FAILURE(run(PROMIN_EXECUTABLE, {"render", scene, "-o", "promin.exr", "--spp", "1", "--size", kSize,
                                                    kSize, "--max-depth", kMaxDepth, "--quiet"}));
    const ImageDifference difference = compare_images(clamp(read_image(folder_ / "promin.exr")),
                                                      clamp(read_image(folder_ / peer.picture)), kTolerance);
    std::cout << difference.summary() << '\n';
    EXPECT_TRUE(difference.is_equal);
    EXPECT_LE(difference.mean_absolute, kMeanTolerance);
  }

  fs::path make_sphereflake() const {
    run_tool("make_scenes.py", {"--sphereflake", "4", "--endless-ground", "-o", "sphereflake.gltf"});
    return folder_ / "sphereflake.gltf";
  }

  const fs::path scenes_ = PROMIN_SCENES_DIR;
  const fs::path folder_ = fs::path(testing::TempDir()) / ("promin_peers_" + std::to_string(getpid()));
};

TEST_F(PeerPictureTest, PovrayAllPrimitives) {
  expect_same_picture(povray(), scenes_ / "all_primitives.gltf");
}

TEST_F(PeerPictureTest, PovrayBoxes) {
  expect_same_picture(povray(), scenes_ / "box.gltf");
}

TEST_F(PeerPictureTest, PovrayCapsules) {
  expect_same_picture(povray(), scenes_ / "capsule.gltf");
}

TEST_F(PeerPictureTest, PovraySphereflake) {
  expect_same_picture(povray(), make_sphereflake());
}

TEST_F(PeerPictureTest, TachyonTriangles) {
  expect_same_picture(tachyon(), scenes_ / "triangles_sharp.gltf");
}

TEST_F(PeerPictureTest, TachyonSphereflake) {
  expect_same_picture(tachyon(), make_sphereflake());
}

}  // namespace
}  // namespace promin
