// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/view_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <cmath>

#include "core/rounding.h"
#include "options/arguments.h"
#include "options/pose_options.h"
#include "options/render_options.h"
#include "output/console.h"
#include "promin/error.h"
#include "support/problems.h"
#include "work/pictures/camera_choice.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace {

using testing::HasSubstr;

const Console kSilent(Verbosity::kQuiet);

Scene make_viewed_scene() {
  Scene scene;
  scene.file = "test.gltf";
  Camera main;
  main.name = "main";
  main.eye = vec3(0.0F, 0.0F, 5.0F);
  Camera side;
  side.name = "side";
  side.eye = vec3(5.0F, 0.0F, 0.0F);
  side.look = vec3(-1.0F, 0.0F, 0.0F);
  side.aspect_ratio = 2.0F;
  side.near = 0.5F;
  scene.cameras = {main, side};
  return scene;
}

TEST(ViewSetupTest, TheFirstCameraIsTheDefaultAndOthersGoByNameOrNumber) {
  const Scene scene = make_viewed_scene();
  ViewOptions options;
  EXPECT_EQ(make_view(scene, options, kSilent).camera.name, "main");
  options.camera = "side";
  EXPECT_EQ(make_view(scene, options, kSilent).camera.name, "side");
  options.camera = "1";
  EXPECT_EQ(make_view(scene, options, kSilent).camera.name, "side");
}

TEST(ViewSetupTest, AnUnknownCameraListsThoseThereAre) {
  for (const char* selection : {"2", "-1", "1x", "Main", ""}) {
    ViewOptions options;
    options.camera = selection;
    try {
      make_view(make_viewed_scene(), options, kSilent);
      ADD_FAILURE() << "accepted " << selection;
    } catch (const UsageError& error) {
      EXPECT_THAT(list_problems(error), HasProblem("camera.unknown 0 (main), 1 (side)"));
    }
  }
}

TEST(ViewSetupTest, WidthFollowsTheCamerasAspectRatio) {
  ViewOptions options;
  EXPECT_EQ(make_view(make_viewed_scene(), options, kSilent).size, uvec2(1280, 720));
  options.camera = "side";
  EXPECT_EQ(make_view(make_viewed_scene(), options, kSilent).size, uvec2(1440, 720));
  options.size = uvec2(400, 100);
  const View view = make_view(make_viewed_scene(), options, kSilent);
  EXPECT_EQ(view.size, uvec2(400, 100));
  EXPECT_EQ(view.camera.yfov, make_viewed_scene().cameras[1].yfov) << "the vertical field of view holds";
}

TEST(ViewSetupTest, AResolutionOfTheFileIsTheDefault) {
  Scene scene = make_viewed_scene();
  scene.cameras[1].resolution = uvec2(321, 123);
  ViewOptions options;
  EXPECT_EQ(make_view(scene, options, kSilent).size, uvec2(1280, 720)) << "of another camera";
  options.camera = "side";
  EXPECT_EQ(make_view(scene, options, kSilent).size, uvec2(321, 123));
  options.size = uvec2(100, 50);
  EXPECT_EQ(make_view(scene, options, kSilent).size, uvec2(100, 50));
}

TEST(ViewSetupTest, AnAspectRatioWithoutAWidthIsRefused) {
  for (const float aspect_ratio : {1e-6F, 1e6F}) {
    Scene scene = make_viewed_scene();
    scene.cameras[0].aspect_ratio = aspect_ratio;
    EXPECT_THROW(make_view(scene, {}, kSilent), UsageError);
  }
}

