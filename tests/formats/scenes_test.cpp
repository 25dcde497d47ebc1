// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check the scenes in scenes/: the generator writes exactly the stored files, and all of them load.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <variant>

#include "promin/load_scene.h"
#include "scene/world_scene.h"
#include "support/process.h"
#include "support/scene_files.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

/// Returns the name and the bytes of each file.
std::map<std::string, std::string> contents_of(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    contents[entry.path().filename()] = std::string(std::istreambuf_iterator<char>(file), {});
  }
  return contents;
}

void run_make_scenes(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {std::string(PROMIN_TOOLS_DIR) + "/make_scenes.py"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const ProcessResult result = Process(PROMIN_PYTHON, words, {}).wait();
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

class ScenesTest : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("promin_scenes_" + std::to_string(getpid()));
};

TEST_F(ScenesTest, GeneratorWritesWhatIsCheckedIn) {
  ASSERT_NO_FATAL_FAILURE(run_make_scenes({"-o", folder_}));
  const auto expected = contents_of(PROMIN_SCENES_DIR);
  const auto written = contents_of(folder_);
  for (const auto& [name, bytes] : expected) {
    ASSERT_TRUE(written.contains(name)) << name << " is in scenes/ but make_scenes.py does not write it";
    EXPECT_TRUE(written.at(name) == bytes) << name << " differs: run tools/make_scenes.py";
  }
  EXPECT_EQ(written.size(), expected.size());
}

TEST_F(ScenesTest, EverySceneLoadsWithoutWarning) {
  const std::vector<fs::path> files = scene_files(PROMIN_SCENES_DIR);
  EXPECT_GE(files.size(), 22U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file);
    const Scene scene = load_scene(file);
    if (file.filename() == "glass.gltf") {
      EXPECT_THAT(scene.warnings, testing::ElementsAre(testing::HasSubstr("\"frosted\" is rough glass")));
    } else {
      EXPECT_THAT(scene.warnings, testing::IsEmpty());
    }
    if (file.extension() == ".gltf") {
      EXPECT_THAT(scene.cameras, testing::Not(testing::IsEmpty()));
      EXPECT_THAT(scene.lights, testing::Not(testing::IsEmpty()));
    }
  }
}

TEST_F(ScenesTest, FineScenesHaveWhatTheyAreNamedFor) {
  ASSERT_NO_FATAL_FAILURE(run_make_scenes({"--fine", "-o", folder_}));
  EXPECT_EQ(scene_files(folder_).size(), 2U);
  const Scene textures = load_scene(folder_ / "textures.gltf");
  EXPECT_THAT(textures.warnings, testing::IsEmpty());
  EXPECT_EQ(textures.images.size(), 2U);
  const Scene wires = load_scene(folder_ / "wires.gltf");
  EXPECT_THAT(wires.warnings, testing::IsEmpty());
  std::vector<float> radii;
  for (const world::Object& object : world::flatten(wires).objects) {
    if (const auto* wire = std::get_if<world::Cylinder>(&object.shape)) radii.push_back(wire->radius);
  }
  ASSERT_EQ(radii.size(), 48U);
  // The picture has 360 rows and shows a height of 2.
  EXPECT_FLOAT_EQ(radii.front(), 0.5F / 8.0F * 2.0F / 360.0F);
  EXPECT_FLOAT_EQ(radii.back(), 0.5F * 2.0F / 360.0F);
}

TEST_F(ScenesTest, SphereflakeHasNineSpheresOnEachSphere) {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "flake.gltf";
  ASSERT_NO_FATAL_FAILURE(run_make_scenes({"--sphereflake", "3", "-o", file}));
  std::vector<world::Sphere> spheres;
  const world::Scene flat = world::flatten(load_scene(file));
  for (const world::Object& object : flat.objects) {
    if (const auto* sphere = std::get_if<world::Sphere>(&object.shape)) spheres.push_back(*sphere);
  }
  ASSERT_EQ(spheres.size(), 1U + 9U + 81U + 729U);
  for (const world::Sphere& child : spheres) {
    if (child.radius == spheres.front().radius) continue;
    int parent_count = 0;
    for (const world::Sphere& parent : spheres) {
      const bool is_thrice = std::abs(parent.radius - 3.0F * child.radius) < 1e-5F;
      const float gap = glm::length(parent.center - child.center) - parent.radius - child.radius;
      if (is_thrice && std::abs(gap) < 1e-5F) ++parent_count;
    }
    EXPECT_GE(parent_count, 1) << "a sphere of radius " << child.radius << " touches no larger one";
  }
}

}  // namespace
}  // namespace promin
