// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Every scene of scenes/ against its stored picture, and pictures that must not pass.
// PROMIN_UPDATE_GOLDENS=1, which tools/update_goldens sets, writes them instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "gpu/device_fixture.h"
#include "image/compare.h"
#include "layout.h"
#include "promin/image.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = PROMIN_SCENES_DIR;
const fs::path kGoldens = PROMIN_GOLDENS_DIR;

/// In linear light.
constexpr float kFail = 0.004F;
constexpr float kHardFail = 0.012F;
constexpr double kFailShare = 0.0002;
/// On an edge a driver's rounding may decide for the neighbour: a pixel may show anything between its golden
/// neighbours' values, but only so many may, or a shifted picture would pass.
constexpr double kEdgeShare = 0.005;

/// False where there is a NaN.
bool is_at_most(const vec3& v, float bound) {
  return v.x <= bound && v.y <= bound && v.z <= bound;
}

bool is_between_neighbours(const Image& golden, uint32_t x, uint32_t y, const vec3& pixel) {
  vec3 lo = golden.at(x, y);
  vec3 hi = lo;
  for (uint32_t j = y == 0 ? 0 : y - 1; j <= std::min(y + 1, golden.size.y - 1); ++j) {
    for (uint32_t i = x == 0 ? 0 : x - 1; i <= std::min(x + 1, golden.size.x - 1); ++i) {
      lo = glm::min(lo, golden.at(i, j));
      hi = glm::max(hi, golden.at(i, j));
    }
  }
  return glm::all(glm::greaterThanEqual(pixel, lo - kFail)) && glm::all(glm::lessThanEqual(pixel, hi + kFail));
}

/// Empty if the picture is the golden one; otherwise what is wrong.
std::string compare_with_golden(const Image& picture, const Image& golden) {
  if (picture.size != golden.size) return "the sizes differ";
  size_t failed = 0;
  size_t hard_failed = 0;
  size_t edges = 0;
  for (uint32_t y = 0; y < golden.size.y; ++y) {
    for (uint32_t x = 0; x < golden.size.x; ++x) {
      const vec3 difference = glm::abs(picture.at(x, y) - golden.at(x, y));
      if (is_at_most(difference, kFail)) continue;
      if (is_between_neighbours(golden, x, y, picture.at(x, y))) {
        ++edges;
        continue;
      }
      ++failed;  // NaN comes here: it is between nothing
      if (!is_at_most(difference, kHardFail)) ++hard_failed;
    }
  }
  const auto pixels = static_cast<double>(golden.pixels.size());
  const bool passes = hard_failed == 0 && static_cast<double>(failed) <= kFailShare * pixels &&
                      static_cast<double>(edges) <= kEdgeShare * pixels;
  if (passes) return "";
  return std::to_string(hard_failed) + " pixels differ by more than " + std::to_string(kHardFail) + ", " +
         std::to_string(failed) + " by more than " + std::to_string(kFail) + ", " + std::to_string(edges) +
         " show a neighbour";
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kScenes)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".gltf" || ending == ".obj") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct Subject {
  Scene scene;
  View view;
};

Subject load_subject(const std::string& name) {
  Subject subject;
  subject.scene = load_scene(kScenes / name);
  subject.view.size = uvec2(160, 90);
  subject.view.camera =
      subject.scene.cameras.empty() ? frame_scene(subject.scene, 16.0F / 9.0F) : subject.scene.cameras[0];
  if (subject.scene.lights.empty()) subject.scene.lights = {make_headlight()};
  return subject;
}

class GoldenTest : public test::DeviceTest {
 protected:
  static Image render(const Subject& subject) { return Renderer(device(), subject.scene).render(subject.view).image; }
};

class SceneGoldenTest : public GoldenTest, public testing::WithParamInterface<std::string> {};

TEST_P(SceneGoldenTest, LooksAsStored) {
  const fs::path file = kGoldens / (fs::path(GetParam()).stem().string() + ".exr");
  const Image picture = render(load_subject(GetParam()));
  if (std::getenv("PROMIN_UPDATE_GOLDENS") != nullptr) {
    const char* commit = std::getenv("PROMIN_COMMIT");
    write_image(file, picture,
                {{"promin:scene", GetParam()},
                 {"promin:driver", gpu::info_of(device()).driver},
                 {"promin:commit", commit == nullptr ? "" : commit}});
    return;
  }
  ASSERT_TRUE(fs::exists(file)) << "no golden picture of " << GetParam() << ": look at it and run tools/update_goldens";
  const Image golden = read_image(file);
  const std::string problem = compare_with_golden(picture, golden);
  if (problem.empty()) return;
  fs::create_directories(PROMIN_FAILURES_DIR);
  const fs::path difference = fs::path(PROMIN_FAILURES_DIR) / (fs::path(GetParam()).stem().string() + ".png");
  if (picture.size == golden.size) write_difference_image(difference, picture, golden, 4.0F);
  FAIL() << problem << "; the difference, fourfold, is " << difference;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneGoldenTest, testing::ValuesIn(scene_names()), [](const auto& param_info) {
  std::string name = param_info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

// Negative controls: if one of these passes, the comparison above proves nothing.

constexpr const char* kControl = "all_primitives.gltf";

std::string compare_changed(const Image& picture) {
  return compare_with_golden(picture, read_image(kGoldens / "all_primitives.exr"));
}

TEST_F(GoldenTest, AHalfPixelShiftIsSeen) {
  Subject subject = load_subject(kControl);
  const vec3 right = glm::cross(subject.view.camera.look, subject.view.camera.up);
  const float pixel = 2.0F * std::tan(0.5F * subject.view.camera.yfov) / static_cast<float>(subject.view.size.y);
  subject.view.camera.look = glm::normalize(subject.view.camera.look + 0.5F * pixel * right);
  EXPECT_NE(compare_changed(render(subject)), "");
}

TEST_F(GoldenTest, MissingShadowsAreSeen) {
  const Subject subject = load_subject(kControl);
  RendererOptions options;
  options.left_out_features = layout::FEATURE_SHADOWS;
  EXPECT_NE(compare_changed(Renderer(device(), subject.scene, options).render(subject.view).image), "");
}

TEST_F(GoldenTest, MissingMirrorRaysAreSeen) {
  Subject subject = load_subject(kControl);
  subject.view.max_depth = 0;
  EXPECT_NE(compare_changed(render(subject)), "");
}

TEST_F(GoldenTest, ALightThatIsOffIsSeen) {
  Subject subject = load_subject(kControl);
  ASSERT_GT(subject.scene.lights.size(), 1U);
  subject.scene.lights.pop_back();
  EXPECT_NE(compare_changed(render(subject)), "");
}

TEST_F(GoldenTest, NotANumberIsSeen) {
  Image picture = read_image(kGoldens / "all_primitives.exr");
  picture.at(3, 3).y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(compare_changed(picture), "");
}

}  // namespace
}  // namespace promin