TEST(ViewSetupTest, AnOrthonormalPoseIsUsedAsItIs) {
  ViewOptions options;
  options.pose.eye = dvec3(1.0, 2.0, 3.0);
  options.pose.direction = dvec3(0.0, 0.600000024, -0.800000012);
  options.pose.up = dvec3(0.0, 0.800000012, 0.600000024);
  options.pose.fov_deg = 90.0;
  options.pose.near = 0.25;
  const Camera camera = make_view(make_viewed_scene(), options, kSilent).camera;
  EXPECT_EQ(camera.eye, vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(camera.look, vec3(0.0F, 0.6F, -0.8F));
  EXPECT_EQ(camera.up, vec3(0.0F, 0.8F, 0.6F));
  EXPECT_FLOAT_EQ(camera.yfov, 1.57079633F);
  EXPECT_EQ(camera.near, 0.25F);
}

TEST(ViewSetupTest, AFieldOfViewMakesAnOrthographicCameraPerspectiveAndSaysSo) {
  Scene scene = make_viewed_scene();
  scene.cameras[0].projection = Projection::kOrthographic;
  ViewOptions options;
  const auto say_and_view = [&] {
    testing::internal::CaptureStderr();
    const View view = make_view(scene, options, Console(Verbosity::kNormal));
    return std::pair(testing::internal::GetCapturedStderr(), view.camera.projection);
  };
  EXPECT_EQ(say_and_view(), std::pair(std::string(), Projection::kOrthographic));
  options.pose.fov_deg = 40.0;
  const std::string note = "promin: note: the camera is orthographic; --fov makes it perspective\n";
  EXPECT_EQ(say_and_view(), std::pair(note, Projection::kPerspective));
  options.camera = "side";
  EXPECT_EQ(say_and_view(), std::pair(std::string(), Projection::kPerspective));

  // A camera that the user specifies takes no values from the scene's cameras.
  options.camera = "main";
  options.pose.eye = dvec3(0.0);
  options.pose.direction = dvec3(0.0, 0.0, -1.0);
  EXPECT_EQ(say_and_view(), std::pair(std::string(), Projection::kPerspective));
}

TEST(ViewSetupTest, OtherDirectionsAreMadeOrthonormal) {
  ViewOptions options;
  options.pose.direction = dvec3(3e14, 0.0, -4e14);
  options.pose.up = dvec3(0.2, 1e-3, 0.1);
  const Camera camera = make_view(make_viewed_scene(), options, kSilent).camera;
  EXPECT_EQ(camera.look, vec3(0.6F, 0.0F, -0.8F));
  EXPECT_NEAR(glm::length(camera.up), 1.0F, 2.0F * kUnitRoundoff);
  EXPECT_NEAR(glm::dot(camera.look, camera.up), 0.0F, 2.0F * kUnitRoundoff);
  EXPECT_GT(glm::dot(camera.up, vec3(0.2F, 1e-3F, 0.1F)), 0.0F);
}

TEST(ViewSetupTest, ADirectionAloneStandsUpright) {
  ViewOptions options;
  options.pose.direction = dvec3(1.0, -1.0, 0.0);
  const Camera camera = make_view(make_viewed_scene(), options, kSilent).camera;
  EXPECT_NEAR(camera.up.x, std::sqrt(0.5F), 1e-6F);
  EXPECT_NEAR(camera.up.y, std::sqrt(0.5F), 1e-6F);
  EXPECT_EQ(camera.eye, make_viewed_scene().cameras[0].eye) << "what is not given stays the camera's";
}

TEST(ViewSetupTest, DirectionsThatDoNotSayWhichWayIsUpAreRefused) {
  const std::pair<dvec3, dvec3> bad[] = {{dvec3(0.0, 1.0, 0.0), dvec3(0.0, 1.0, 0.0)},
                                         {dvec3(0.0, 0.0, -1.0), dvec3(0.0, 0.0, 2.0)},
                                         {dvec3(0.0), dvec3(0.0, 1.0, 0.0)},
                                         {dvec3(1.0, 0.0, 0.0), dvec3(0.0)},
                                         {dvec3(1.0, 0.0, 0.0), dvec3(1.0, 1e-9, 0.0)}};
  for (const auto& [look, up] : bad) {
    ViewOptions options;
    options.pose.direction = look;
    options.pose.up = up;
    EXPECT_THROW(make_view(make_viewed_scene(), options, kSilent), UsageError);
  }
}

TEST(ViewSetupTest, ACropLiesWithinThePicture) {
  ViewOptions options;
  options.size = uvec2(64, 32);
  options.crop = PixelWindow{{0, 0}, {64, 32}};
  EXPECT_NO_THROW(make_view(make_viewed_scene(), options, kSilent));
  options.crop = PixelWindow{{0, 0}, {65, 32}};
  EXPECT_THROW(make_view(make_viewed_scene(), options, kSilent), UsageError);
  options.crop = PixelWindow{{0, 0}, {64, 33}};
  EXPECT_THROW(make_view(make_viewed_scene(), options, kSilent), UsageError);
}

TEST(ViewSetupTest, LightsToLeaveOutAreNamedOnce) {
  CLI::App program;
  OptionTable table(program);
  ViewOptions options;
  add_view_options(table, options);
  program.parse("--lights-off 2,0,2,0");
  EXPECT_EQ(options.lights_off, (std::vector<uint32_t>{0, 2}));
}

TEST(PoseOptionsTest, UpIsAnAxisByItsNameOrADirection) {
  const auto up_of = [](std::vector<const char*> words) {
    CLI::App program;
    OptionTable table(program);
    PoseOptions pose;
    add_pose_options(table, pose);
    words.insert(words.begin(), "promin");
    parse_arguments(program, static_cast<int>(words.size()), words.data());
    EXPECT_EQ(pose.zoom, 2.0);
    return pose.up;
  };
  EXPECT_EQ(up_of({"--up", "z", "--zoom", "2"}), dvec3(0, 0, 1));
  EXPECT_EQ(up_of({"--zoom", "2", "--up", "-x"}), dvec3(-1, 0, 0));
  EXPECT_EQ(up_of({"--up=-y", "--zoom", "2"}), dvec3(0, -1, 0));
  EXPECT_EQ(up_of({"--up", "0", "-2", "1", "--zoom", "2"}), dvec3(0, -2, 1));
}

TEST(LightUpTest, OnlyAClassicSceneWithoutLightsGetsAHeadlight) {
  Scene scene = make_viewed_scene();
  scene.is_classic = true;
  light_up(scene, {});
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kHeadlight);
  EXPECT_EQ(scene.environment.ambient, vec3(0.1F));

  light_up(scene, {});
  EXPECT_EQ(scene.lights.size(), 1U);

  Scene ambient = make_viewed_scene();
  ambient.is_classic = true;
  ambient.environment.ambient = vec3(0.5F);
  light_up(ambient, {});
  EXPECT_EQ(ambient.lights.size(), 1U);
  EXPECT_EQ(ambient.environment.ambient, vec3(0.5F)) << "the file's ambient light stays";

  Scene other = make_viewed_scene();
  EXPECT_TRUE(light_up(other, {}).has_studio_light);
  EXPECT_EQ(other.lights[0].kind, LightKind::kDirectional);
}

