// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/validate.h"
#include "promin/framing.h"
#include "support/valid_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace promin {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Mesh& first_mesh(Scene& scene) {
  return std::get<Mesh>(scene.geometries[0]);
}

MetallicRoughness& metal_of(Scene& scene) {
  return std::get<MetallicRoughness>(scene.materials[1].model);
}

std::vector<std::string> places_of(const std::vector<Problem>& problems) {
  std::vector<std::string> places;
  for (const Problem& problem : problems) {
    EXPECT_FALSE(problem.what.empty() || problem.cure.empty()) << problem.sentence();
    places.push_back(problem.where);
  }
  return places;
}

/// A change that makes a valid object invalid, and the place that the error names.
template <class Thing>
struct Fault {
  const char* where;
  std::function<void(Thing&)> seed;
};

TEST(ValidateTest, EveryFaultOfASceneIsToldWithItsPlace) {
  const auto scale = [](const dvec3& factors) {
    return dmat4(dvec4(factors.x, 0, 0, 0), dvec4(0, factors.y, 0, 0), dvec4(0, 0, factors.z, 0), dvec4(0, 0, 0, 1));
  };
  const std::vector<Fault<Scene>> faults = {
      {"materials[0].ambient", [](Scene& s) { s.materials[0].phong().ambient.r = -1; }},
      {"materials[0].diffuse", [](Scene& s) { s.materials[0].phong().diffuse.g = kNan; }},
      {"materials[0].specular", [](Scene& s) { s.materials[0].phong().specular.b = kInfinity; }},
      {"materials[0].reflection", [](Scene& s) { s.materials[0].phong().reflection.r = -0.1F; }},
      {"materials[0].emissive", [](Scene& s) { s.materials[0].emissive.r = kNan; }},
      {"materials[0].shininess", [](Scene& s) { s.materials[0].phong().shininess = kInfinity; }},
      {"materials[0].diffuse_texture.texture", [](Scene& s) { s.materials[0].phong().diffuse_texture.texture = 0; }},
      {"materials[0].specular_texture.texture", [](Scene& s) { s.materials[0].phong().specular_texture.texture = 7; }},
      {"materials[0].normal_texture.texture", [](Scene& s) { s.materials[0].phong().normal_texture.texture = 0; }},
      {"materials[1].base_color", [](Scene& s) { metal_of(s).base_color.g = 1.01F; }},
      {"materials[1].base_color", [](Scene& s) { metal_of(s).base_color.b = -0.01F; }},
      {"materials[1].metallic", [](Scene& s) { metal_of(s).metallic = 1.01F; }},
      {"materials[1].metallic", [](Scene& s) { metal_of(s).metallic = -0.01F; }},
      {"materials[1].roughness", [](Scene& s) { metal_of(s).roughness = 1.01F; }},
      {"materials[1].roughness", [](Scene& s) { metal_of(s).roughness = kNan; }},
      {"materials[1].ior", [](Scene& s) { metal_of(s).ior = 0.99F; }},
      {"materials[1].ior", [](Scene& s) { metal_of(s).ior = -1; }},
      {"materials[1].ior", [](Scene& s) { metal_of(s).ior = kInfinity; }},
      {"materials[1].specular", [](Scene& s) { metal_of(s).specular = 1.01F; }},
      {"materials[1].specular", [](Scene& s) { metal_of(s).specular = -0.01F; }},
      {"materials[1].specular_color", [](Scene& s) { metal_of(s).specular_color.r = -0.01F; }},
      {"materials[1].specular_color", [](Scene& s) { metal_of(s).specular_color.r = kInfinity; }},
      {"materials[1].emissive", [](Scene& s) { s.materials[1].emissive.g = -1; }},
      {"materials[2].color", [](Scene& s) { std::get<Unlit>(s.materials[2].model).color.r = -0.01F; }},
      {"lights[0].kind", [](Scene& s) { s.lights[0].kind = static_cast<LightKind>(99); }},
      {"lights[0].diffuse", [](Scene& s) { s.lights[0].diffuse.r = -1; }},
      {"lights[0].specular", [](Scene& s) { s.lights[0].specular.r = kNan; }},
      {"lights[0].position", [](Scene& s) { s.lights[0].position.x = 2e15F; }},
      {"lights[0].direction", [](Scene& s) { s.lights[0].direction = vec3(0, 0, 2); }},
      // With a direction of this length, a spot light whose cone has half an angle of 0.02 would give no light: its
      // cosines never exceed 0.9998.
      {"lights[0].direction", [](Scene& s) { s.lights[0].direction = vec3(0, 0, 0.9998F); }},
      {"lights[0].attenuation", [](Scene& s) { s.lights[0].attenuation = static_cast<Attenuation>(99); }},
      // The product with a material's equally large number would be infinite.
      {"lights[0].diffuse", [](Scene& s) { s.lights[0].diffuse.r = 1e30F; }},
      {"materials[0].emissive", [](Scene& s) { s.materials[0].emissive.r = 1e30F; }},
      {"lights[0].range", [](Scene& s) { s.lights[0].range = kNan; }},
      {"lights[0].outer_cone_angle", [](Scene& s) { s.lights[0].inner_cone_angle = 1; }},
      {"cameras[0].eye", [](Scene& s) { s.cameras[0].eye.x = 2e15F; }},
      {"cameras[0]", [](Scene& s) { s.cameras[0].up = vec3(0, 0, 1); }},
      {"cameras[0].projection", [](Scene& s) { s.cameras[0].projection = static_cast<Projection>(99); }},
      {"cameras[0].yfov", [](Scene& s) { s.cameras[0].yfov = 4; }},
      {"cameras[0].ymag", [](Scene& s) { s.cameras[0].ymag = 0; }},
      {"cameras[0].near", [](Scene& s) { s.cameras[0].near = -1; }},
      {"cameras[0].resolution", [](Scene& s) { s.cameras[0].resolution = uvec2(512, 0); }},
      {"cameras[0].resolution", [](Scene& s) { s.cameras[0].resolution = uvec2(512, 40000); }},
      {"environment.ambient", [](Scene& s) { s.environment.ambient.r = -1; }},
      {"environment.background", [](Scene& s) { s.environment.background.r = kNan; }},
      {"environment.backdrop.bottom", [](Scene& s) { s.environment.backdrop.emplace().bottom.g = -1; }},
      {"environment.backdrop.radiance", [](Scene& s) { s.environment.backdrop.emplace().radiance = kNan; }},
      {"geometries[0].normals[1]", [](Scene& s) { first_mesh(s).normals[1] = vec3(0); }},
      {"geometries[0].normals", [](Scene& s) { first_mesh(s).normals.pop_back(); }},
      {"geometries[0].colors[2]", [](Scene& s) { first_mesh(s).colors[2].r = -1; }},
      {"geometries[0].colors", [](Scene& s) { first_mesh(s).colors.pop_back(); }},
      {"geometries[0].triangles[0]", [](Scene& s) { first_mesh(s).triangles[0].z = 3; }},
      {"geometries[0].triangle_materials[0]", [](Scene& s) { first_mesh(s).triangle_materials[0] = 3; }},
      {"geometries[0].triangle_materials", [](Scene& s) { first_mesh(s).triangle_materials.resize(2); }},
      {"objects[1].material", [](Scene& s) { s.objects[1].material = 3; }},
      {"objects[1].geometry", [](Scene& s) { s.objects[1].geometry = 5; }},
      {"objects[1].world_from_object", [](Scene& s) { s.objects[1].world_from_object[3][0] = kNan; }},
      {"objects[1].world_from_object", [](Scene& s) { s.objects[1].world_from_object[0][3] = 1; }},
      {"objects[0].world_from_object",
       [&](Scene& s) {
         s.objects[0].world_from_object = scale({1, 1, 0});
       }},
      {"objects[1].world_from_object",
       [&](Scene& s) {
         s.objects[1].world_from_object = scale({1, 1, 2});
       }},
      {"objects[0]", [&](Scene& s) { s.objects[0].world_from_object[3][0] = 2e15; }},
      {"objects[1]", [&](Scene& s) { std::get<Sphere>(s.geometries[1]).radius = 0; }},
      {"objects[3]", [&](Scene& s) { std::get<Cylinder>(s.geometries[3]).half_height = 1e16; }},
  };
  ASSERT_THAT(places_of(validate(make_valid_scene())), IsEmpty());
  for (const Fault<Scene>& fault : faults) {
    Scene scene = make_valid_scene();
    fault.seed(scene);
    EXPECT_THAT(places_of(validate(scene)), ElementsAre(fault.where));
    EXPECT_THROW(throw_if_invalid(scene), InputError) << fault.where;
  }
}

