// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check surfaces that emit light as sources, and the choice of one of many sources (Integrator::kDirect):
// sample by sample against the oracle, in the mean against closed forms, and their bits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "device_scene/pack_emitters.h"
#include "gpu/faulty_shaders.h"
#include "gpu/lit_scenes.h"
#include "gpu/test_scenes.h"
#include "oracle/emitters.h"
#include "support/lambert.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

Material make_diffuse(const vec3& color) {
  MetallicRoughness model;
  model.base_color = color;
  model.metallic = 0.0F;
  model.roughness = 1.0F;
  model.specular = 0.0F;
  return {.name = "", .model = model};
}

Material make_glow(const vec3& radiance, bool is_double_sided = false) {
  Material material = make_diffuse(vec3(0.0F));
  material.emissive = radiance;
  material.is_double_sided = is_double_sided;
  return material;
}

/// Returns a rectangle with this middle and these halves of its sides. It faces the product of the sides.
Mesh make_sheet(const vec3& middle, const vec3& right, const vec3& up) {
  Mesh mesh;
  mesh.positions = {middle - right - up, middle + right - up, middle + right + up, middle - right + up};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh make_triangle(const vec3& a, const vec3& b, const vec3& c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// A floor and two balls under lamps of all regimes: a sheet that is large for points below it, a sheet of two sides, a
/// ball, a small triangle, a sheet that nearly touches the floor, and a point light.
world::Scene make_lamps() {
  world::Scene scene;
  scene.materials = {make_diffuse(vec3(0.8F, 0.7F, 0.6F)), make_diffuse(vec3(0.3F, 0.5F, 0.8F)),
                     make_glow(vec3(2.0F, 1.5F, 0.5F)),    make_glow(vec3(0.5F, 1.5F, 3.0F), true),
                     make_glow(vec3(1.0F, 4.0F, 1.0F)),    make_glow(vec3(300.0F, 200.0F, 250.0F)),
                     make_glow(vec3(0.7F, 0.3F, 0.2F))};
  scene.objects = {
      {"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0},
      {"ball", world::Sphere{vec3(-0.8F, 0.5F, 0.0F), 0.5F}, 1},
      {"ceiling", make_sheet(vec3(-0.4F, 1.7F, 0.2F), vec3(0.8F, 0.1F, 0.0F), vec3(0.0F, 0.1F, -0.7F)), 2},
      {"screen", make_sheet(vec3(1.5F, 0.7F, -0.5F), vec3(0.2F, 0.0F, 0.5F), vec3(0.0F, 0.5F, 0.1F)), 3},
      {"glowing ball", world::Sphere{vec3(0.6F, 0.4F, 0.5F), 0.3F}, 4},
      {"spark", make_triangle(vec3(-2.0F, 2.5F, 1.0F), vec3(-1.9F, 2.5F, 1.05F), vec3(-2.0F, 2.45F, 1.1F)), 5},
      {"low sheet", make_sheet(vec3(0.0F, 0.01F, 1.6F), vec3(0.4F, 0.0F, 0.0F), vec3(0.0F, 0.0F, 0.3F)), 6}};
  // The low sheet faces down.
  for (uvec3& corners : std::get<Mesh>(scene.objects.back().shape).triangles) std::swap(corners.y, corners.z);
  // The ceiling faces down too.
  for (uvec3& corners : std::get<Mesh>(scene.objects[2].shape).triangles) std::swap(corners.y, corners.z);
  Light point;
  point.position = vec3(2.0F, 2.0F, 1.0F);
  point.diffuse = point.specular = vec3(1.0F);
  point.attenuation = Attenuation::kInverseSquare;
  scene.lights = {point};
  return scene;
}

/// The same with lamps whose triangles all form rectangles: a tilted one that is large for points below it, two of two
/// sides in one object, a small one, and one that nearly touches the floor.
world::Scene make_rectangles() {
  world::Scene scene = make_lamps();
  // Sides at right angles, of exact coordinates.
  scene.objects[2].shape = make_sheet(vec3(-0.4F, 1.7F, 0.2F), vec3(0.0F, 0.1875F, -0.75F), vec3(0.8F, 0.0F, 0.0F));
  Mesh screens = make_sheet(vec3(1.5F, 0.75F, -0.5F), vec3(0.25F, 0.0F, 0.5F), vec3(-0.25F, 0.5F, 0.125F));
  // The corner of the right angle is another one in each triangle.
  screens.triangles = {{1, 2, 0}, {2, 3, 0}};
  const Mesh other = make_sheet(vec3(-2.0F, 0.5F, -0.5F), vec3(0.0F, 0.0F, 0.25F), vec3(0.0F, 0.375F, 0.0F));
  screens.positions.insert(screens.positions.end(), other.positions.begin(), other.positions.end());
  screens.triangles.insert(screens.triangles.end(), {{4, 5, 7}, {7, 5, 6}});
  scene.objects[3].shape = screens;
  scene.objects[5].shape = make_sheet(vec3(-2.0F, 2.5F, 1.0F), vec3(0.0625F, 0.0F, 0.0F), vec3(0.0F, 0.0F, 0.03125F));
  return scene;
}

/// The same with lamps of which each is one rectangle.
world::Scene make_lone_rectangles() {
  world::Scene scene = make_rectangles();
  std::get<Mesh>(scene.objects[3].shape).triangles.resize(2);
  scene.objects[4].shape = world::NotDrawn{};
  return scene;
}

/// Makes the floor, the balls and a lamp of make_lamps() of metals and coats.
world::Scene make_glossy(world::Scene scene) {
  MetallicRoughness metal;
  metal.base_color = vec3(0.9F, 0.7F, 0.4F);
  metal.metallic = 1.0F;
  metal.roughness = 0.3F;
  MetallicRoughness coated;
  coated.base_color = vec3(0.2F, 0.3F, 0.7F);
  coated.metallic = 0.0F;
  coated.roughness = 0.7F;
  coated.clearcoat = 1.0F;
  coated.clearcoat_roughness = 0.25F;
  scene.materials[0].model = coated;
  scene.materials[1].model = metal;
  // A lamp under a coat.
  std::get<MetallicRoughness>(scene.materials[3].model).clearcoat = 0.7F;
  scene.environment.ambient = vec3(0.1F, 0.2F, 0.15F);
  return scene;
}

View make_lamp_view(uvec2 size = uvec2(40, 30)) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0.0F, 1.6F, 4.0F);
  view.camera.look = glm::normalize(vec3(0.0F, -0.3F, -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.max_depth = 2;
  view.mode.integrator = Integrator::kDirect;
  return view;
}

/// Returns a view that sees one point of the plane y = 0.
View make_point_view(const vec3& point, float height = 0.05F) {
  View view = make_lamp_view(uvec2(8));
  view.camera.eye = point + vec3(0.0F, height, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.samples_per_pixel = 256;
  return view;
}

/// A white floor, and a lamp as its other object.
world::Scene make_lit_floor(const world::Shape& lamp, const Material& material) {
  world::Scene scene;
  scene.materials = {make_diffuse(vec3(1.0F)), material};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}, {"lamp", lamp, 1}};
  return scene;
}

/// Returns the emissive surfaces of a scene.
EmissiveSurfaces surfaces_of(const world::Scene& scene) {
  const PackedScene packed = pack_scene(scene, "sah");
  const EmissionMaps maps(scene.images.size());
  return find_emissive_surfaces({packed.primitives, packed.surfaces.surfaces, {}, packed.surfaces.vertices.uvs},
                                EmitterRanges(packed), scene.materials, {scene.textures, maps});
}

DirectSources sources_of(const world::Scene& scene) {
  return pack_direct_sources(scene.lights, surfaces_of(scene), scene.materials, 1.0F);
}

class EmittersTest : public test::SampledLightTest {
 protected:
  static oracle::PictureReport compare(const world::Scene& scene, const oracle::Picture& truth, const Image& image) {
    // Densities that are off by 2 % change few pixels of smooth surfaces.
    return report_of(scene, truth, image, {.color_mean = 2e-6L});
  }
  static void expect_fault_is_seen(const world::Scene& scene, const char* fault) {
    const View view = make_lamp_view();
    const test::FaultyShaders faulty(fault);
    TunedRendererOptions options;
    options.shaders = faulty.shaders();
    const Image image = renderer_of(scene, options).render(view).image;
    EXPECT_FALSE(compare(scene, oracle::render(scene, view), image).passes()) << fault;
  }
  /// Compares the first sample of each pixel, for several seeds.
  static void expect_samples(const world::Scene& scene, View view) {
    Renderer renderer = renderer_of(scene);
    for (const uint32_t seed : {0U, 1U, 4294967295U}) {
      view.seed = seed;
      EXPECT_TRUE(compare(scene, oracle::render(scene, view), renderer.render(view).image).passes()) << seed;
    }
  }
};

TEST_F(EmittersTest, EachSampleIsTheOracles) {
  expect_samples(make_lamps(), make_lamp_view());
}

TEST_F(EmittersTest, EachSampleOnGlossySurfacesIsTheOracles) {
  expect_samples(make_glossy(make_lamps()), make_lamp_view());
}

// If all triangles of lamps form rectangles, points of these are chosen.
TEST_F(EmittersTest, EachSampleOfRectanglesIsTheOracles) {
  const world::Scene scene = make_rectangles();
  ASSERT_TRUE(surfaces_of(scene).are_rectangles);
  ASSERT_FALSE(sources_of(scene).are_rectangles);
  expect_samples(scene, make_lamp_view());
}

TEST_F(EmittersTest, EachSampleOfLoneRectanglesIsTheOracles) {
  const world::Scene scene = make_lone_rectangles();
  ASSERT_TRUE(sources_of(scene).are_rectangles);
  View view = make_lamp_view();
  expect_samples(scene, view);
  // Scattered rays that hit a lamp do not count its light twice.
  view.mode.integrator = Integrator::kPath;
  expect_samples(scene, view);
}

TEST_F(EmittersTest, EachSampleOfRectanglesOnGlossySurfacesIsTheOracles) {
  expect_samples(make_glossy(make_rectangles()), make_lamp_view());
  world::Scene scene = make_glossy(make_lone_rectangles());
  // Light from below a coat depends on the angle, so records of sources have no such lamps.
  ASSERT_FALSE(sources_of(scene).are_rectangles);
  std::get<MetallicRoughness>(scene.materials[3].model).clearcoat = 0.0F;
  ASSERT_TRUE(sources_of(scene).are_rectangles);
  expect_samples(scene, make_lamp_view());
}

// Boxes, cylinders, cones and capsules are sampled by area, and lights of shapes reach their own insides.
TEST_F(EmittersTest, EachSampleOfShapesIsTheOracles) {
  world::Scene scene = make_lamps();
  scene.objects.resize(2);
  world::Box box{vec3(-1.6F, 0.4F, 0.6F), vec3(0.2F, 0.3F, 0.15F), vec3(0.1F, 0.2F, 0.05F)};
  world::Cylinder cylinder;
  cylinder.center = vec3(0.7F, 0.5F, 0.8F);
  cylinder.axis = glm::normalize(vec3(0.3F, 1.0F, 0.2F));
  cylinder.half_height = 0.3F;
  cylinder.radius = 0.15F;
  world::Cone cone;
  cone.center = vec3(1.5F, 0.5F, -0.4F);
  cone.axis = vec3(0, 1, 0);
  cone.half_height = 0.4F;
  cone.radius_bottom = 0.3F;
  cone.radius_top = 0.05F;
  world::Capsule capsule;
  capsule.center = vec3(-0.2F, 1.3F, 0.9F);
  capsule.axis = vec3(1, 0, 0);
  capsule.half_height = 0.3F;
  capsule.radius_bottom = 0.12F;
  capsule.radius_top = 0.05F;
  world::Cylinder tube = cylinder;
  tube.center = vec3(-0.3F, 0.3F, -1.0F);
  tube.is_open = true;
  scene.objects.push_back({"box", box, 2});
  scene.objects.push_back({"cylinder", cylinder, 4});
  scene.objects.push_back({"cone", cone, 6});
  scene.objects.push_back({"capsule", capsule, 2});
  scene.objects.push_back({"tube", tube, 6});
  expect_samples(scene, make_lamp_view());
}

// In a scene of Phong materials alone, lights have another power than surfaces.
TEST_F(EmittersTest, EachSampleOnPhongsMaterialsIsTheOracles) {
  for (world::Scene scene : {make_lamps(), make_lone_rectangles()}) {
    for (Material& material : scene.materials) {
      Phong phong;
      phong.diffuse = std::get<MetallicRoughness>(material.model).base_color;
      phong.ambient = vec3(0.0F);
      phong.specular = vec3(0.4F);
      phong.shininess = 20.0F;
      material.model = phong;
    }
    std::get<Phong>(scene.materials[1].model).reflection = vec3(0.5F);
    expect_samples(scene, make_lamp_view());
  }
}

// With more than 16 sources, each sample asks one of them.
TEST_F(EmittersTest, EachSampleOfManySourcesIsTheOracles) {
  for (world::Scene scene : {make_lamps(), make_lone_rectangles()}) {
    for (int i = 0; i < 14; ++i) {
      Light light = scene.lights[0];
      light.position = vec3(-1.5F + 0.25F * static_cast<float>(i), 1.2F + 0.1F * static_cast<float>(i % 3), 0.8F);
      light.diffuse = light.specular = vec3(0.05F * static_cast<float>(i + 1));
      if (i % 4 == 1) light.radius = 0.1F;
      if (i % 4 == 2) {
        light.kind = LightKind::kSpot;
        light.direction = vec3(0, -1, 0);
      }
      if (i % 4 == 3) light = test::make_sun(vec3(0.1F * static_cast<float>(i), -1.0F, 0.2F), 0.2F);
      scene.lights.push_back(light);
    }
    scene.environment.ambient = vec3(0.1F, 0.2F, 0.15F);
    expect_samples(scene, make_lamp_view());
  }
}

// A density that is off by 2 % is seen, and so are other faults.
TEST_F(EmittersTest, FaultsAreSeen) {
  for (const char* fault : test::cases_of<const char*>(
           {"lamp_angle_off", "lamp_area_off", "lamp_chance_off", "lamp_ball_off", "lamp_back_shines"}, 1)) {
    expect_fault_is_seen(make_lamps(), fault);
  }
}

TEST_F(EmittersTest, FaultsOfRectanglesAreSeen) {
  expect_fault_is_seen(make_rectangles(), "lamp_rect_off");
  expect_fault_is_seen(make_lone_rectangles(), "lamp_rect_off");
}

// A floor of albedo 1 has the radiance E / pi, with Lambert's formula for a polygon of radiance L.
TEST_F(EmittersTest, TrianglesHaveTheirClosedForm) {
  const std::vector<std::array<vec3, 3>> triangles = {
      {vec3(-1.0F, 0.6F, -0.5F), vec3(0.2F, 0.6F, 1.1F), vec3(1.2F, 0.8F, -0.7F)},     // large
      {vec3(0.0F, 0.6F, 0.0F), vec3(0.02F, 0.6F, 0.05F), vec3(0.05F, 0.6F, 0.0F)},     // small
      {vec3(-3.0F, 0.02F, -4.0F), vec3(0.0F, 0.02F, 5.0F), vec3(4.0F, 0.02F, -3.0F)},  // nearly a half space
      {vec3(0.2F, 0.01F, -0.3F), vec3(0.2F, 0.01F, 0.7F), vec3(0.2F, 1.0F, 0.1F)}};    // upright, cut by no horizon
  for (const auto& [a, b, c] : triangles) {
    const world::Scene scene = make_lit_floor(make_triangle(a, b, c), make_glow(vec3(2.0F), true));
    for (const vec3& at : {vec3(0.0F), vec3(0.6F, 0.0F, 0.3F)}) {
      const double expected = 2.0 / std::numbers::pi * test::irradiance_of({dvec3(a), dvec3(b), dvec3(c)}, dvec3(at));
      EXPECT_NEAR(mean_of(scene, make_point_view(at, 0.005F)).x / expected, 1.0, 0.004) << a.y << " " << at.x;
    }
  }
}

TEST_F(EmittersTest, RectanglesHaveTheirClosedForm) {
  // The middle and the halves of the sides.
  const std::vector<std::array<vec3, 3>> sheets = {
      {vec3(0.1F, 0.7F, -0.2F), vec3(1.0F, 0.125F, 0.0F), vec3(0.0F, 0.0F, 0.75F)},  // large
      {vec3(0.02F, 0.6F, 0.0F), vec3(0.02F, 0.0F, 0.0F), vec3(0.0F, 0.0F, 0.025F)},  // small
      {vec3(0.3F, 0.02F, 0.1F), vec3(4.0F, 0.0F, 0.0F), vec3(0.0F, 0.0F, 5.0F)},     // nearly a half space
      {vec3(-0.5F, 0.5F, 0.1F), vec3(0.0F, 0.48F, 0.0F), vec3(0.0F, 0.0F, 0.5F)}};   // upright
  for (const auto& [middle, right, up] : sheets) {
    const Mesh sheet = make_sheet(middle, right, up);
    const world::Scene scene = make_lit_floor(sheet, make_glow(vec3(2.0F), true));
    const std::vector<dvec3> corners(sheet.positions.begin(), sheet.positions.end());
    for (const vec3& at : {vec3(0.0F), vec3(0.6F, 0.0F, 0.3F)}) {
      const double expected = 2.0 / std::numbers::pi * test::irradiance_of(corners, dvec3(at));
      EXPECT_NEAR(mean_of(scene, make_point_view(at, 0.005F)).x / expected, 1.0, 0.002) << middle.y << " " << at.x;
    }
  }
}

// Two triangles light a floor like the light of EXT_lights_area of the same shape, and a sphere like the ball of light:
// E = pi L (R / d)^2 cos above the horizon.
TEST_F(EmittersTest, LampsLightLikeLightsOfTheirShape) {
  const Mesh sheet = make_sheet(vec3(0.1F, 0.8F, -0.2F), vec3(0.0F, 0.0F, 0.35F), vec3(0.6F, 0.0F, 0.0F));
  const world::Scene as_mesh = make_lit_floor(sheet, make_glow(vec3(2.0F), true));
  // Four triangles around the middle are no rectangle of two.
  Mesh parts = sheet;
  parts.positions.push_back(vec3(0.1F, 0.8F, -0.2F));
  parts.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const world::Scene as_triangles = make_lit_floor(parts, make_glow(vec3(2.0F), true));
  world::Scene as_light = make_lit_floor(world::NotDrawn{}, make_glow(vec3(0.0F)));
  Light rect;
  rect.kind = LightKind::kRect;
  rect.position = vec3(0.1F, 0.8F, -0.2F);
  rect.direction = vec3(0, -1, 0);
  rect.size = vec2(1.2F, 0.7F);
  rect.diffuse = rect.specular = vec3(2.0F);
  as_light.lights = {rect};
  for (const vec3& at : {vec3(0.0F), vec3(0.9F, 0.0F, 0.4F), vec3(-2.0F, 0.0F, 1.5F)}) {
    const View view = make_point_view(at);
    EXPECT_NEAR(mean_of(as_mesh, view).x / mean_of(as_light, view).x, 1.0, 0.004) << at.x;
    EXPECT_NEAR(mean_of(as_triangles, view).x / mean_of(as_light, view).x, 1.0, 0.004) << at.x;
  }
  const world::Scene ball = make_lit_floor(world::Sphere{vec3(0.2F, 1.5F, -0.3F), 0.9F}, make_glow(vec3(3.0F)));
  for (const vec3& at : {vec3(0.2F, 0.0F, -0.3F), vec3(1.0F, 0.0F, 0.4F)}) {
    const double d = static_cast<double>(glm::distance(at, vec3(0.2F, 1.5F, -0.3F)));
    EXPECT_NEAR(mean_of(ball, make_point_view(at)).x / (3.0 * 0.81 / (d * d) * 1.5 / d), 1.0, 0.004) << at.x;
  }
}

// A ball of many triangles lights like a sphere.
TEST_F(EmittersTest, BallsOfTrianglesLightLikeSpheres) {
  Mesh mesh;
  constexpr uint32_t kRows = 24;
  for (uint32_t i = 0; i <= kRows; ++i) {
    const double polar = std::numbers::pi * i / kRows;
    for (uint32_t j = 0; j < 2 * kRows; ++j) {
      const double azimuth = std::numbers::pi * j / kRows;
      mesh.positions.push_back(
          vec3(dvec3(0.2, 1.5, -0.3) +
               0.5 * dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth))));
      const uint32_t next = (j + 1) % (2 * kRows);
      if (i == kRows) continue;
      const auto at = [&](uint32_t row, uint32_t column) { return row * 2 * kRows + column; };
      if (i > 0) mesh.triangles.emplace_back(at(i, j), at(i, next), at(i + 1, j));
      if (i + 1 < kRows) mesh.triangles.emplace_back(at(i, next), at(i + 1, next), at(i + 1, j));
    }
  }
  const View view = make_point_view(vec3(0.6F, 0.0F, 0.1F));
  const double as_mesh = mean_of(make_lit_floor(mesh, make_glow(vec3(3.0F))), view).x;
  const double as_sphere =
      mean_of(make_lit_floor(world::Sphere{vec3(0.2F, 1.5F, -0.3F), 0.5F}, make_glow(vec3(3.0F))), view).x;
  EXPECT_NEAR(as_mesh / as_sphere, 1.0, 0.02);
}