Scene make_ball() {
  Scene scene;
  scene.add("ball", Sphere{.center = dvec3(1.0, 2.0, 3.0)});
  return scene;
}

Scene make_viewed_ball() {
  Scene scene = make_viewed_scene();
  scene.add("ball", Sphere{.center = dvec3(1.0, 2.0, 3.0)});
  return scene;
}

TEST(LightUpTest, SoftLightHasAGroundAndTheIntegratorDirect) {
  const auto is_of_ground = [](const Object& object) { return object.name == "ground"; };
  Scene scene = make_viewed_ball();
  const Bounds bounds = bounds_of(scene);
  const size_t materials = scene.materials.size();
  light_up(scene, {.light = LightChoice::kSoft});
  ASSERT_TRUE(is_of_ground(scene.objects.back()));
  ASSERT_EQ(scene.materials.size(), materials + 1);
  const auto& catcher = std::get<Unlit>(scene.materials.back().model);
  EXPECT_TRUE(catcher.catches_shadows);
  EXPECT_GT(catcher.color.x, 0.5F);
  const auto& plane = std::get<Plane>(scene.geometries[scene.objects.back().geometry]);
  EXPECT_LE(plane.point.y, bounds.lo.y);
  EXPECT_NEAR(plane.point.y, bounds.lo.y, 1e-3F * glm::length(bounds.hi - bounds.lo));
  EXPECT_TRUE(validate(scene).empty());

  Scene without = make_viewed_ball();
  light_up(without, {.light = LightChoice::kSoft, .has_ground = false});
  EXPECT_FALSE(is_of_ground(without.objects.back()));
  Scene hard = make_viewed_ball();
  light_up(hard, {.has_ground = true});
  EXPECT_TRUE(is_of_ground(hard.objects.back()));
  Scene dark = make_viewed_ball();
  light_up(dark, {.light = LightChoice::kNone, .has_ground = true});
  EXPECT_FALSE(is_of_ground(dark.objects.back())) << "no light makes no shadow";

  ViewOptions options;
  EXPECT_EQ(mode_of(dark, options).integrator, Integrator::kWhitted);
  options.look.light = LightChoice::kSoft;
  EXPECT_EQ(mode_of(dark, options).integrator, Integrator::kDirect);
  options.integrator = Integrator::kWhitted;
  EXPECT_EQ(mode_of(dark, options).integrator, Integrator::kWhitted);
}

