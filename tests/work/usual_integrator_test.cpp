// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/usual_integrator.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "promin/lighting.h"
#include "promin/materials.h"
#include "promin/shapes.h"

namespace promin::work {
namespace {

constexpr uint32_t kWhite = 0;
constexpr uint32_t kGlow = 1;

/// Returns a square in the plane y = height, with these sides.
Mesh make_square(float height, float side) {
  const float half = 0.5F * side;
  Mesh mesh;
  mesh.positions = {vec3(-half, height, -half), vec3(half, height, -half), vec3(half, height, half),
                    vec3(-half, height, half)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Returns a floor of 4 by 4 under a square lamp of this side and radiance.
Scene make_room(float radiance, float side) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[kWhite].model = MetallicRoughness();
  scene.materials[kGlow].model = MetallicRoughness();
  scene.materials[kGlow].emissive = vec3(radiance);
  scene.materials[kGlow].is_double_sided = false;
  scene.add("floor", make_square(0.0F, 4.0F), kWhite);
  scene.add("lamp", make_square(1.0F, side), kGlow);
  return scene;
}

TEST(UsualIntegratorTest, LampsAreBrighterThanOne) {
  EXPECT_FALSE(lights_itself(Scene()));
  EXPECT_FALSE(lights_itself(make_room(0.0F, 1.0F)));
  EXPECT_FALSE(lights_itself(make_room(1.0F, 4.0F))) << "screens and labels";
  EXPECT_TRUE(lights_itself(make_room(1.01F, 4.0F)));
  Scene unlit = make_room(5.0F, 1.0F);
  unlit.materials[kGlow].model = Unlit();
  EXPECT_FALSE(lights_itself(unlit)) << "unlit surfaces are no sources";
  EXPECT_EQ(usual_integrator(make_room(2.0F, 4.0F), LightChoice::kNone), Integrator::kDirect);
  EXPECT_EQ(usual_integrator(make_room(0.0F, 4.0F), LightChoice::kNone), Integrator::kWhitted);
  EXPECT_EQ(usual_integrator(make_room(0.0F, 4.0F), LightChoice::kSoft), Integrator::kDirect);
}

// The room has the radius sqrt(8.25), so the flux of the least lamp is 4 pi 8.25 / 256 = 0.405.
TEST(UsualIntegratorTest, LampsHaveAFluxThatDependsOnTheScene) {
  EXPECT_TRUE(lights_itself(make_room(10.0F, 0.2025F)));
  EXPECT_FALSE(lights_itself(make_room(10.0F, 0.2F)));
  Scene both_sides = make_room(10.0F, 0.2F);
  both_sides.materials[kGlow].is_double_sided = true;
  EXPECT_TRUE(lights_itself(both_sides));
  Scene two = make_room(10.0F, 0.2F);
  two.add("second lamp", make_square(1.0F, 0.1F), kGlow);
  EXPECT_TRUE(lights_itself(two)) << "all lamps count together";
  Scene scaled = make_room(10.0F, 0.2F);
  for (Object& object : scaled.objects) object.world_from_object = glm::dmat4(glm::dmat3(50.0));
  scaled.objects[1].world_from_object = glm::dmat4(glm::dmat3(51.0));
  EXPECT_TRUE(lights_itself(scaled)) << "sizes are those in the world, and only their ratios count";
}

/// Returns the exposure of pictures with `light` after settle_light().
float settled_exposure(const Scene& scene, LightChoice light, Integrator integrator = Integrator::kDirect) {
  LookOptions look{.light = light};
  settle_light(scene, integrator, look);
  return exposure_of(scene, look.surface_lux);
}

// The lamp is nearer to the middle than half the radius, so a lamp of 1 by 1 gives 100 / (8.25 / 4) = 48.5 lux.
TEST(GlowTest, ChoosesTheExposureIfThereIsNoOtherLight) {
  Scene scene = make_room(100.0F, 1.0F);
  for (const LightChoice light : {LightChoice::kAuto, LightChoice::kFill, LightChoice::kNone}) {
    EXPECT_EQ(settled_exposure(scene, light), -4.0F);
    EXPECT_EQ(settled_exposure(scene, light, Integrator::kWhitted), 0.0F) << "its lamps light nothing";
  }
  EXPECT_EQ(settled_exposure(scene, LightChoice::kStudio), 0.0F) << "the studio has the light of usual pictures";
  EXPECT_EQ(settled_exposure(make_room(100.0F, 100.0F), LightChoice::kFill), -6.5F) << "at most 100 pi lux";
  EXPECT_EQ(settled_exposure(make_room(4.0F, 1.0F), LightChoice::kFill), 0.0F) << "1.9 lux";
  Scene both_sides = scene;
  both_sides.materials[kGlow].is_double_sided = true;
  EXPECT_EQ(settled_exposure(both_sides, LightChoice::kFill), -4.0F) << "one side is visible";
  const auto turn = [](Scene& turned) {
    for (uvec3& corners : std::get<Mesh>(turned.geometries[1]).triangles) std::swap(corners.x, corners.y);
  };
  turn(both_sides);
  EXPECT_EQ(settled_exposure(both_sides, LightChoice::kFill), -4.0F);
  turn(scene);
  EXPECT_EQ(settled_exposure(scene, LightChoice::kFill), 0.0F) << "a lamp that faces away counts a quarter: 12.1 lux";
  scene.objects[1].world_from_object = glm::dmat4(glm::dmat3(dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)));
  EXPECT_EQ(settled_exposure(scene, LightChoice::kFill), 0.0F) << "a mirrored lamp has the same front";
  Scene under_sky = scene;
  under_sky.environment.ambient = vec3(1.0F);
  EXPECT_EQ(settled_exposure(under_sky, LightChoice::kNone), 0.0F) << "a scene with a sky keeps its exposure";
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::kDirectional;
  scene.lights[0].diffuse = vec3(3.0F);
  EXPECT_EQ(settled_exposure(scene, LightChoice::kFill), 0.0F) << "lights alone count";
}

TEST(UsualIntegratorTest, ALargeFloorHidesNoLamp) {
  Scene scene = make_room(10.0F, 0.5F);
  scene.geometries[0] = make_square(0.0F, 1000.0F);
  EXPECT_FALSE(lights_itself(scene)) << "a spot on the floor";
  scene.add("ball", Sphere{vec3(0.5F, 0.5F, 0.0F), 0.5F}, kWhite);
  EXPECT_TRUE(lights_itself(scene));
}

TEST(UsualIntegratorTest, TexturesOfEmissionCountByTheirMean) {
  const auto with_texels = [](std::vector<uint32_t> texels) {
    Scene scene = make_room(10.0F, 0.3F);
    TextureImage image{.name = "", .size = uvec2(texels.size(), 1), .texels = std::move(texels)};
    scene.images = {std::make_shared<const TextureImage>(std::move(image))};
    scene.textures = {Texture{}};
    scene.materials[kGlow].emissive_texture.texture = 0;
    return scene;
  };
  EXPECT_TRUE(lights_itself(with_texels({0xFFFFFFFF})));
  EXPECT_FALSE(lights_itself(with_texels({0xFF000000}))) << "black";
  EXPECT_TRUE(lights_itself(with_texels({0xFFFFFFFF, 0xFF000000})));
  EXPECT_FALSE(lights_itself(with_texels({0xFFFFFFFF, 0xFF000000, 0xFF000000, 0xFF000000})));
}

TEST(UsualIntegratorTest, MeshesOfSeveralMaterialsAndShapesAreLamps) {
  Scene scene;
  scene.materials = make_room(10.0F, 1.0F).materials;
  Mesh mesh = make_square(0.0F, 1.0F);
  mesh.triangle_materials = {kWhite, kGlow};
  scene.add("both", mesh);
  EXPECT_TRUE(lights_itself(scene));
  std::get<Mesh>(scene.geometries[0]).triangle_materials = {kGlow, kGlow};
  EXPECT_FALSE(lights_itself(scene)) << "nothing else receives the light";
  scene.add("floor", Plane{vec3(0.0F), vec3(0, 1, 0)}, kWhite);
  EXPECT_TRUE(lights_itself(scene));
  Scene planes;
  planes.materials = scene.materials;
  planes.add("floor", Plane{vec3(0.0F), vec3(0, 1, 0)}, kGlow);
  planes.add("ball", Sphere{vec3(0.0F), 1.0F}, kWhite);
  EXPECT_FALSE(lights_itself(planes)) << "a plane emits no light";
  planes.objects[1].material = kGlow;
  EXPECT_TRUE(lights_itself(planes));
}

// The least flux is 4 pi 8.25 / 32 = 3.24.
TEST(UsualIntegratorTest, FilesWithStrongLampsGetNoSun) {
  const auto choose = [](const Scene& scene, Integrator integrator = Integrator::kDirect,
                         LightChoice light = LightChoice::kAuto) {
    LookOptions look{.light = light};
    settle_light(scene, integrator, look);
    return look.light;
  };
  const Scene strong = make_room(10.0F, 0.57F);
  EXPECT_EQ(choose(strong), LightChoice::kFill);
  EXPECT_EQ(choose(strong, Integrator::kPath), LightChoice::kFill);
  EXPECT_EQ(choose(strong, Integrator::kWhitted), LightChoice::kStudio) << "its lamps light nothing";
  EXPECT_EQ(choose(make_room(10.0F, 0.56F)), LightChoice::kAuto) << "a small display needs other light";
  EXPECT_EQ(choose(make_room(1.0F, 4.0F)), LightChoice::kAuto);
  for (const LightChoice choice : {LightChoice::kStudio, LightChoice::kNone, LightChoice::kSoft}) {
    EXPECT_EQ(choose(strong, Integrator::kDirect, choice), choice);
  }
  Scene other = strong;
  other.is_classic = true;
  EXPECT_EQ(choose(other), LightChoice::kAuto);
  other = strong;
  other.lights.emplace_back();
  EXPECT_EQ(choose(other), LightChoice::kAuto);
  other = strong;
  other.environment.sky = Studio();
  EXPECT_EQ(choose(other), LightChoice::kAuto);
}

TEST(UsualIntegratorTest, InvalidScenesAreRead) {
  Scene scene = make_room(10.0F, 0.3F);
  scene.objects[0].material = 1000;
  scene.materials[kGlow].emissive_texture.texture = 0;
  scene.textures = {Texture{.image = 1000}};
  scene.objects.push_back(Object{.name = "no geometry"});
  EXPECT_TRUE(lights_itself(scene)) << "a missing image is white, and a missing material emits no light";
  scene.materials[kGlow].emissive_texture.texture = 1000;
  EXPECT_TRUE(lights_itself(scene)) << "a missing texture is white";
  scene.objects[1].material = 1000;
  EXPECT_FALSE(lights_itself(scene));
  scene.objects[1].material = kGlow;
  scene.materials[kGlow].emissive = vec3(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(lights_itself(scene));
}

}  // namespace
}  // namespace promin::work