// Inside a closed box that emits e with albedo r, each point has e + r e: one bounce of a furnace.
TEST_F(EmittersTest, FurnacesHaveOneBounce) {
  Mesh box = make_sheet(vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, 1, 0));
  const auto add = [&](const vec3& middle, const vec3& right, const vec3& up) {
    const Mesh side = make_sheet(middle, right, up);
    const auto first = static_cast<uint32_t>(box.positions.size());
    box.positions.insert(box.positions.end(), side.positions.begin(), side.positions.end());
    for (const uvec3& corners : side.triangles) box.triangles.push_back(corners + first);
  };
  add(vec3(0, 0, 1), vec3(-1, 0, 0), vec3(0, 1, 0));
  add(vec3(-1, 0, 0), vec3(0, 0, -1), vec3(0, 1, 0));
  add(vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0));
  add(vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 0, -1));
  add(vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, 1));
  world::Scene scene;
  Material material = make_diffuse(vec3(0.5F));
  material.emissive = vec3(1.0F);
  scene.materials = {material};
  scene.objects = {{"box", box, 0}};
  View view = make_lamp_view(uvec2(16));
  view.camera.eye = vec3(0.1F, 0.2F, 0.3F);
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 1.5F;
  view.samples_per_pixel = 256;
  EXPECT_NEAR(mean_of(scene, view).x, 1.5, 0.003);
  // A sphere shines to its inside, as the camera sees it.
  scene.objects = {{"sphere", world::Sphere{vec3(0.0F), 1.0F}, 0}};
  EXPECT_NEAR(mean_of(scene, view).x, 1.5, 0.003);
}

