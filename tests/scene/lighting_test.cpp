// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/lighting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "promin/shapes.h"
#include "promin/validate.h"
#include "scene/features.h"
#include "shared/layout.h"

namespace promin {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Returns a ball of radius 1 at the origin with one material. Its bounds have a radius of sqrt(3).
Scene ball_of(const Material& material) {
  Scene scene;
  scene.materials = {material};
  scene.add("ball", Sphere{.radius = 1.0F});
  return scene;
}
Scene physical_scene() {
  return ball_of({.name = "white", .model = MetallicRoughness{}});
}
Scene phong_scene() {
  return ball_of({.name = "grey", .model = Phong{}});
}
Scene classic_scene() {
  Scene scene = phong_scene();
  scene.is_classic = true;
  return scene;
}

Light light_of(LightKind kind, float power, const vec3& position = vec3(0.0F)) {
  Light light;
  light.kind = kind;
  light.position = position;
  light.diffuse = vec3(power);
  light.attenuation = kind == LightKind::kDirectional ? Attenuation::kNone : Attenuation::kInverseSquare;
  return light;
}

float front_with(const std::vector<Camera>& cameras) {
  Scene scene;
  scene.cameras = cameras;
  return front_of(scene);
}

bool has_studio(const Scene& scene) {
  return std::holds_alternative<Studio>(scene.environment.sky);
}

TEST(LightSceneTest, ASceneWithoutLightStandsInTheStudio) {
  Scene scene = physical_scene();
  const AssumedLight assumed = light_scene(scene);
  EXPECT_TRUE(assumed.has_studio && assumed.has_studio_light && assumed.has_background);
  EXPECT_FALSE(assumed.has_headlight || assumed.has_ambient);
  EXPECT_TRUE(has_studio(scene));
  EXPECT_EQ(scene.environment.intensity, 1.0F);
  EXPECT_EQ(scene.environment.ambient, vec3(0.0F));
  EXPECT_EQ(scene.environment.backdrop, (Backdrop{vec3(kStudioBackdropTop), vec3(kStudioBackdropBottom), 1.0F}));
  EXPECT_GT(scene.environment.background.x, kStudioBackdropBottom) << "between its ends";
  EXPECT_LT(scene.environment.background.x, kStudioBackdropTop);
  EXPECT_TRUE(mixes_unlit(scene)) << "it is shown as it is";
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kDirectional);
  EXPECT_EQ(scene.lights[0].diffuse, vec3(kStudioLightPower));
  EXPECT_EQ(scene.lights[0].specular, vec3(kStudioLightPower));
  EXPECT_TRUE(validate(scene).empty());
  EXPECT_EQ(display_of(scene), (DisplayTransform{0.0F, ToneMapping::kNeutral}));

  // A scene that already has lights stays unchanged.
  const AssumedLight again = light_scene(scene);
  EXPECT_FALSE(again.has_studio || again.has_studio_light || again.has_background);
  EXPECT_EQ(scene.lights.size(), 1U);
}

TEST(LightSceneTest, TheFillIsTheStudioOfScenesWithLights) {
  Scene scene = phong_scene();
  const AssumedLight assumed = light_scene(scene, LightChoice::kFill);
  EXPECT_TRUE(assumed.has_studio && assumed.has_background && !assumed.has_studio_light);
  EXPECT_TRUE(has_studio(scene) && scene.lights.empty());
  EXPECT_EQ(scene.environment.intensity, kStudioFill);
  Scene lit = phong_scene();
  lit.lights.emplace_back().is_on = false;
  light_scene(lit, LightChoice::kStudio);
  EXPECT_EQ(lit.environment.intensity, kStudioFill * std::exp2(-exposure_of(lit)));
}

TEST(LightSceneTest, TheSoftStudioHasASunOfTenDegrees) {
  Scene scene = phong_scene();
  EXPECT_TRUE(light_scene(scene, LightChoice::kSoft).has_studio_light);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_FLOAT_EQ(scene.lights[0].angle, 10.0F * kPi / 180.0F);
  EXPECT_TRUE(has_studio(scene));
  scene.lights.clear();
  scene.environment = {};
  light_scene(scene, LightChoice::kStudio);
  EXPECT_EQ(scene.lights[0].angle, 0.0F);
}

