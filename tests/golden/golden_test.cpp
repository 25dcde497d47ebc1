// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare a picture of every scene in scenes/ with its stored one, and check that wrong pictures fail.
// PROMIN_UPDATE_GOLDENS=1, which tools/update_goldens sets, writes the stored pictures instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "gpu/device_fixture.h"
#include "measure/compare_images.h"
#include "promin/image.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"
#include "shared/layout.h"
#include "trace/render/make_renderer.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = PROMIN_SCENES_DIR;
const fs::path kGoldens = PROMIN_GOLDENS_DIR;

constexpr CompareOptions kTolerance = {.fail = 0.004F, .fail_percent = 0.02, .hard_fail = 0.012F, .edge_percent = 0.5};

/// Returns an empty text if the picture equals the golden one; otherwise the difference.
std::string compare_with_golden(const Image& picture, const Image& golden) {
  const ImageDifference difference = compare_images(picture, golden, kTolerance);
  return difference.is_equal ? "" : difference.summary();
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kScenes)) {
    const std::string ending = entry.path().extension().string();
    const bool is_scene = ending == ".gltf" || ending == ".obj" || ending == ".ply" || ending == ".stl";
    if (is_scene) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct Subject {
  world::Scene scene;
  View view;
};

Subject load_subject(const std::string& name) {
  Subject subject;
  subject.scene = world::flatten(load_scene(kScenes / name));
  subject.view.size = uvec2(160, 90);
  subject.view.camera =
      subject.scene.cameras.empty() ? look_from_front(subject.scene, 16.0F / 9.0F) : subject.scene.cameras[0];
  if (subject.scene.lights.empty()) subject.scene.lights = {make_headlight()};
  return subject;
}

class GoldenTest : public test::DeviceTest {
 protected:
  /// The device uses packets, as it does for users.
  static void SetUpTestSuite() { open({}); }

  static Image render(const Subject& subject) {
    return make_renderer(device(), subject.scene).render(subject.view).image;
  }
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
  write_difference_image(difference, picture, golden, 4.0F);
  FAIL() << problem << "; the difference, fourfold, is " << difference;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneGoldenTest, testing::ValuesIn(scene_names()), [](const auto& param_info) {
  std::string name = param_info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

// These are negative controls: if one of these comparisons passes, the comparison above proves nothing.

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
  View view = subject.view;
  view.mode.has_shadows = false;
  EXPECT_NE(compare_changed(make_renderer(device(), subject.scene).render(view).image), "");
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