// The densities of the oracle, and so those of the device, integrate to 1: the mean of 1 / density is the solid angle.
TEST_F(EmittersTest, DensitiesIntegrateToOne) {
  const world::Scene scene = make_lamps();
  const oracle::Emitters emitters(scene);
  for (const oracle::Vector& at : {oracle::Vector(0.1L, 0, 1.6L), oracle::Vector(-0.4L, 1.6L, 0.2L)}) {
    for (int32_t object = 2; object < 7; ++object) {
      oracle::Real sum = 0;
      constexpr int kSide = 60;
      for (int i = 0; i < kSide * kSide; ++i) {
        const std::array<oracle::Real, 2> u = {(i % kSide + 0.5L) / kSide,
                                               (static_cast<oracle::Real>(i / kSide) + 0.5L) / kSide};
        sum += emitters.sample({.object = object}, at, oracle::Vector(0, 1, 0), u).inverse_density;
      }
      oracle::Real expected = 0;
      const auto& shape = scene.objects[static_cast<size_t>(object)].shape;
      if (const auto* sphere = std::get_if<world::Sphere>(&shape)) {
        const oracle::Real d = glm::distance(oracle::Vector(sphere->center), at);
        const oracle::Real cosine = std::sqrt(1 - oracle::Real(sphere->radius * sphere->radius) / (d * d));
        expected = 2 * std::numbers::pi_v<oracle::Real> * (1 - cosine);
      } else {
        const auto& mesh = std::get<Mesh>(shape);
        const uvec3 corners = mesh.triangles[0];
        expected = oracle::solid_angle_of({oracle::Vector(mesh.positions[corners.x]) - at,
                                           oracle::Vector(mesh.positions[corners.y]) - at,
                                           oracle::Vector(mesh.positions[corners.z]) - at});
      }
      EXPECT_NEAR(static_cast<double>(sum / (kSide * kSide) / expected), 1.0, 0.01) << object;
    }
  }
}