TEST(LightUpTest, LightAndGroundStandOnTheScenesUp) {
  const auto plane_of = [](const Scene& scene) {
    return std::get<Plane>(scene.geometries[scene.objects.back().geometry]);
  };
  Scene standing = make_viewed_ball();
  Scene lying = make_viewed_ball();
  Scene slanted = make_viewed_ball();
  const vec3 z(0.0F, 0.0F, 1.0F);
  light_up(standing, {.light = LightChoice::kSoft});
  light_up(lying, {.light = LightChoice::kSoft}, {}, z);
  light_up(slanted, {.light = LightChoice::kSoft}, {}, vec3(0.6F, 0.0F, 0.8F));
  EXPECT_EQ(vec3(plane_of(lying).normal), z);
  // The ball of radius 0.5 lies at (1, 2, 3).
  EXPECT_NEAR(plane_of(standing).point.y, 1.5, 1e-3);
  EXPECT_NEAR(plane_of(lying).point.z, 2.5, 1e-3);
  EXPECT_NEAR(glm::dot(plane_of(slanted).point, plane_of(slanted).normal), 2.5, 1e-3);
  EXPECT_TRUE(validate(slanted).empty());
}

TEST(UpwardDirectionTest, ItIsThatOfFramedScenes) {
  ViewOptions options;
  const Scene without_camera = make_ball();
  EXPECT_FALSE(upward_direction(without_camera, options));
  options.pose.up = dvec3(0.0, 0.0, 2.0);
  EXPECT_EQ(upward_direction(without_camera, options), vec3(0.0F, 0.0F, 1.0F));
  EXPECT_FALSE(upward_direction(make_viewed_ball(), options)) << "the camera of the file is rolled";
  options.pose.from = Framing::kFront;
  EXPECT_TRUE(upward_direction(make_viewed_ball(), options));
  options.pose.eye = dvec3(5.0);
  EXPECT_FALSE(upward_direction(without_camera, options)) << "the picture's own direction";
}

TEST(LightUpTest, TheBackgroundIsTheUsers) {
  const BackgroundChoice environment{.is_environment = true};
  Scene scene = make_viewed_scene();
  const BackgroundChoice linear{.is_linear = true, .color = vec3(0.0F, 0.5F, 1.0F)};
  const AssumedLight assumed = light_up(scene, {.background = linear});
  EXPECT_FALSE(assumed.has_background);
  EXPECT_EQ(scene.environment.background, vec3(0.0F, 0.5F, 1.0F));
  EXPECT_FALSE(scene.environment.backdrop);
  EXPECT_FALSE(scene.environment.shows_sky);

  Scene before_color = make_viewed_scene();
  light_up(before_color, {.background = BackgroundChoice{.color = vec3(0.0F, 0.04045F, 1.0F)}});
  const vec3 light(0.0F, 0.04045F / 12.92F, 1.0F);
  EXPECT_EQ(before_color.environment.backdrop, (Backdrop{light, light})) << "as it is shown";
  EXPECT_EQ(before_color.environment.background, light);

  Scene studio = make_viewed_scene();
  light_up(studio, {.background = environment});
  EXPECT_TRUE(studio.environment.shows_sky);

  // Without a sky, the environment is ambient light.
  Scene ambient = make_viewed_scene();
  light_up(ambient, {.light = LightChoice::kHeadlight, .background = environment});
  EXPECT_FALSE(ambient.environment.shows_sky);
  EXPECT_EQ(ambient.environment.background, vec3(0.1F));

  // With another background, the sky of the file is no longer visible.
  Scene sky = make_viewed_scene();
  sky.environment.sky = GradientSky{};
  sky.environment.shows_sky = true;
  light_up(sky, {});
  EXPECT_TRUE(sky.environment.shows_sky);
  light_up(sky, {.background = BackgroundChoice{}});
  EXPECT_FALSE(sky.environment.shows_sky);
}