// KHR_materials_ior allows 0 besides the numbers from 1 on, and the colour of a reflection may be larger than 1.
TEST(ValidateTest, TheEndsOfRangesAreValid) {
  Scene scene = make_valid_scene();
  metal_of(scene) = {.base_color = vec3(0), .metallic = 0, .roughness = 0, .ior = 0, .specular = 0};
  metal_of(scene).specular_color = vec3(0);
  EXPECT_THAT(places_of(validate(scene)), IsEmpty());
  metal_of(scene) = {.base_color = vec3(1), .metallic = 1, .roughness = 1, .ior = 1, .specular = 1};
  metal_of(scene).specular_color = vec3(2);
  EXPECT_THAT(places_of(validate(scene)), IsEmpty());
}

TEST(ValidateTest, AVertexOutOfRangeIsTold) {
  Scene scene = make_valid_scene();
  first_mesh(scene).positions[1].y = kNan;
  EXPECT_THAT(places_of(validate(scene)), testing::Contains("geometries[0].positions[1]"));
}

TEST(ValidateTest, AllProblemsAreToldTogether) {
  Scene scene = make_valid_scene();
  scene.materials[0].phong().diffuse.r = -1;
  scene.objects[1].geometry = 77;
  EXPECT_THAT(places_of(validate(scene)), ElementsAre("materials[0].diffuse", "objects[1].geometry"));
  try {
    throw_if_invalid(scene);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 2U);
  }
}