TEST(LightSceneTest, PhongsMaterialsTakeTheStudiosLightOverPi) {
  Scene scene = phong_scene();
  light_scene(scene);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_FLOAT_EQ(scene.lights[0].diffuse.x, kStudioLightPower / kPi);
  EXPECT_FLOAT_EQ(scene.lights[0].specular.x, kStudioLightPower / kPi);
  EXPECT_EQ(exposure_of(scene), 0.0F);
  // If the scene also has materials with another model, the light's power is not divided by pi.
  Scene mixed = phong_scene();
  mixed.materials.push_back({.name = "other", .model = MetallicRoughness{}});
  light_scene(mixed);
  EXPECT_EQ(mixed.lights[0].diffuse, vec3(kStudioLightPower));
}

TEST(LightSceneTest, ClassicScenesKeepHeadlightAndBlack) {
  Scene scene = classic_scene();
  const AssumedLight assumed = light_scene(scene);
  EXPECT_TRUE(assumed.has_headlight && assumed.has_ambient);
  EXPECT_FALSE(assumed.has_studio || assumed.has_studio_light || assumed.has_background);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.lights[0].kind, LightKind::kHeadlight);
  EXPECT_EQ(scene.environment.ambient, vec3(0.1F));
  EXPECT_EQ(scene.environment.background, vec3(0.0F));
  EXPECT_FALSE(scene.environment.backdrop);
  EXPECT_FALSE(has_studio(scene));
  EXPECT_EQ(display_of(scene), DisplayTransform());

  // If a scene has lights, promin assumes no lights, regardless of their power.
  Scene lit = classic_scene();
  lit.lights = {light_of(LightKind::kPoint, 1e4F)};
  light_scene(lit);
  EXPECT_EQ(lit.lights.size(), 1U);
  EXPECT_EQ(lit.environment.ambient, vec3(0.0F));
  EXPECT_EQ(display_of(lit), DisplayTransform());
}

// A rectangle of radiance L causes at most pi L, so a huge one does not make the picture black.
TEST(LightSceneTest, TheExposureOfAFlatLightHasALimit) {
  Scene scene = physical_scene();
  scene.lights = {light_of(LightKind::kRect, 10.0F)};
  for (const float side : {1e3F, 1e6F, 1e15F}) {
    scene.lights[0].size = vec2(side);
    EXPECT_EQ(exposure_of(scene), -3.5F) << side;
  }
  scene.lights[0].size = vec2(1e-3F);
  EXPECT_GT(exposure_of(scene), 10.0F);
}

TEST(LightSceneTest, UnlitColoursAreShownAsTheyAre) {
  Scene scene = physical_scene();
  scene.materials[0].model = Unlit{vec3(0.5F)};
  for (Object& object : scene.objects) object.material = 0;
  scene.lights = {light_of(LightKind::kPoint, 1e4F)};
  EXPECT_EQ(display_of(scene), DisplayTransform());
  scene.materials.push_back({.name = "lit", .model = MetallicRoughness{}});
  EXPECT_EQ(display_of(scene), DisplayTransform()) << "nothing shows it";
  EXPECT_FALSE(mixes_unlit(scene));
  scene.objects.back().material = static_cast<uint32_t>(scene.materials.size() - 1);
  EXPECT_EQ(display_of(scene).tone_mapping, ToneMapping::kNeutral);
  EXPECT_FALSE(mixes_unlit(physical_scene()));
}

TEST(LightSceneTest, AMeshOfSeveralMaterialsIsUnlitWhereAllAre) {
  Scene scene = physical_scene();
  scene.materials.push_back({.name = "unlit", .model = Unlit{}});
  Mesh mesh;
  mesh.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
  mesh.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 1)};
  mesh.triangle_materials = {1, 0};
  scene.objects.clear();
  scene.add("mesh", mesh, 1);
  EXPECT_EQ(display_of(scene).tone_mapping, ToneMapping::kNeutral);
  EXPECT_TRUE(mixes_unlit(scene));
  std::get<Mesh>(scene.geometries.back()).triangle_materials = {1, 1};
  EXPECT_EQ(display_of(scene), DisplayTransform());
  EXPECT_FALSE(mixes_unlit(scene));
}