TEST(ChooseDisplayTest, OptionsComeBeforeTheScene) {
  Scene scene = make_viewed_scene();
  Light lamp;
  lamp.kind = LightKind::kDirectional;
  lamp.diffuse = vec3(201.0F);
  scene.lights = {lamp};
  EXPECT_EQ(choose_display(scene, {}, DebugView::kNone), (DisplayTransform{-6.0F, ToneMapping::kNeutral}));
  EXPECT_EQ(choose_display(scene, {.exposure_ev = 1.0F, .tone_mapping = ToneMapping::kAces}, DebugView::kNone),
            (DisplayTransform{1.0F, ToneMapping::kAces}));
  EXPECT_EQ(choose_display(scene, {.exposure_ev = 1.0F}, DebugView::kNormals), DisplayTransform())
      << "a debug view shows no light";
  scene.is_classic = true;
  EXPECT_EQ(choose_display(scene, {}, DebugView::kNone), DisplayTransform());
  EXPECT_EQ(choose_display(scene, {.tone_mapping = ToneMapping::kNeutral}, DebugView::kNone),
            (DisplayTransform{0.0F, ToneMapping::kNeutral}));
}

/// Returns the notes on a scene for a picture that is displayed.
std::string assumptions_of(Scene scene, const ViewOptions& options) {
  const AssumedLight assumed = light_up(scene, options.look);
  const Integrator integrator = mode_of(scene, options).integrator;
  return describe_assumptions(scene, options, assumed, integrator,
                              choose_display(scene, options.look, DebugView::kNone));
}

TEST(DescribeAssumptionsTest, OneSentenceTellsAll) {
  Scene scene;
  EXPECT_EQ(assumptions_of(scene, {}),
            "assumed: a camera that frames the scene from three quarters, the light of a studio, a grey background, "
            "tone mapping neutral");
  scene.is_classic = true;
  EXPECT_EQ(assumptions_of(scene, {}),
            "assumed: a camera that frames the scene from three quarters, a headlight along the view and ambient light "
            "of 0.1");
  scene.environment.ambient = vec3(0.2F);
  EXPECT_EQ(assumptions_of(scene, {}),
            "assumed: a camera that frames the scene from three quarters, a headlight along the view");
  scene.lights = {make_headlight()};
  scene.cameras = {Camera()};
  EXPECT_EQ(assumptions_of(scene, {}), "");

  scene.is_classic = false;
  scene.environment.ambient = vec3(0.0F);
  scene.lights[0].diffuse = vec3(201.0F);
  EXPECT_EQ(assumptions_of(scene, {}),
            "assumed: weak studio light in addition to the scene's own, a grey background, an exposure of -6 EV, tone "
            "mapping neutral");
}

TEST(DescribeAssumptionsTest, TheCameraIsNamedAsItLooks) {
  Mesh board;
  board.positions = {vec3(0.0F), vec3(4.0F, 0.0F, 0.0F), vec3(0.0F, 4.0F, 0.5F)};
  board.triangles = {uvec3(0, 1, 2)};
  Scene scene;
  scene.materials.emplace_back();
  scene.add("board", board);
  EXPECT_THAT(assumptions_of(scene, {}),
              HasSubstr("a camera that frames the scene from the front, because it is flat"));
  scene.cameras = {Camera(), Camera()};
  EXPECT_THAT(assumptions_of(scene, {}), HasSubstr("assumed: the first of the file's 2 cameras"));
  ViewOptions second;
  second.camera = "1";
  EXPECT_THAT(assumptions_of(scene, second), Not(HasSubstr("camera")));
}

TEST(DescribeAssumptionsTest, WhatTheUserSaysIsNotAssumed) {
  ViewOptions options;
  options.look = {.light = LightChoice::kHeadlight,
                  .background = BackgroundChoice{},
                  .exposure_ev = 3.0F,
                  .tone_mapping = ToneMapping::kNeutral};
  options.pose.from = Framing::kFront;
  EXPECT_EQ(assumptions_of(Scene(), options), "");
  options.pose.from.reset();
  options.pose.eye = dvec3(0.0, 0.0, 1.0);
  EXPECT_EQ(assumptions_of(Scene(), options), "");
  // If no picture is displayed, the notes do not mention the display.
  Scene scene;
  scene.cameras = {Camera()};
  const AssumedLight assumed = light_up(scene, {});
  EXPECT_EQ(describe_assumptions(scene, {}, assumed, Integrator::kWhitted, std::nullopt),
            "assumed: the light of a studio, a grey background");
}

/// Returns a ball at (1, 2, 3), in a file that has no camera.