TEST_F(EmittersTest, EveryWayOfTracingHasTheSameBits) {
  View view = make_lamp_view();
  view.samples_per_pixel = 3;
  expect_same_bits(make_glossy(make_lamps()), view);
  expect_same_bits(make_lone_rectangles(), view);
}

// Lights, materials and environments can change: the picture is that of a new renderer.
TEST_F(EmittersTest, SourcesCanChange) {
  world::Scene scene = make_lamps();
  const View view = make_lamp_view();
  Renderer renderer = renderer_of(scene);
  const Image first = renderer.render(view).image;
  std::swap(scene.materials[0].emissive, scene.materials[2].emissive);
  scene.materials[1].emissive = vec3(0.5F);
  renderer.set_materials(scene.materials);
  EXPECT_TRUE(test::has_same_bits(renderer.render(view).image, renderer_of(scene).render(view).image));
  scene.lights.resize(20, scene.lights[0]);
  renderer.set_lights(scene.lights);
  EXPECT_TRUE(test::has_same_bits(renderer.render(view).image, renderer_of(scene).render(view).image));
  scene.environment.ambient = vec3(0.2F);
  renderer.set_environment(scene.environment);
  EXPECT_TRUE(test::has_same_bits(renderer.render(view).image, renderer_of(scene).render(view).image));
  View hard = view;
  hard.mode.integrator = Integrator::kWhitted;
  EXPECT_TRUE(test::has_same_bits(renderer.render(hard).image, renderer_of(scene).render(hard).image));
  scene = make_lamps();
  renderer.set_environment(scene.environment);
  renderer.set_lights(scene.lights);
  renderer.set_materials(scene.materials);
  EXPECT_TRUE(test::has_same_bits(renderer.render(view).image, first));
}