TEST(LightSceneTest, TheChoiceIsTheUsers) {
  Scene headlight = physical_scene();
  light_scene(headlight, LightChoice::kHeadlight);
  EXPECT_FALSE(has_studio(headlight));
  ASSERT_EQ(headlight.lights.size(), 1U);
  EXPECT_EQ(headlight.lights[0].kind, LightKind::kHeadlight);
  EXPECT_EQ(headlight.environment.ambient, vec3(0.1F));
  EXPECT_TRUE(headlight.environment.backdrop) << "the background is another choice";
  EXPECT_EQ(display_of(headlight, LightChoice::kHeadlight).tone_mapping, ToneMapping::kNeutral);
  EXPECT_EQ(display_of(phong_scene(), LightChoice::kHeadlight).tone_mapping, ToneMapping::kNone) << "all is classic";
  EXPECT_EQ(display_of(phong_scene(), LightChoice::kStudio).tone_mapping, ToneMapping::kNeutral);

  Scene none = physical_scene();
  light_scene(none, LightChoice::kNone);
  EXPECT_FALSE(has_studio(none));
  EXPECT_TRUE(none.lights.empty());
  EXPECT_EQ(none.environment.ambient, vec3(0.0F));

  Scene studio = classic_scene();
  light_scene(studio, LightChoice::kStudio);
  EXPECT_TRUE(has_studio(studio));
  EXPECT_EQ(studio.lights[0].kind, LightKind::kDirectional);
  EXPECT_EQ(studio.environment.background, vec3(0.0F));
  EXPECT_EQ(display_of(studio), DisplayTransform());
}

TEST(LightSceneTest, TheStudioReachesWhatHasNoAmbientFactor) {
  for (const LightChoice choice : {LightChoice::kStudio, LightChoice::kHeadlight}) {
    Scene scene = phong_scene();
    scene.materials.resize(2);
    scene.materials[0].phong() = Phong{.ambient = vec3(0.0F), .diffuse = vec3(0.5F)};
    scene.materials[1].phong() = Phong{.ambient = vec3(0.25F), .diffuse = vec3(0.5F)};
    light_scene(scene, choice);
    EXPECT_EQ(scene.materials[0].phong().ambient, vec3(choice == LightChoice::kStudio ? 0.5F : 0.0F));
    EXPECT_EQ(scene.materials[1].phong().ambient, vec3(0.25F));
  }
  Scene classic = classic_scene();
  classic.materials[0].phong().ambient = vec3(0.0F);
  light_scene(classic, LightChoice::kStudio);
  EXPECT_EQ(classic.materials[0].phong().ambient, vec3(0.0F));
}

TEST(LightSceneTest, LightsWithoutASkyGetTheStudioWeaker) {
  Scene scene = physical_scene();
  // With E = 64 pi the exposure is 2^-6.
  scene.lights = {light_of(LightKind::kDirectional, 64.0F * kPi)};
  const AssumedLight assumed = light_scene(scene);
  EXPECT_TRUE(assumed.has_studio && assumed.has_background);
  EXPECT_FALSE(assumed.has_studio_light || assumed.has_headlight);
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_FLOAT_EQ(scene.environment.intensity, 0.3F * 64.0F);
  EXPECT_EQ(scene.environment.backdrop->top, vec3(kStudioBackdropTop)) << "as it is shown";
  EXPECT_EQ(scene.environment.backdrop->radiance, 64.0F);
  EXPECT_FLOAT_EQ(scene.environment.background.x, 32.0F * (kStudioBackdropTop + kStudioBackdropBottom));
  EXPECT_EQ(display_of(scene), (DisplayTransform{-6.0F, ToneMapping::kNeutral}));
}