Camera camera_of(const Scene& scene, const PoseOptions& pose, const uvec2& size = uvec2(100)) {
  ViewOptions options;
  options.size = size;
  options.pose = pose;
  return make_view(scene, options, kSilent).camera;
}

void expect_looks_at(const Camera& camera, const dvec3& point) {
  const dvec3 direction = glm::normalize(point - dvec3(camera.eye));
  EXPECT_NEAR(glm::length(direction - dvec3(camera.look)), 0.0, 1e-6);
}

TEST(ViewSetupTest, TheFramingIsTheUsersOrTheScenes) {
  const Camera assumed = camera_of(make_ball(), {});
  EXPECT_NEAR(assumed.look.x, -0.478F, 1e-3F);
  EXPECT_EQ(camera_of(make_ball(), {.from = Framing::kFront}).look, vec3(0, 0, -1));
  Scene scene = make_ball();
  scene.cameras = make_viewed_scene().cameras;
  EXPECT_EQ(camera_of(scene, {}).eye, scene.cameras[0].eye);
  const Camera framed = camera_of(scene, {.from = Framing::kLeft});
  EXPECT_EQ(framed.look, vec3(1, 0, 0)) << "whatever cameras there are";
  const Camera turned = camera_of(scene, {.from = Framing::kFront, .orbit = {.azimuth_deg = -90.0}});
  EXPECT_NEAR(glm::length(turned.eye - framed.eye), 0.0F, 1e-5F);
}

TEST(ViewSetupTest, AFramedSceneIsFittedAnew) {
  const auto distance = [](const Camera& camera) { return glm::length(camera.eye - vec3(1, 2, 3)); };
  const auto slope = [](double degrees) { return std::sin(std::atan(0.85 * std::tan(glm::radians(0.5 * degrees)))); };
  EXPECT_NEAR(distance(camera_of(make_ball(), {})), 0.5 / slope(40.0), 1e-3);
  EXPECT_NEAR(distance(camera_of(make_ball(), {.orbit = {.elevation_deg = 40.0}})), 0.5 / slope(40.0), 1e-3);
  EXPECT_NEAR(distance(camera_of(make_ball(), {.fov_deg = 90.0})), 0.5 / slope(90.0), 1e-3);
  const Camera along = camera_of(make_ball(), {.direction = dvec3(0.0, -2.0, 0.0)});
  EXPECT_EQ(along.look, vec3(0, -1, 0));
  EXPECT_EQ(along.up, vec3(0, 0, -1)) << "the front at the lower edge";
  EXPECT_NEAR(distance(along), 0.5 / slope(40.0), 1e-3);
  EXPECT_EQ(camera_of(make_ball(), {.from = Framing::kFront, .up = dvec3(0, 0, 1)}).look, vec3(0, 1, 0));
}

TEST(ViewSetupTest, AnEyeLooksAtTheSceneOrAtAPoint) {
  Scene scene = make_ball();
  scene.center = dvec3(1e6, 0.0, 0.0);
  const dvec3 eye(1e6 + 5.0, 2.0, -7.0);
  const Camera alone = camera_of(scene, {.eye = eye});
  EXPECT_EQ(alone.eye, vec3(5, 2, -7));
  expect_looks_at(alone, dvec3(1, 2, 3));
  expect_looks_at(camera_of(scene, {.eye = eye, .look_at = dvec3(1e6, 0, 0)}), dvec3(0));
  EXPECT_EQ(camera_of(scene, {.eye = eye, .look_at = dvec3(1e6 + 5.0, -1, -7)}).look, vec3(0, -1, 0))
      << "straight down";
  expect_looks_at(camera_of(scene, {.look_at = dvec3(1e6, 0, 0)}), dvec3(0));
  EXPECT_THROW(camera_of(scene, {.eye = eye, .look_at = eye}), UsageError);
  EXPECT_THROW(camera_of(scene, {.eye = dvec3(1e6 + 1.0, 2.0, 3.0)}), UsageError);

  scene.cameras = make_viewed_scene().cameras;
  EXPECT_EQ(camera_of(scene, {.eye = eye}).look, vec3(0, 0, -1)) << "the camera's";
  expect_looks_at(camera_of(scene, {.look_at = dvec3(1e6 + 1.0, 0, 0)}), dvec3(1, 0, 0));
}