// Lamps that touch what they light, slivers, two lamps in one place, lamps of all sizes: pictures are finite, and a
// lamp does not light its own plane.
TEST_F(EmittersTest, ExtremeLampsGiveFinitePictures) {
  View view = make_lamp_view(uvec2(16, 12));
  const auto expect_finite = [&](const world::Scene& scene, const char* name) {
    for (const vec3& pixel : renderer_of(scene).render(view).image.pixels) {
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(std::isfinite(pixel[i]) && pixel[i] >= 0.0F) << name;
    }
  };
  const Material glow = make_glow(vec3(3.0F), true);
  expect_finite(make_lit_floor(make_triangle(vec3(0, 1, 0), vec3(1, 1, 0), vec3(2, 1, 0)), glow), "no area");
  expect_finite(make_lit_floor(make_triangle(vec3(0, 1, 0), vec3(1, 1, 0), vec3(0.5F, 1, 1e-6F)), glow), "sliver");
  expect_finite(make_lit_floor(make_sheet(vec3(0, 0.5F, 0), vec3(0, 0.5F, 0), vec3(0.5F, 0, 0)), glow), "touching");
  expect_finite(make_lit_floor(make_sheet(vec3(0, 0, 0), vec3(0, 0.5F, 0), vec3(0.5F, 0, 0)), glow), "crossing");
  expect_finite(make_lit_floor(world::Sphere{vec3(0.0F), 0.5F}, glow), "sunk ball");
  for (const float size : {1e-15F, 1e-6F, 1e6F, 1e12F}) {
    expect_finite(make_lit_floor(make_sheet(vec3(0, size, 0), vec3(size, 0, 0), vec3(0, 0, size)), glow), "size");
    expect_finite(make_lit_floor(world::Sphere{vec3(0.0F, 2.0F * size, 0.0F), size}, glow), "ball");
  }
  // The plane of a lamp that lies in it is not lit by the lamp: a sheet on a sheet.
  world::Scene scene =
      make_lit_floor(make_sheet(vec3(0, 0, 0), vec3(0, 0, 0.5F), vec3(0.5F, 0, 0)), make_glow(vec3(1.0F)));
  scene.objects[0].shape = make_sheet(vec3(0, 0, 0), vec3(0, 0, 4.0F), vec3(4.0F, 0, 0));
  view.camera.eye = vec3(2.0F, 0.3F, 2.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  EXPECT_EQ(mean_of(scene, view).x, 0.0);
  // Two lamps in one place are one lamp, as the camera sees it.
  scene = make_lit_floor(make_sheet(vec3(0, 1, 0), vec3(0, 0, 0.5F), vec3(0.5F, 0, 0)), glow);
  const double one = mean_of(scene, make_point_view(vec3(0.3F, 0.0F, 0.2F))).x;
  scene.objects.push_back(scene.objects[1]);
  EXPECT_NEAR(mean_of(scene, make_point_view(vec3(0.3F, 0.0F, 0.2F))).x / one, 2.0, 0.01);
}

/// A sheet that faces down, 0.8 above the floor, with texture coordinates from 0 to 1 in x and z.
Mesh make_shown_sheet() {
  Mesh sheet = make_sheet(vec3(0.0F, 0.8F, 0.0F), vec3(0.6F, 0.0F, 0.0F), vec3(0.0F, 0.0F, 0.5F));
  sheet.uvs = {vec4(0.0F), vec4(1, 0, 0, 0), vec4(1, 1, 0, 0), vec4(0, 1, 0, 0)};
  return sheet;
}

/// Returns the radiance of a white floor under the part of this sheet between two texture coordinates, whose radiance
/// is 1. `scale` is the sheet's size relative to the lit point.
double light_of_part(const dvec2& lo, const dvec2& hi, const dvec3& at, double scale = 1.0) {
  const auto corner = [&](double u, double v) {
    return at + scale * (dvec3(0.6 * (2.0 * u - 1.0), 0.8, 0.5 * (2.0 * v - 1.0)) - at);
  };
  return test::irradiance_of({corner(lo.x, lo.y), corner(hi.x, lo.y), corner(hi.x, hi.y), corner(lo.x, hi.y)}, at) /
         std::numbers::pi;
}

/// Adds a texture of 2 by 2 texels, which are shown as squares of one colour. Returns its number.
uint32_t add_texels(world::Scene& scene, const std::vector<uint32_t>& texels) {
  Scene textured;
  textured.images = scene.images;
  textured.textures = scene.textures;
  const uint32_t number = test::add_texture(textured, uvec2(2), texels, ImageUse::kColor);
  scene.images = textured.images;
  scene.textures = textured.textures;
  return number;
}

constexpr uint32_t kBlackTexel = 0xFF000000;
constexpr uint32_t kRedTexel = 0xFF0000FF;
constexpr uint32_t kGreenTexel = 0xFF00FF00;
constexpr uint32_t kWhiteTexel = 0xFFFFFFFF;

void expect_near_by_channel(const dvec3& mean, const dvec3& expected, const char* what, double share = 0.005) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(mean[channel], expected[channel], share * expected[channel]) << what << " " << channel;
  }
}