TEST(LightSceneTest, ASkyOfTheFilesOwnIsEnough) {
  Scene ambient = physical_scene();
  ambient.environment.ambient = vec3(0.5F);
  light_scene(ambient);
  EXPECT_TRUE(ambient.lights.empty());
  EXPECT_FALSE(has_studio(ambient));
  EXPECT_EQ(ambient.environment.background, vec3(0.0F)) << "the sky's own";

  Scene gradient = physical_scene();
  gradient.environment.sky = GradientSky{};
  light_scene(gradient);
  EXPECT_TRUE(gradient.lights.empty());
  EXPECT_TRUE(std::holds_alternative<GradientSky>(gradient.environment.sky));

  // A background alone emits no light and does not change.
  Scene colored = physical_scene();
  colored.environment.background = vec3(0.1F, 0.2F, 0.3F);
  light_scene(colored);
  EXPECT_TRUE(has_studio(colored));
  EXPECT_EQ(colored.environment.background, vec3(0.1F, 0.2F, 0.3F));
  EXPECT_FALSE(colored.environment.backdrop);
}

TEST(StudioTest, ItStandsByTheFirstCamera) {
  Scene scene = physical_scene();
  EXPECT_EQ(front_of(scene), 0.0F) << "+Z is a file's front";
  Camera camera;
  EXPECT_EQ(front_with({camera}), 0.0F) << "it looks down -Z, from +Z";
  camera.look = vec3(-1.0F, 0.0F, 0.0F);
  EXPECT_FLOAT_EQ(front_with({camera}), 0.5F * kPi) << "from +X";
  camera.look = glm::normalize(vec3(1.0F, -5.0F, 1.0F));
  EXPECT_FLOAT_EQ(front_with({camera, Camera{}}), -0.75F * kPi) << "from -X -Z and above";
  // A camera that looks straight down has +X at the top and -X at the lower edge. For one that looks straight up, -X is
  // at the upper edge.
  camera.look = vec3(0.0F, -1.0F, 0.0F);
  camera.up = vec3(1.0F, 0.0F, 0.0F);
  EXPECT_FLOAT_EQ(front_with({camera}), -0.5F * kPi);
  camera.look = vec3(0.0F, 1.0F, 0.0F);
  EXPECT_FLOAT_EQ(front_with({camera}), 0.5F * kPi);

  camera.look = vec3(-1.0F, 0.0F, 0.0F);
  camera.up = vec3(0.0F, 1.0F, 0.0F);
  scene.cameras = {camera};
  light_scene(scene);
  EXPECT_EQ(std::get<Studio>(scene.environment.sky).front, front_of(scene));
  EXPECT_EQ(scene.lights[0].direction, make_studio_light(front_of(scene)).direction);
}

TEST(StudioTest, ItStandsOnUp) {
  // This camera stands at -Y, which is the front if +Z is up, or to the right of it.
  Camera camera;
  camera.look = vec3(0.0F, 1.0F, 0.0F);
  camera.up = vec3(0.0F, 0.0F, 1.0F);
  for (const bool is_turned : {false, true}) {
    if (is_turned) camera.look = vec3(-1.0F, 0.0F, 0.0F);
    Scene scene = physical_scene();
    scene.environment.up = vec3(0.0F, 0.0F, 1.0F);
    scene.cameras = {camera};
    light_scene(scene);
    const float front = std::get<Studio>(scene.environment.sky).front;
    EXPECT_FLOAT_EQ(front, is_turned ? 0.5F * kPi : 0.0F);
    const vec3 upright = make_studio_light(front).direction;
    EXPECT_LT(glm::distance(scene.lights[0].direction, vec3(upright.x, -upright.z, upright.y)), 1e-6F);
  }
}

TEST(StudioTest, ItsLightComesFromTheViewersUpperLeft) {
  for (const float front : {0.0F, 0.5F, -2.0F, kPi}) {
    const vec3 to_light = -make_studio_light(front).direction;
    EXPECT_NEAR(glm::length(to_light), 1.0, 1e-6);
    EXPECT_NEAR(std::asin(to_light.y), glm::radians(40.0), 1e-6);
    const vec3 to_viewer(std::sin(front), 0.0F, std::cos(front));
    const vec3 right = glm::cross(-to_viewer, vec3(0.0F, 1.0F, 0.0F));
    EXPECT_NEAR(std::atan2(glm::dot(to_light, right), glm::dot(to_light, to_viewer)), glm::radians(-35.0), 1e-6);
  }
}