TEST(ViewSetupTest, ACameraOfTheFileIsTurnedAndZoomed) {
  Scene scene = make_ball();
  scene.cameras = make_viewed_scene().cameras;
  const Camera right = camera_of(scene, {.orbit = {.azimuth_deg = 90.0}});
  EXPECT_NEAR(glm::length(right.eye - vec3(2, 0, 3)), 0.0F, 1e-6F) << "around (0, 0, 3)";
  const Camera near = camera_of(scene, {.zoom = 2.0});
  EXPECT_NEAR(std::tan(0.5F * near.yfov), 0.5F * std::tan(0.35F), 1e-6F);
}

TEST(ViewSetupTest, AShareFramesTheSceneEvenIfItHasACamera) {
  Scene scene = make_ball();
  const Camera framed = camera_of(scene, {.fit = 0.5F});
  scene.cameras = make_viewed_scene().cameras;
  EXPECT_EQ(camera_of(scene, {.fit = 0.5F}).eye, framed.eye);
}

TEST(ViewSetupTest, ACameraOfTheFileThatShowsTheModelSmallIsSaid) {
  Scene scene = make_ball();
  const auto sentence_of = [&](const ViewOptions& options) {
    return describe_file_camera(scene, options, make_view(scene, options, kSilent));
  };
  EXPECT_EQ(sentence_of({}), "") << "promin frames it";
  Camera far;
  far.eye = vec3(1.0F, 2.0F, 23.0F);
  far.look = vec3(0.0F, 0.0F, -1.0F);
  far.up = vec3(0.0F, 1.0F, 0.0F);
  far.yfov = 2.0F * std::atan(0.5F);
  scene.cameras = {far};
  EXPECT_THAT(sentence_of({}),
              HasSubstr("the model covers only 5 % of the picture's side in the file's camera; --from three-quarter"))
      << "a ball of radius 1/2, its front 19.5 away";
  ViewOptions named;
  named.camera = "0";
  EXPECT_EQ(sentence_of(named), "") << "the user's choice";
  scene.cameras[0].eye.z = 5.0F;
  EXPECT_EQ(sentence_of({}), "");
  scene.cameras[0].eye.z = 4.25F;
  EXPECT_THAT(sentence_of({}), HasSubstr("the file's camera does not show the whole model"));
  EXPECT_EQ(sentence_of(named), "") << "the user's choice";
  scene.cameras[0].eye.z = 3.75F;
  EXPECT_EQ(sentence_of({}), "") << "a detail of the model";
}

TEST(ViewSetupTest, ACameraOfTheFileShowsAtLeastWhatItShowedItsAuthor) {
  Scene scene = make_viewed_scene();
  scene.cameras[0].aspect_ratio = 2.0F;
  EXPECT_EQ(camera_of(scene, {}, uvec2(200, 100)).yfov, 0.7F);
  EXPECT_EQ(camera_of(scene, {}, uvec2(300, 100)).yfov, 0.7F);
  EXPECT_NEAR(std::tan(0.5F * camera_of(scene, {}, uvec2(100, 100)).yfov), 2.0F * std::tan(0.35F), 1e-6F);
  EXPECT_EQ(camera_of(scene, {.fov_deg = 90.0}, uvec2(100, 100)).yfov, glm::radians(90.0F)) << "the user's";
}

TEST(ViewSetupTest, APictureInWhichNothingIsSeenIsAWarning) {
  const Scene scene = make_ball();
  const auto warning_of = [&](const PoseOptions& pose) {
    const Camera camera = camera_of(scene, pose);
    testing::internal::CaptureStderr();
    warn_of_empty_pictures(scene, {&camera, 1}, uvec2(100), Console(Verbosity::kNormal));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(warning_of({}), "");
  EXPECT_THAT(
      warning_of({.eye = dvec3(5.0), .direction = dvec3(1.0, 0.0, 0.0)}),
      HasSubstr("the picture shows nothing of the scene; --look-at 1 2 3 instead of a direction looks at its middle"));
}

TEST(SwitchLightsTest, LightsThatAPoseHidesStayOff) {
  std::vector<Light> lights(3);
  lights[1].is_on = false;
  switch_lights(lights, {0});
  EXPECT_FALSE(lights[0].is_on);
  EXPECT_FALSE(lights[1].is_on);
  EXPECT_TRUE(lights[2].is_on);
}

}  // namespace
}  // namespace promin::app
