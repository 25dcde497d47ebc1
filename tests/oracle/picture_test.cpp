// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oracle/lobe.h"

namespace promin::oracle {
namespace {

/// Cameras, lights and colours are fp32 numbers, so results have this error.
constexpr Real kColorTolerance = 1e-6L;

const world::Plane kFloor{{0, 0, 0}, {0, 1, 0}};

void expect_color(const Vector& color, const Vector& expected) {
  EXPECT_LE(glm::distance(color, expected), kColorTolerance)
      << "(" << color.x << ", " << color.y << ", " << color.z << "), not (" << expected.x << ", " << expected.y << ", "
      << expected.z << ")";
}

/// Returns a view of one pixel, whose colour is that of the ray along `look`.
View look_at(const vec3& eye, const vec3& target, const vec3& up) {
  View view;
  view.size = uvec2(1);
  view.camera.eye = eye;
  view.camera.look = glm::normalize(target - eye);
  view.camera.up = up;
  return view;
}

Vector color_in(const world::Scene& scene, const View& view) {
  return render(scene, view).at(0, 0).color;
}

/// Returns a material without emission and reflection.
Material make_black() {
  Material material;
  material.phong().ambient = material.phong().diffuse = vec3(0.0F);
  return material;
}

Material make_emitter(const vec3& color) {
  Material material = make_black();
  material.emissive = color;
  return material;
}

Material make_mirror(const vec3& reflection, const vec3& emissive = vec3(0.0F)) {
  Material material = make_emitter(emissive);
  material.phong().reflection = reflection;
  return material;
}

Material make_metallic_roughness(const MetallicRoughness& model) {
  Material material;
  material.model = model;
  return material;
}

/// Returns a white diffuse floor under a classic point light of power 1 at (0, 2, 0).
world::Scene make_lit_floor() {
  world::Scene scene;
  scene.materials = {make_black()};
  scene.materials[0].phong().diffuse = vec3(1.0F);
  scene.objects = {{"floor", kFloor, 0}};
  scene.lights.resize(1);
  scene.lights[0].position = vec3(0, 2, 0);
  return scene;
}

/// Returns a view of a point of that floor from straight above.
View look_down_at(float x) {
  return look_at(vec3(x, 1, 0), vec3(x, 0, 0), vec3(0, 0, -1));
}

/// Returns a triangle around the origin in the plane z = 0. Its corners are at distance 1, with the normals of a sphere
/// around (0, 0, -2).
Mesh make_bent_triangle() {
  Mesh mesh;
  const float y = std::sqrt(0.75F);
  mesh.positions = {{1, 0, 0}, {-0.5F, y, 0}, {-0.5F, -y, 0}};
  mesh.triangles = {{0, 1, 2}};
  for (const vec3& p : mesh.positions) mesh.normals.push_back(glm::normalize(p + vec3(0, 0, 2)));
  return mesh;
}

TEST(OraclePicture, RaysGoThroughThePixelsCentres) {
  Camera camera;
  camera.eye = vec3(1, 2, 3);
  camera.yfov = 1.57079633F;
  const Ray ray = camera_ray(camera, uvec2(4, 2), 0, 0);
  EXPECT_EQ(ray.origin, Vector(1, 2, 3));
  EXPECT_LE(glm::distance(ray.direction, Vector(-1.5L, 0.5L, -1)), kColorTolerance);
  camera.projection = Projection::kOrthographic;
  camera.ymag = 4;
  const Ray parallel = camera_ray(camera, uvec2(4, 2), 3, 1);
  EXPECT_EQ(parallel.origin, Vector(7, 0, 3));
  EXPECT_EQ(parallel.direction, Vector(0, 0, -1));
}

TEST(OraclePicture, NothingBeforeTheViewportIsDrawn) {
  world::Scene scene = make_lit_floor();
  View view = look_at(vec3(0, 1, 0), vec3(0, 0, 0), vec3(0, 0, -1));
  for (const float near : {0.0F, 0.5F, 1.0F}) {
    view.camera.near = near;
    EXPECT_EQ(render(scene, view).at(0, 0).hit.object, 0) << near;
  }
  view.camera.near = std::nextafter(1.0F, 2.0F);
  EXPECT_FALSE(render(scene, view).at(0, 0).hit.exists());
}

TEST(OraclePicture, DepthCountsFromTheEyeAndNormalsAreNotFlipped) {
  const world::Scene scene = make_lit_floor();
  View view = look_at(vec3(0, -3, 0), vec3(0, 0, -4), vec3(0, 0.8F, 0.6F));
  const Pixel seen = render(scene, view).at(0, 0);
  EXPECT_NEAR(seen.depth(), 5, kColorTolerance);
  EXPECT_EQ(seen.hit.normal, Vector(0, 1, 0));
  EXPECT_EQ(seen.hit.primitive, 0);
  view.camera.look = -view.camera.look;
  EXPECT_EQ(render(scene, view).at(0, 0).depth(), kInfinity);
}

TEST(OraclePicture, WhatMissesShowsTheBackground) {
  world::Scene scene;
  scene.environment.background = vec3(0.25F, 0.5F, 1.0F);
  expect_color(color_in(scene, look_down_at(0)), {0.25L, 0.5L, 1});
}

TEST(OraclePicture, AmbientAndEmissiveAdd) {
  world::Scene scene = make_lit_floor();
  scene.lights.clear();
  scene.environment.ambient = vec3(0.5F, 1.0F, 2.0F);
  scene.materials[0].phong().ambient = vec3(0.25F);
  scene.materials[0].emissive = vec3(0.0F, 0.0F, 1.0F);
  expect_color(color_in(scene, look_down_at(0)), {0.125L, 0.25L, 1.5L});
}

TEST(OraclePicture, DiffuseLightFollowsTheCosine) {
  world::Scene scene = make_lit_floor();
  expect_color(color_in(scene, look_down_at(0)), Vector(1));
  expect_color(color_in(scene, look_down_at(1.5F)), Vector(0.8L));
  // The floor's underside faces away from the light.
  expect_color(color_in(scene, look_at(vec3(0, -1, 0), vec3(0), vec3(0, 0, 1))), Vector(0));
  scene.lights[0].kind = LightKind::kDirectional;
  scene.lights[0].direction = vec3(0.6F, -0.8F, 0);
  expect_color(color_in(scene, look_down_at(1.5F)), Vector(0.8L));
}

TEST(OraclePicture, HighlightsFollowThePower) {
  world::Scene scene = make_lit_floor();
  scene.materials[0].phong().diffuse = vec3(0.0F);
  scene.materials[0].phong().specular = vec3(0.5F);
  scene.materials[0].phong().shininess = 10;
  const vec3 eye(std::sqrt(1.0F / 3.0F), 1, 0);
  const View view = look_at(eye, vec3(0), glm::normalize(vec3(-1, std::sqrt(1.0F / 3.0F), 0)));
  expect_color(color_in(scene, view), Vector(0.5L * std::pow(0.75L, Real(5))));
  scene.materials[0].phong().shininess = 0;
  expect_color(color_in(scene, view), Vector(0));
}

TEST(OraclePicture, ShadowsAreCastByWhatLiesBetween) {
  world::Scene scene = make_lit_floor();
  scene.objects.push_back({"ball", world::Sphere{{1, 1.5F, 0}, 0.25F}, 0});
  // The shadow of the ball's centre falls on x = 4.
  expect_color(color_in(scene, look_down_at(4)), Vector(0));
  expect_color(color_in(scene, look_down_at(-4)), Vector(1 / std::sqrt(Real(5))));
  // An object behind a point light casts no shadow; a directional light has no back.
  scene.objects[1].shape = world::Sphere{{0, 3, 0}, 0.25F};
  expect_color(color_in(scene, look_down_at(0)), Vector(1));
  scene.lights[0].kind = LightKind::kDirectional;
  scene.lights[0].direction = vec3(0, -1, 0);
  expect_color(color_in(scene, look_down_at(0)), Vector(0));
}

TEST(OraclePicture, PhysicalLightsFallOffToTheirRange) {
  world::Scene scene = make_lit_floor();
  scene.lights[0].attenuation = Attenuation::kInverseSquare;
  expect_color(color_in(scene, look_down_at(0)), Vector(0.25L));
  expect_color(color_in(scene, look_down_at(1.5F)), Vector(0.8L / 6.25L));
  scene.lights[0].range = 4;
  expect_color(color_in(scene, look_down_at(0)), Vector(0.25L * 15 / 16));
  scene.lights[0].range = 2;
  expect_color(color_in(scene, look_down_at(0)), Vector(0));
}

TEST(OraclePicture, SpotsFadeBetweenTheirAngles) {
  world::Scene scene = make_lit_floor();
  scene.lights[0].kind = LightKind::kSpot;
  scene.lights[0].direction = vec3(0, -1, 0);
  scene.lights[0].inner_cone_angle = 0.2F;
  scene.lights[0].outer_cone_angle = 0.4F;
  const auto seen_at = [&](Real angle) {
    return color_in(scene, look_down_at(static_cast<float>(2 * std::tan(angle)))).x / std::cos(angle);
  };
  const Real ramp = (std::cos(0.3L) - std::cos(0.4L)) / (std::cos(0.2L) - std::cos(0.4L));
  EXPECT_NEAR(seen_at(0.19L), 1, kColorTolerance);
  EXPECT_NEAR(seen_at(0.3L), ramp * ramp, kColorTolerance);
  EXPECT_NEAR(seen_at(0.41L), 0, kColorTolerance);
}

TEST(OraclePicture, AMirrorAddsWhatItSees) {
  world::Scene scene;
  scene.environment.background = vec3(2.0F);
  scene.materials = {make_mirror(vec3(0.5F, 0.25F, 0.0F), vec3(0.125F)), make_emitter(vec3(1.0F, 1.0F, 8.0F))};
  scene.objects = {{"floor", kFloor, 0}, {"lamp", world::Sphere{{4, 3, 0}, 1}, 1}};
  View view = look_at(vec3(-4, 3, 0), vec3(0), glm::normalize(vec3(3, 4, 0)));
  expect_color(color_in(scene, view), {0.625L, 0.375L, 0.125L});
  view.max_depth = 0;
  expect_color(color_in(scene, view), Vector(0.125L));
  view.max_depth = 1;
  scene.objects.pop_back();
  expect_color(color_in(scene, view), {1.125L, 0.625L, 0.125L});
}

TEST(OraclePicture, FacingMirrorsSumAGeometricSeries) {
  world::Scene scene;
  scene.environment.background = vec3(100.0F);
  scene.materials = {make_mirror(vec3(0.5F), vec3(1.0F))};
  scene.objects = {{"", kFloor, 0}, {"", world::Plane{{0, 2, 0}, {0, 1, 0}}, 0}};
  View view = look_down_at(0);
  for (const uint32_t depth : {0U, 1U, 5U, 20U}) {
    view.max_depth = depth;
    expect_color(color_in(scene, view), Vector(2 - std::pow(0.5L, Real(depth))));
  }
}

// With eye and light above, D = 1 / (pi alpha^2), the visibility is 1/4, and Fresnel's factor is that of normal
// incidence.
TEST(OraclePicture, MetallicRoughnessFromAbove) {
  world::Scene scene = make_lit_floor();
  MetallicRoughness model{.base_color = vec3(0.5F, 0.25F, 1.0F), .metallic = 0.0F, .roughness = 0.5F};
  scene.materials = {make_metallic_roughness(model)};
  const LobeShares shares = look_up_lobe_shares(1, 0.5L);
  const Real pi = std::numbers::pi_v<Real>;
  // An index of 1.5 gives 0.04.
  const Real k = 1 / (1 - (0.04L + 0.96L / 21) * (1 - shares.all));
  const Real reflectance = k * (0.04L * (shares.all - shares.grazing) + shares.grazing);
  const Real highlight = 0.25L / (pi * 0.0625L);
  const Vector dielectric = (1 - reflectance) * Vector(model.base_color) / pi + k * 0.04L * highlight;
  expect_color(color_in(scene, look_down_at(0)), dielectric);
  model.metallic = 1;
  scene.materials = {make_metallic_roughness(model)};
  const Vector base(model.base_color);
  const Vector metal_k = Real(1) / (Real(1) - (base + (Real(1) - base) / Real(21)) * (1 - shares.all));
  expect_color(color_in(scene, look_down_at(0)), metal_k * base * highlight);
}

TEST(OraclePicture, MetallicRoughnessSharesAmbientLight) {
  world::Scene scene = make_lit_floor();
  scene.lights.clear();
  scene.environment.ambient = vec3(0.5F);
  scene.environment.background = vec3(9.0F);
  for (const float roughness : {0.0F, 0.25F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      scene.materials = {make_metallic_roughness({.metallic = metallic, .roughness = roughness})};
      View view = look_at(vec3(-3, 1, 0), vec3(0), glm::normalize(vec3(1, 3, 0)));
      expect_color(color_in(scene, view), Vector(0.5L));
      view.max_depth = 0;
      expect_color(color_in(scene, view), Vector(0.5L));
    }
  }
}

// A smooth metal reflects the objects, and the ambient light where there are none; a rough one reflects only the
// ambient light.
TEST(OraclePicture, MetalMirrorsAsFarAsItIsSmooth) {
  world::Scene scene;
  scene.environment.ambient = vec3(0.5F);
  scene.environment.background = vec3(9.0F);
  scene.objects = {{"floor", kFloor, 0}, {"lamp", world::Sphere{{4, 3, 0}, 1}, 1}};
  const View view = look_at(vec3(-4, 3, 0), vec3(0), glm::normalize(vec3(3, 4, 0)));
  const auto color_with = [&](float roughness) {
    scene.materials = {make_metallic_roughness({.roughness = roughness}), make_emitter(vec3(1, 1, 8))};
    return color_in(scene, view);
  };
  expect_color(color_with(0), {1, 1, 8});
  expect_color(color_with(0.1F), {1, 1, 8});
  // This roughness is half way between the two.
  expect_color(color_with(0.25F), {0.75L, 0.75L, 4.25L});
  expect_color(color_with(0.4F), Vector(0.5L));
  // A mirror ray is traced if its weight is at least 1/256.
  expect_color(color_with(0.390F), Vector(0.5L));
  EXPECT_GT(color_with(0.387F).z, 0.52L);
}

// A Phong mirror's ray that hits nothing returns different light if a metal was on its path.
TEST(OraclePicture, MirrorsBehindMetalSeeTheAmbientLight) {
  world::Scene scene;
  scene.environment.ambient = vec3(0.5F);
  scene.environment.background = vec3(9.0F);
  const Material metal = make_metallic_roughness({.roughness = 0.0F});
  scene.objects = {{"floor", kFloor, 0}, {"wall", world::Plane{{4, 0, 0}, {1, 0, 0}}, 1}};
  const View view = look_at(vec3(-4, 3, 0), vec3(0), glm::normalize(vec3(3, 4, 0)));
  scene.materials = {make_mirror(vec3(1.0F)), make_mirror(vec3(1.0F))};
  expect_color(color_in(scene, view), Vector(9));
  scene.materials[0] = metal;
  expect_color(color_in(scene, view), Vector(0.5L));
  scene.materials = {make_mirror(vec3(1.0F)), metal};
  expect_color(color_in(scene, view), Vector(0.5L));
}

TEST(OraclePicture, UnlitIsItsColor) {
  world::Scene scene = make_lit_floor();
  scene.environment.ambient = vec3(1.0F);
  scene.materials[0].model = Unlit{vec3(0.25F, 0.5F, 2.0F)};
  scene.materials[0].emissive = vec3(0.0F, 0.0F, 1.0F);
  expect_color(color_in(scene, look_down_at(0)), {0.25L, 0.5L, 3});
  EXPECT_EQ(render(scene, look_down_at(0)).at(0, 0).explained_error, 0);
}

// The sharper a highlight, the more a rounded normal changes it, and most in its flank.
TEST(OraclePicture, HighlightsAreAsUncertainAsTheyAreSharp) {
  world::Scene scene = make_lit_floor();
  const auto pixel_with = [&](float roughness, float x) {
    scene.materials = {make_metallic_roughness({.roughness = roughness})};
    return render(scene, look_down_at(x)).at(0, 0);
  };
  const Pixel sharp = pixel_with(0.1F, 0.01F);
  const Pixel blunt = pixel_with(0.5F, 0.25F);
  // In a flank, an error of 1e-6 of the normal changes the value by about 2e-6 / alpha.
  EXPECT_GT(sharp.explained_error, 1e-4L * sharp.color.x);
  EXPECT_LT(sharp.explained_error, 1e-3L * sharp.color.x);
  EXPECT_LT(blunt.explained_error, 1e-4L * blunt.color.x);
  EXPECT_GT(blunt.explained_error, 0);
}

TEST(OraclePicture, VertexColorsAndMaterialsOfTriangles) {
  world::Scene scene;
  scene.environment.ambient = vec3(1.0F);
  scene.materials = {make_black(), Material()};
  scene.materials[1].phong().ambient = vec3(0.5F);
  Mesh mesh = make_bent_triangle();
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  mesh.triangle_materials = {1};
  scene.objects = {{"", mesh, 0}};
  const View view = look_at(vec3(0.4F, 0, 3), vec3(0.4F, 0, 0), vec3(0, 1, 0));
  expect_color(color_in(scene, view), {0.3L, 0.1L, 0.1L});
}

TEST(OraclePicture, InterpolatedNormalsShadeFromEitherSide) {
  world::Scene scene = make_lit_floor();
  scene.objects = {{"", make_bent_triangle(), 0}};
  scene.lights[0].kind = LightKind::kDirectional;
  for (const float side : {1.0F, -1.0F}) {
    // The normal is along (0.4, 0, 2), and faces the eye.
    scene.lights[0].direction = vec3(0, 0, -side);
    const View view = look_at(vec3(0.4F, 0, 3 * side), vec3(0.4F, 0, 0), vec3(0, 1, 0));
    expect_color(color_in(scene, view), Vector(2 / std::sqrt(4.16L)));
    EXPECT_EQ(render(scene, view).at(0, 0).hit.normal, Vector(0, 0, 1));
  }
}

TEST(OraclePicture, ShadowRaysStartFromTheCurveThatVertexNormalsSuggest) {
  // At (0.1, 0, 0) the smooth surface is 0.4 (1 - 0.1^2) above the triangle. The light comes along the triangle's
  // plane.
  world::Scene scene = make_lit_floor();
  scene.lights[0].kind = LightKind::kDirectional;
  scene.lights[0].direction = vec3(-1, 0, 0);
  const View view = look_at(vec3(0.1F, 0, 3), vec3(0.1F, 0, 0), vec3(0, 1, 0));
  const auto is_lit_past = [&](float height) {
    scene.objects = {{"", make_bent_triangle(), 0}, {"", world::Sphere{{5, 0, height}, 0.01F}, 0}};
    return color_in(scene, view).x > 0;
  };
  EXPECT_TRUE(is_lit_past(0));
  EXPECT_FALSE(is_lit_past(0.396F));
  EXPECT_TRUE(is_lit_past(0.42F));
}

TEST(OraclePicture, MirrorRaysNeverEnterTheSurface) {
  world::Scene scene;
  scene.materials = {make_mirror(vec3(1.0F)), make_emitter(vec3(0, 1, 0)), make_emitter(vec3(1, 0, 0))};
  Mesh mesh = make_bent_triangle();
  mesh.normals.assign(3, vec3(0.6F, 0, 0.8F));
  scene.objects = {{"", mesh, 0},
                   {"above", world::Plane{{0, 0, 1}, {0, 0, 1}}, 1},
                   {"below", world::Plane{{0, 0, -1}, {0, 0, 1}}, 2}};
  // The ray along (0.96, 0, -0.28) would be reflected along (0.5376, 0, -0.8432), below the triangle.
  const View view = look_at(vec3(-1.92F, 0, 0.56F), vec3(0), vec3(0.28F, 0, 0.96F));
  expect_color(color_in(scene, view), {0, 1, 0});
}

/// Renders a ball and a can on a mirroring floor under two lights. Lengths are multiples of `size`; the scene is around
/// `center`.
Picture render_still_life(float size, const vec3& center) {
  world::Scene scene = make_lit_floor();
  scene.materials[0].phong().reflection = vec3(0.25F);
  scene.objects = {{"", world::Plane{center, vec3(0, 1, 0)}, 0},
                   {"", world::Sphere{center + size * vec3(0, 1, 0), size}, 0},
                   {"", world::Cylinder{center + size * vec3(2, 1, 0), vec3(0, 1, 0), size, 0.5F * size}, 0},
                   {"", world::Cone{center + size * vec3(-2, 1, 0), vec3(0, 1, 0), size, 0.5F * size, 0}, 0}};
  scene.lights[0].position = center + size * vec3(3, 6, 5);
  View view = look_at(center + size * vec3(0, 1, 8), center + size * vec3(0, 1, 0), vec3(0, 1, 0));
  view.size = uvec2(48, 32);
  return render(scene, view);
}

TEST(OraclePicture, SizeAndPlaceDoNotMatter) {
  const Picture expected = render_still_life(1, vec3(0));
  const struct {
    float size;
    vec3 center;
  } places[] = {{0x1p-10F, vec3(0)}, {0x1p20F, vec3(0)}, {0x1p-6F, vec3(0x1p16F, -0x1p16F, 0x1p16F)}};
  for (const auto& [size, center] : places) {
    const Picture moved = render_still_life(size, center);
    uint32_t differing = 0;
    for (size_t i = 0; i < moved.pixels.size(); ++i) {
      if (!(glm::distance(moved.pixels[i].color, expected.pixels[i].color) <= kColorTolerance)) ++differing;
    }
    EXPECT_EQ(differing, 0U) << size;
  }
}

}  // namespace
}  // namespace promin::oracle
