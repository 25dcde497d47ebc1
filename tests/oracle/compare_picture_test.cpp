// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/compare_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace promin::oracle {
namespace {

using testing::HasSubstr;

/// A simulated picture of a device: the oracle's picture, rounded to fp32.
struct DevicePicture {
  Image image;
  std::vector<float> depth;
  std::vector<vec3> normal;
  std::vector<uint32_t> object;
  std::vector<uint32_t> primitive;

  explicit DevicePicture(const Picture& picture) {
    image.size = picture.size;
    for (const Pixel& pixel : picture.pixels) {
      image.pixels.emplace_back(pixel.color);
      depth.push_back(static_cast<float>(pixel.depth()));
      normal.emplace_back(pixel.hit.normal);
      object.push_back(static_cast<uint32_t>(pixel.hit.object));
      primitive.push_back(static_cast<uint32_t>(pixel.hit.primitive));
    }
  }
  DeviceAovs aovs() const { return {depth, normal, object, primitive}; }
};

/// Returns a ball, a can and a sheet on a mirroring floor.
world::Scene make_small_scene() {
  world::Scene scene;
  scene.environment.ambient = vec3(0.1F);
  scene.environment.background = vec3(0.2F, 0.4F, 0.6F);
  scene.materials.resize(2);
  scene.materials[1].phong().reflection = vec3(0.5F);
  Mesh sheet;
  sheet.positions = {{-3, 0, -1}, {-1, 0, -1}, {-1, 2, -1}, {-3, 2, -1}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.objects = {{"floor", world::Plane{}, 1},
                   {"ball", world::Sphere{{0, 1, 0}, 1}, 0},
                   {"can", world::Cylinder{{2, 0.5F, 1}, {0, 1, 0}, 0.5F, 0.5F}, 0},
                   {"sheet", sheet, 0}};
  scene.lights.resize(2);
  scene.lights[0].position = vec3(3, 6, 5);
  scene.lights[0].diffuse = vec3(0.6F);
  scene.lights[1].kind = LightKind::kDirectional;
  scene.lights[1].direction = glm::normalize(vec3(1, -1, -1));
  scene.lights[1].diffuse = vec3(0.3F);
  return scene;
}

View look_at_scene() {
  View view;
  view.size = uvec2(80, 50);
  view.camera.eye = vec3(0, 2, 8);
  view.camera.look = glm::normalize(vec3(0, -0.125F, -1));
  view.camera.up = glm::normalize(vec3(0, 1, -0.125F));
  view.max_depth = 2;
  return view;
}

/// Returns the same scene with all objects of smooth metal.
world::Scene make_shiny_scene(float roughness) {
  world::Scene scene = make_small_scene();
  for (Material& material : scene.materials) material.model = MetallicRoughness{.roughness = roughness};
  return scene;
}

class ComparePictureTest : public testing::Test {
 protected:
  PictureReport compare(const DevicePicture& device) const {
    return compare_picture(scene, picture, device.image, device.aovs());
  }
  void expect_failure(const DevicePicture& device) const {
    const PictureReport report = compare(device);
    EXPECT_FALSE(report.passes()) << report.summary(scene);
  }
  /// Returns the lowest pixel of an object. Points of the floor at the horizon are so far away that rounding may move
  /// them considerably.
  size_t find_pixel_of(int32_t object) const {
    size_t i = picture.pixels.size() - 1;
    while (picture.pixels[i].hit.object != object) --i;
    return i;
  }

  const world::Scene scene = make_small_scene();
  const View view = look_at_scene();
  const Picture picture = render(scene, view);
  const DevicePicture rounded{picture};
};

TEST_F(ComparePictureTest, TheRoundedPicturePasses) {
  const PictureReport report = compare(rounded);
  EXPECT_TRUE(report.passes()) << report.summary(scene);
  EXPECT_TRUE(report.has_mirrors);
  EXPECT_EQ(report.pixel_count, 4000U);
  EXPECT_TRUE(report.id_mismatches.empty());
  EXPECT_TRUE(report.normals_at_creases.empty());
  EXPECT_LE(report.largest_depth_error, 1);
  EXPECT_GT(report.largest_depth_error, 0);
  EXPECT_LE(report.largest_normal_error, 1);
  EXPECT_LE(report.color_mean, 1e-7L);
  EXPECT_THAT(report.summary(scene), HasSubstr("passes: 4000 pixels"));
}

TEST_F(ComparePictureTest, ColoursAloneCanBeCompared) {
  EXPECT_TRUE(compare_picture(scene, picture, rounded.image, {}).passes());
  DevicePicture dark = rounded;
  for (vec3& color : dark.image.pixels) color *= 0.9F;
  EXPECT_FALSE(compare_picture(scene, picture, dark.image, {}).passes());
}

// The sun's direction first differs by the rounding of a normal, and then by more.
TEST_F(ComparePictureTest, HighlightsMayMoveByARoundingAndNoFarther) {
  const world::Scene shiny = make_shiny_scene(0.1F);
  const Picture expected = render(shiny, view);
  const auto compare_moved = [&](float angle) {
    world::Scene moved = shiny;
    moved.lights[1].direction = glm::normalize(moved.lights[1].direction + angle * vec3(1, 1, 0));
    DevicePicture device(render(moved, view));
    return compare_picture(shiny, expected, device.image, {});
  };
  EXPECT_TRUE(compare_moved(2e-7F).passes()) << compare_moved(2e-7F).summary(shiny);
  EXPECT_FALSE(compare_moved(1e-3F).passes());
  const world::Scene duller = make_shiny_scene(0.102F);
  EXPECT_FALSE(compare_picture(shiny, expected, DevicePicture(render(duller, view)).image, {}).passes());
  EXPECT_TRUE(compare_picture(shiny, expected, DevicePicture(expected).image, {}).has_mirrors);
}

TEST_F(ComparePictureTest, AHalfPixelShiftFails) {
  View shifted = view;
  const float pixel = 2 * std::tan(0.5F * view.camera.yfov) / static_cast<float>(view.size.y);
  shifted.camera.look += 0.5F * pixel * glm::cross(view.camera.look, view.camera.up);
  const DevicePicture device(render(scene, shifted));
  expect_failure(device);
  const PictureReport report = compare(device);
  EXPECT_GT(report.id_mismatches.size(), 20U);
  EXPECT_FALSE(compare_picture(scene, picture, device.image, {}).passes());
}

TEST_F(ComparePictureTest, AMissingShadowFails) {
  world::Scene without_ball = scene;
  without_ball.objects[1].shape = world::NotDrawn{};
  const Picture bare = render(without_ball, view);
  DevicePicture device = rounded;
  for (size_t i = 0; i < bare.pixels.size(); ++i) {
    if (picture.pixels[i].hit.object == 0) device.image.pixels[i] = vec3(bare.pixels[i].color);
  }
  expect_failure(device);
  EXPECT_GT(compare(device).color_errors.size(), 20U);
}

TEST_F(ComparePictureTest, ABounceLessFails) {
  View shallow = view;
  --shallow.max_depth;
  // Only the floor reflects, so the second bounce adds nothing.
  EXPECT_TRUE(compare(DevicePicture(render(scene, shallow))).passes());
  --shallow.max_depth;
  expect_failure(DevicePicture(render(scene, shallow)));
}

TEST_F(ComparePictureTest, ALightThatIsOffFails) {
  for (size_t i = 0; i < 2; ++i) {
    world::Scene dim = scene;
    dim.lights.erase(dim.lights.begin() + static_cast<std::ptrdiff_t>(i));
    expect_failure(DevicePicture(render(dim, view)));
  }
}

TEST_F(ComparePictureTest, ASmallErrorOfEveryColourFails) {
  DevicePicture device = rounded;
  for (vec3& color : device.image.pixels) color += 2e-4F;
  expect_failure(device);
  EXPECT_TRUE(compare(device).color_errors.empty());
}

TEST_F(ComparePictureTest, AShareOfColoursMayDiffer) {
  DevicePicture device = rounded;
  for (size_t i = 0; i < 20; ++i) device.image.pixels[100 * i].y += 0.03F;
  EXPECT_TRUE(compare(device).passes()) << "20 of 4000 are 0.5 %";
  device.image.pixels[7].x -= 0.03F;
  expect_failure(device);
  EXPECT_EQ(compare(device).color_errors.size(), 21U);
}

TEST_F(ComparePictureTest, AFewLargeErrorsOfColourCountInTheMean) {
  DevicePicture device = rounded;
  for (size_t i = 0; i < 2; ++i) device.image.pixels[100 * i].y += 0.5F;
  EXPECT_TRUE(compare(device).passes());
  device.image.pixels[7].x += 0.5F;
  expect_failure(device);
  EXPECT_NEAR(static_cast<double>(compare(device).color_mean), 1.5 / (3 * 4000), 1e-7);
}

TEST_F(ComparePictureTest, WhatMapsExplainIsNoErrorButCountsInThePlainMean) {
  Picture expected = picture;
  for (Pixel& pixel : expected.pixels) pixel.map_error = 0.1L;
  DevicePicture device = rounded;
  for (vec3& color : device.image.pixels) color += 0.05F;
  const auto compare_with = [&](Real plain_mean) {
    return compare_picture(scene, expected, device.image, {}, {.plain_mean = plain_mean});
  };
  EXPECT_TRUE(compare_with(0.051L).passes());
  EXPECT_FALSE(compare_with(0.049L).passes());
  EXPECT_NEAR(compare_with(1).plain_mean, 0.05L, 1e-6L);
  EXPECT_NEAR(compare_with(1).plain_largest, 0.05L, 1e-6L);
}

TEST_F(ComparePictureTest, AFewPixelsMayBeUnsure) {
  Picture expected = picture;
  const auto compare_with = [&] { return compare_picture(scene, expected, rounded.image, {}); };
  for (size_t i = 0; i < 20; ++i) expected.pixels[100 * i].explained_error = 0.03L;
  EXPECT_TRUE(compare_with().passes()) << "20 of 4000 are 0.5 %";
  EXPECT_EQ(compare_with().unsure_count, 20U);
  expected.pixels[7].explained_error = 0.03L;
  EXPECT_FALSE(compare_with().passes());
}

TEST_F(ComparePictureTest, WhereAMaskEndsEitherHitIsRight) {
  Picture expected = picture;
  DevicePicture device = rounded;
  const size_t hit = find_pixel_of(1);
  device.object[hit] = 2;
  EXPECT_FALSE(compare_picture(scene, expected, device.image, device.aovs()).passes());
  expected.pixels[hit].is_at_cutoff = true;
  EXPECT_TRUE(compare_picture(scene, expected, device.image, device.aovs()).passes());
}

TEST_F(ComparePictureTest, WhatIsNotFiniteFails) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const size_t hit = find_pixel_of(1);
  const size_t miss = find_pixel_of(-1);
  for (int i = 0; i < 6; ++i) {
    DevicePicture device = rounded;
    if (i == 0) device.image.pixels[miss].z = nan;
    if (i == 1) device.image.pixels[hit].x = infinity;
    if (i == 2) device.normal[hit].y = nan;
    if (i == 3) device.depth[hit] = infinity;
    if (i == 4) device.depth[miss] = nan;
    if (i == 5) device.depth[miss] = 1000;
    expect_failure(device);
    EXPECT_EQ(compare(device).non_finite.size(), 1U) << i;
  }
}

TEST_F(ComparePictureTest, AnotherObjectIsListedWithItsMargin) {
  DevicePicture device = rounded;
  const size_t at = find_pixel_of(1);
  device.object[at] = 2;
  const PictureReport report = compare(device);
  EXPECT_FALSE(report.passes());
  ASSERT_EQ(report.id_mismatches.size(), 1U);
  EXPECT_GT(report.id_mismatches[0].margin, 1000);
  const std::string pixel = "pixel (" + std::to_string(at % 80) + ", " + std::to_string(at / 80) + ")";
  EXPECT_THAT(report.summary(scene),
              HasSubstr(pixel + ": object 2 'can' primitive 0, not object 1 'ball' primitive 0; margin"));
  device.object[at] = kNoObject;
  device.depth[at] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(compare(device).summary(scene), HasSubstr("a miss, not object 1 'ball' primitive 0"));
  device = rounded;
  device.primitive[find_pixel_of(3)] ^= 1U;
  expect_failure(device);
}

TEST_F(ComparePictureTest, ErrorsOfDepthFail) {
  for (const int32_t object : {0, 1, 2, 3}) {
    DevicePicture device = rounded;
    device.depth[find_pixel_of(object)] *= 1.0001F;
    expect_failure(device);
    EXPECT_EQ(compare(device).depth_errors.size(), 1U);
  }
}

TEST_F(ComparePictureTest, ErrorsOfNormalsFail) {
  for (const int32_t object : {0, 1, 2, 3}) {
    DevicePicture device = rounded;
    vec3& normal = device.normal[find_pixel_of(object)];
    normal = -normal;
    expect_failure(device);
    normal = -normal + vec3(2e-4F, 0, 0);
    expect_failure(device);
    EXPECT_EQ(compare(device).normal_errors.size(), 1U);
  }
}

/// Returns a can in front of a wall.
world::Scene make_can() {
  world::Scene scene;
  scene.materials.resize(1);
  scene.objects = {{"can", world::Cylinder{{0, 0, 0}, {0, 1, 0}, 1, 1}, 0},
                   {"wall", world::Plane{{0, 0, 4}, {0, 0, 1}}, 0}};
  return scene;
}

/// Returns a picture of 2000 pixels: the first `count` look along this ray, and the others see nothing.
Picture make_picture_of(const world::Scene& scene, const Ray& ray, size_t count) {
  Picture picture;
  picture.size = uvec2(2000, 1);
  picture.pixels.resize(2000);
  std::fill_n(picture.pixels.begin(), count, Pixel{ray, find_nearest_hit(scene, ray), Vector(0)});
  return picture;
}

TEST(ComparePicture, AtARimEitherNormalIsRightInAFewPixels) {
  const world::Scene scene = make_can();
  const auto compare_below_rim = [&](Real units, size_t count) {
    const Real offset = units * kRoundoff * (std::sqrt(Real(8)) + std::sqrt(Real(2)));
    // The ray hits the side just below the rim, but the device reports the disk.
    const Ray ray{Vector(0, 2, 2) - offset * glm::normalize(Vector(0, 1, -1)), {0, -1, -1}};
    const Picture picture = make_picture_of(scene, ray, count);
    DevicePicture device(picture);
    EXPECT_EQ(device.normal[0], vec3(0, 0, 1));
    std::fill_n(device.normal.begin(), count, vec3(0, 1, 0));
    return compare_picture(scene, picture, device.image, device.aovs());
  };
  EXPECT_TRUE(compare_below_rim(2, 1).passes());
  EXPECT_EQ(compare_below_rim(2, 1).normals_at_creases.size(), 1U);
  EXPECT_FALSE(compare_below_rim(2, 2).passes());
  EXPECT_FALSE(compare_below_rim(10, 1).passes());
}

TEST(ComparePicture, AtASilhouetteEitherObjectIsRightInAFewPixels) {
  const world::Scene scene = make_can();
  const auto compare_past_rim = [&](Real units, size_t count) {
    const Real offset = units * kRoundoff * (std::sqrt(Real(10)) + std::sqrt(Real(2)));
    // The ray passes the rim from behind and hits the wall, but the device reports the can.
    const Ray ray{Vector(0, 3, -1) + offset * glm::normalize(Vector(0, 1, 1)), {0, -1, 1}};
    const Picture picture = make_picture_of(scene, ray, count);
    EXPECT_EQ(picture.pixels[0].hit.object, 1);
    DevicePicture device(picture);
    for (size_t i = 0; i < count; ++i) {
      device.object[i] = 0;
      device.depth[i] = std::sqrt(8.0F);
    }
    return compare_picture(scene, picture, device.image, device.aovs());
  };
  EXPECT_TRUE(compare_past_rim(2, 1).passes()) << compare_past_rim(2, 1).summary(scene);
  EXPECT_EQ(compare_past_rim(2, 1).id_mismatches.size(), 1U);
  EXPECT_FALSE(compare_past_rim(2, 2).passes());
  EXPECT_FALSE(compare_past_rim(10, 1).passes());
}

TEST(ComparePicture, SizesMustMatch) {
  Picture picture;
  picture.size = uvec2(2, 1);
  picture.pixels.resize(2);
  DevicePicture device(picture);
  device.depth.pop_back();
  EXPECT_THROW(compare_picture(world::Scene(), picture, device.image, device.aovs()), std::invalid_argument);
  device.image.size = uvec2(1, 2);
  EXPECT_THROW(compare_picture(world::Scene(), picture, device.image, {}), std::invalid_argument);
}

}  // namespace
}  // namespace promin::oracle