// The quarters of a sheet have their own colours: each lights a floor by Lambert's formula. A copy, and an instance
// that is turned, stretched and mirrored, give the same light.
TEST_F(EmittersTest, TexturesOfEmissionHaveTheirClosedForm) {
  const dvec3 at(0.3, 0.0, 0.2);
  const double red = light_of_part(dvec2(0.0), dvec2(0.5), at);
  const double green = light_of_part(dvec2(0.5, 0.0), dvec2(1.0, 0.5), at);
  const double white = light_of_part(dvec2(0.5), dvec2(1.0), at);
  world::Scene scene = make_lit_floor(make_shown_sheet(), make_glow(vec3(2.0F)));
  scene.materials[1].emissive_texture.texture = add_texels(scene, {kRedTexel, kGreenTexel, kBlackTexel, kWhiteTexel});
  const View view = make_point_view(vec3(at));
  const dvec3 expected = 2.0 * dvec3(red + white, green + white, white);
  expect_near_by_channel(mean_of(scene, view), expected, "copy");
  dmat4 map(dmat3(dvec3(0.0, 2.0, 0.5), dvec3(0.7, 0.0, 0.1), dvec3(0.0, -0.4, 1.5)));
  map[3] = dvec4(0.1, 0.7, -0.2, 1.0);
  for (const double side : {1.0, -1.0}) {
    map[1] *= side;
    world::Scene instanced = scene;
    instanced.objects[1].shape = world::NotDrawn{};
    instanced.meshes = {world::place(make_shown_sheet(), glm::inverse(map))};
    instanced.instances = {{1, 0, world::map_of(map)}};
    expect_near_by_channel(mean_of(instanced, view), expected, "instance");
  }
  // A triangle that shows black texels alone is not chosen, and a black lamp lights nothing.
  scene.materials[1].emissive_texture.texture = add_texels(scene, {kBlackTexel, kBlackTexel, kBlackTexel, kBlackTexel});
  EXPECT_EQ(mean_of(scene, view), dvec3(0.0));
  auto& uvs = std::get<Mesh>(scene.objects[1].shape).uvs;
  scene.materials[1].emissive_texture.texture = add_texels(scene, {kWhiteTexel, kBlackTexel, kBlackTexel, kBlackTexel});
  expect_near_by_channel(mean_of(scene, view), dvec3(2.0 * red), "one texel", 0.01);
  for (vec4& uv : uvs) uv += vec4(-7.0F, 12.0F, 0.0F, 0.0F);
  expect_near_by_channel(mean_of(scene, view), dvec3(2.0 * red), "repeated", 0.01);
}