TEST(ValidateTest, EveryFaultOfAViewIsToldWithItsPlace) {
  const std::vector<Fault<View>> faults = {
      {"view.camera.eye", [](View& v) { v.camera.eye.x = kNan; }},
      {"view.camera", [](View& v) { v.camera.look = vec3(0, 0, -2); }},
      {"view.camera.yfov", [](View& v) { v.camera.yfov = 0; }},
      {"view.camera.near", [](View& v) { v.camera.near = kNan; }},
      {"view.camera.aperture_radius",
       [](View& v) {
         v.camera.aperture_radius = kNan;
         v.camera.focus_distance = 1;
       }},
      {"view.camera.focus_distance", [](View& v) { v.camera.aperture_radius = 1; }},
      {"view.size", [](View& v) { v.size.y = 0; }},
      {"view.size", [](View& v) { v.size = uvec2(1U << 30); }},
      {"view.samples_per_pixel", [](View& v) { v.samples_per_pixel = 0; }},
      {"view.samples_per_pixel", [](View& v) { v.samples_per_pixel = kMaxSamplesPerPixel + 1; }},
      {"view.max_depth", [](View& v) { v.max_depth = kMaxDepth + 1; }},
      {"view.mode.debug_view", [](View& v) { v.mode.debug_view = static_cast<DebugView>(99); }},
      {"view.crop",
       [](View& v) {
         v.crop = PixelWindow{{4, 4}, {4, 8}};
       }},
      {"view.crop",
       [](View& v) {
         v.crop = PixelWindow{{0, 0}, {1281, 8}};
       }},
  };
  ASSERT_THAT(places_of(validate(View())), IsEmpty());
  for (const Fault<View>& fault : faults) {
    View view;
    fault.seed(view);
    EXPECT_THAT(places_of(validate(view)), ElementsAre(fault.where));
  }
}

// If validate() refuses a scene, functions that use the scene throw; they do not read data that do not exist.
TEST(ValidateTest, QuestionsToABrokenSceneThrow) {
  Scene scene = make_valid_scene();
  EXPECT_THROW(frame_scene(scene, 0.0F), UsageError);
  EXPECT_THROW(frame_scene(scene, kNan), UsageError);
  EXPECT_NO_THROW(frame_scene(scene, 1.0F));

  first_mesh(scene).triangles[0].y = 1000000;
  EXPECT_THROW(bounds_of(scene), InputError);
  EXPECT_THROW(frame_scene(scene, 1.0F), InputError);
  scene.geometries.clear();
  EXPECT_THROW(bounds_of(scene), InputError);
  EXPECT_THROW(primitive_count(scene, scene.objects[0]), InputError);
  EXPECT_EQ(primitive_count(scene, Object()), 0U);
}

}  // namespace
}  // namespace promin