TEST(ExposureTest, OrdinaryLightIsShownAsItIs) {
  Scene scene = physical_scene();
  EXPECT_EQ(exposure_of(scene), 0.0F) << "no light";
  for (const float power : {0.0F, 0.79F, 2.0F, kPi, 12.5F}) {
    scene.lights = {light_of(LightKind::kDirectional, power)};
    EXPECT_EQ(exposure_of(scene), 0.0F) << power;
  }
}

TEST(ExposureTest, OtherLightIsBroughtToPiInHalfStops) {
  Scene scene = physical_scene();
  for (float power = 1e-6F; power < 1e9F; power *= 1.7F) {
    if (power > 0.78F && power < 12.6F) continue;
    scene.lights = {light_of(LightKind::kDirectional, power)};
    const float stops = exposure_of(scene);
    EXPECT_EQ(2.0F * stops, std::round(2.0F * stops));
    EXPECT_LE(std::abs(std::log2(power / kPi) + stops), 0.2501F) << power;
  }
  // The brightness is the brightness that the eye perceives.
  scene.lights[0].diffuse = vec3(0.0F, 100.0F, 0.0F);
  EXPECT_EQ(exposure_of(scene), -4.5F) << "71.5 lux";
  scene.lights.push_back(scene.lights[0]);
  scene.lights[1].is_on = false;
  EXPECT_EQ(exposure_of(scene), -5.5F) << "switching a light off does not change the exposure";
}

TEST(ExposureTest, DistanceCountsFromTheScenesMiddle) {
  Scene scene = physical_scene();
  scene.objects[0].world_from_object[3] = dvec4(10.0, 0.0, 0.0, 1.0);
  scene.lights = {light_of(LightKind::kPoint, 100.0F * 64.0F * kPi)};
  EXPECT_EQ(exposure_of(scene), -6.0F);
  scene.lights[0].kind = LightKind::kSpot;
  EXPECT_EQ(exposure_of(scene), -6.0F);
  // Distances of less than half the radius, sqrt(3) / 2, count as half the radius.
  scene.lights[0].diffuse = vec3(0.75F * 64.0F * kPi);
  for (const float distance : {0.0F, 0.1F, 0.86F}) {
    scene.lights[0].position = vec3(10.0F, distance, 0.0F);
    EXPECT_EQ(exposure_of(scene), -6.0F) << distance;
  }
  scene.lights[0].position = vec3(10.0F, 1.8F, 0.0F);
  EXPECT_EQ(exposure_of(scene), -4.0F);
  // Classic lights do not get weaker with distance.
  scene.lights[0].attenuation = Attenuation::kNone;
  EXPECT_EQ(exposure_of(scene), -5.5F);
}

TEST(ExposureTest, PhongsMaterialsTakePowerTimesPi) {
  Scene scene = phong_scene();
  scene.lights = {make_headlight()};
  EXPECT_EQ(exposure_of(scene), 0.0F);
  scene.lights[0].diffuse = vec3(64.0F);
  EXPECT_EQ(exposure_of(scene), -6.0F);
}

TEST(EnvironmentFeaturesTest, OnlyASkyCanBeBehindAll) {
  Environment environment;
  environment.shows_sky = true;
  EXPECT_TRUE(environment_features(environment).is_empty());
  environment.sky = Studio{};
  EXPECT_TRUE(environment_features(environment).has_any(layout::FEATURE_SHOWN_SKY));
  environment.shows_sky = false;
  EXPECT_FALSE(environment_features(environment).has_any(layout::FEATURE_SHOWN_SKY));
  EXPECT_TRUE(environment_features(environment).has_any(layout::FEATURE_SKY));
}

}  // namespace
}  // namespace promin