// Holes of masks emit nothing. A blending lamp emits by its alpha, and light from behind passes through the rest of it.
TEST_F(EmittersTest, MasksAndBlendsHaveTheirClosedForm) {
  const dvec3 at(0.3, 0.0, 0.2);
  const dvec2 middle_top(0.5, 1.0);
  const double left = light_of_part(dvec2(0.0), middle_top, at);
  const double right = light_of_part(dvec2(0.5, 0.0), dvec2(1.0), at);
  world::Scene scene = make_lit_floor(make_shown_sheet(), make_glow(vec3(2.0F, 0.0F, 0.0F)));
  const uint32_t half = add_texels(scene, {0x00FFFFFF, 0xFFFFFFFF, 0x00FFFFFF, 0xFFFFFFFF});
  Material& masked = scene.materials[1];
  masked.alpha_mode = AlphaMode::kMask;
  std::get<MetallicRoughness>(masked.model).base_color_texture.texture = half;
  // Green and blue sheets that cover the same directions are behind it.
  const auto add_behind = [&](double scale, const Material& material) {
    Mesh sheet = make_shown_sheet();
    for (vec3& place : sheet.positions) place = vec3(at + scale * (dvec3(place) - at));
    scene.materials.push_back(material);
    scene.objects.push_back({"behind", sheet, static_cast<uint32_t>(scene.materials.size() - 1)});
  };
  Material blending = make_glow(vec3(0.0F, 3.0F, 0.0F));
  blending.alpha_mode = AlphaMode::kBlend;
  blending.alpha = 0.25F;
  add_behind(1.5, blending);
  add_behind(2.0, make_glow(vec3(0.0F, 0.0F, 4.0F)));
  const dvec3 expected(2.0 * right, 0.25 * 3.0 * left, 0.75 * 4.0 * left);
  expect_near_by_channel(mean_of(scene, make_point_view(vec3(at))), expected, "alpha");
}

// Light passes straight through a thin pane of glass, which tints it.
TEST_F(EmittersTest, GlassInFrontOfALampTintsItsLight) {
  const dvec3 at(0.3, 0.0, 0.2);
  world::Scene scene = make_lit_floor(make_shown_sheet(), make_glow(vec3(2.0F)));
  Material glass = make_diffuse(vec3(0.5F, 0.25F, 1.0F));
  std::get<MetallicRoughness>(glass.model).transmission = 1.0F;
  glass.is_double_sided = true;
  scene.materials.push_back(glass);
  scene.objects.push_back({"pane", make_sheet(vec3(0, 0.4F, 0), vec3(2, 0, 0), vec3(0, 0.1F, 2)), 2});
  const double light = 2.0 * light_of_part(dvec2(0.0), dvec2(1.0), at);
  expect_near_by_channel(mean_of(scene, make_point_view(vec3(at))), light * dvec3(0.5, 0.25, 1.0), "glass");
}

// Each sample agrees for lamps with textures, holes, alpha and coats behind panes of glass. An object has one triangle,
// because the oracle does not know the mean of a texture, which decides between triangles.
TEST_F(EmittersTest, EachSampleOfTexturedLampsBehindGlassIsTheOracles) {
  world::Scene scene = make_glossy(make_lamps());
  Mesh ceiling = make_triangle(vec3(-1.2F, 1.7F, -0.5F), vec3(0.9F, 1.8F, -0.4F), vec3(-0.3F, 1.6F, 0.9F));
  ceiling.uvs = {vec4(0.0F), vec4(1.7F, 0, 0, 0), vec4(0.3F, 2.4F, 0, 0)};
  std::swap(ceiling.triangles[0].y, ceiling.triangles[0].z);
  scene.objects[2].shape = ceiling;
  scene.materials[2].emissive_texture.texture = add_texels(scene, {kRedTexel, 0xFF80C0FF, kBlackTexel, kWhiteTexel});
  scene.materials[2].alpha_mode = AlphaMode::kMask;
  std::get<MetallicRoughness>(scene.materials[2].model).base_color_texture.texture =
      add_texels(scene, {0xFFFFFFFF, 0x00FFFFFF, 0xFFFFFFFF, 0xFFFFFFFF});
  scene.materials[3].alpha_mode = AlphaMode::kBlend;
  scene.materials[3].alpha = 0.6F;
  Material glass = make_diffuse(vec3(0.6F, 0.8F, 0.9F));
  auto& model = std::get<MetallicRoughness>(glass.model);
  model.transmission = 0.8F;
  model.specular = 1.0F;
  model.roughness = 0.0F;
  glass.is_double_sided = true;
  scene.materials.push_back(glass);
  scene.objects.push_back({"pane", make_sheet(vec3(0.2F, 1.1F, 0.3F), vec3(0.7F, 0, 0), vec3(0, 0.2F, 0.7F)),
                           static_cast<uint32_t>(scene.materials.size() - 1)});
  expect_samples(scene, make_lamp_view());
}

// Each closed shape is a furnace: a point of its inside has e + r e.
TEST_F(EmittersTest, ShapesShineToTheirInsides) {
  world::Scene scene;
  Material material = make_diffuse(vec3(0.5F));
  material.emissive = vec3(1.0F);
  scene.materials = {material};
  world::Cylinder cylinder;
  cylinder.center = vec3(4, 0, 0);
  cylinder.axis = glm::normalize(vec3(0.3F, 1.0F, 0.2F));
  cylinder.half_height = 1.2F;
  cylinder.radius = 0.9F;
  world::Cone cone;
  cone.center = vec3(8, 0, 0);
  cone.axis = vec3(0, 1, 0);
  cone.half_height = 1.0F;
  cone.radius_bottom = 1.3F;
  cone.radius_top = 0.7F;
  world::Capsule capsule;
  capsule.center = vec3(12, 0, 0);
  capsule.axis = glm::normalize(vec3(1.0F, 0.2F, 0.0F));
  capsule.half_height = 0.8F;
  capsule.radius_bottom = 1.1F;
  capsule.radius_top = 0.8F;
  scene.objects = {{"sphere", world::Sphere{vec3(0.0F), 1.0F}, 0},
                   {"cylinder", cylinder, 0},
                   {"cone", cone, 0},
                   {"capsule", capsule, 0},
                   {"box", world::Box{vec3(16, 0, 0), vec3(1.0F, 0.8F, 1.2F), vec3(0.1F, 0.2F, 0.05F)}, 0}};
  View view = make_lamp_view(uvec2(16));
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 2.0F;
  view.samples_per_pixel = 1024;
  Renderer renderer = renderer_of(scene);
  for (const float x : {0.0F, 4.0F, 8.0F, 12.0F, 16.0F}) {
    view.camera.eye = vec3(x + 0.1F, 0.15F, 0.2F);
    dvec3 sum(0.0);
    for (const vec3& pixel : renderer.render(view).image.pixels) sum += dvec3(pixel);
    EXPECT_NEAR(sum.x / 256.0, 1.5, 0.007) << x;
  }
}

// A lamp that is inside out shines away from the floor, unless it has two sides. Its light is proportional to its
// radiance, however large that is.
TEST_F(EmittersTest, SidesAndRadianceHaveTheirClosedForm) {
  const dvec3 at(0.3, 0.0, 0.2);
  const View view = make_point_view(vec3(at));
  world::Scene scene = make_lit_floor(make_shown_sheet(), make_glow(vec3(1.0F, 1e14F, 1e-14F)));
  const double light = light_of_part(dvec2(0.0), dvec2(1.0), at);
  expect_near_by_channel(mean_of(scene, view), light * dvec3(1.0, 1e14, 1e-14), "front");
  for (uvec3& corners : std::get<Mesh>(scene.objects[1].shape).triangles) std::swap(corners.y, corners.z);
  EXPECT_EQ(mean_of(scene, view), dvec3(0.0));
  scene.materials[1].is_double_sided = true;
  expect_near_by_channel(mean_of(scene, view), light * dvec3(1.0, 1e14, 1e-14), "two sides");
}

// Two triangles are joined only if they are the halves of a rectangle that emits the same light everywhere, and only if
// no triangle is left.
TEST_F(EmittersTest, TrianglesFormRectangles) {
  const Mesh sheet = make_sheet(vec3(0, 1, 0), vec3(0.5F, 0, 0), vec3(0, 0, 0.25F));
  const auto surfaces = [](const Mesh& mesh, const Material& material = make_glow(vec3(1.0F))) {
    return surfaces_of(make_lit_floor(mesh, material));
  };
  const EmissiveSurfaces whole = surfaces(sheet);
  ASSERT_EQ(whole.surfaces.size(), 1U);
  EXPECT_TRUE(whole.are_rectangles);
  EXPECT_EQ(whole.surfaces[0].area, 0.5);
  EXPECT_EQ(whole.surfaces[0].corner, 1U);
  const auto expect_apart = [&](const EmissiveSurfaces& found, const char* why) {
    EXPECT_FALSE(found.are_rectangles) << why;
    EXPECT_EQ(found.surfaces.size(), 2U) << why;
  };
  Mesh changed = sheet;
  changed.positions[3].x += 0.001F;
  expect_apart(surfaces(changed), "a corner is moved");
  changed = make_sheet(vec3(0, 1, 0), vec3(0.5F, 0, 0.001F), vec3(0, 0, 0.25F));
  expect_apart(surfaces(changed), "the angles are not right");
  changed = sheet;
  std::swap(changed.triangles[1].x, changed.triangles[1].y);
  expect_apart(surfaces(changed), "a half is turned over");
  Material cut = make_glow(vec3(1.0F));
  cut.alpha_mode = AlphaMode::kBlend;
  expect_apart(surfaces(sheet, cut), "alpha");
  Material shown = make_glow(vec3(1.0F));
  shown.emissive_texture.texture = 0;
  expect_apart(surfaces(sheet, shown), "a texture");
  world::Scene scene = make_lit_floor(sheet, make_glow(vec3(1.0F)));
  scene.objects.push_back({"triangle", make_triangle(vec3(0, 2, 0), vec3(1, 2, 0), vec3(0, 2, 1)), 1});
  EXPECT_EQ(surfaces_of(scene).surfaces.size(), 3U);
  // Shapes may be beside rectangles.
  scene.objects.back().shape = world::Sphere{vec3(0, 3, 0), 0.5F};
  EXPECT_EQ(surfaces_of(scene).surfaces.size(), 2U);
  EXPECT_TRUE(surfaces_of(scene).are_rectangles);
}

TEST_F(EmittersTest, NumbersAreSharedByWeight) {
  const std::vector<double> weights = {1.0, 0.0, 3.0, 1e-30};
  const std::vector<uint64_t> begins = share_numbers(weights);
  ASSERT_EQ(begins.size(), 5U);
  EXPECT_EQ(begins.front(), 0U);
  EXPECT_EQ(begins.back(), uint64_t{1} << 32);
  for (size_t i = 0; i < weights.size(); ++i) {
    const double chance = std::ldexp(static_cast<double>(begins[i + 1] - begins[i]), -32);
    EXPECT_NEAR(chance, (1.0 - kEvenShare) * weights[i] / 4.0 + kEvenShare / 4.0, 1e-9);
  }
}

}  // namespace
}  // namespace promin
