// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These cases compare pictures of sampled light with closed forms: lights with a size, skies, emissive surfaces, many
// lamps, and paths. Means are those of many samples, so their errors are mostly noise, which is the same on all
// drivers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hard/hard_case.h"
#include "support/lambert.h"
#include "trace/render/renderer_impl.h"

namespace promin::hard {
namespace {

Material make_lambert(float albedo, float emission = 0.0F) {
  MetallicRoughness model;
  model.base_color = vec3(albedo);
  model.metallic = 0.0F;
  model.roughness = 1.0F;
  model.specular = 0.0F;
  Material material;
  material.model = model;
  material.emissive = vec3(emission);
  return material;
}

/// Returns a white floor, and a second material that emits light.
world::Scene make_lit_plane(float emission) {
  world::Scene scene;
  scene.materials = {make_lambert(1.0F), make_lambert(0.0F, emission)};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  return scene;
}

/// Returns a view from just above a point of the floor.
View make_near_view(const vec3& point) {
  View view;
  view.size = uvec2(8);
  view.samples_per_pixel = 256;
  view.camera.eye = point + vec3(0.0F, 0.005F, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.mode.integrator = Integrator::kDirect;
  return view;
}

/// Returns |mean / expected - 1| of the red channel of a picture.
double error_of_mean(const Lab& lab, const world::Scene& scene, const View& view, double expected) {
  double sum = 0.0;
  const Image image = make_renderer(lab.device(), scene).render(view).image;
  for (const vec3& pixel : image.pixels) sum += static_cast<double>(pixel.x);
  return std::abs(sum / static_cast<double>(image.pixels.size()) / expected - 1.0);
}

Mesh make_lamp(const dvec3& a, const dvec3& b, const dvec3& c) {
  Mesh mesh;
  mesh.positions = {vec3(a), vec3(b), vec3(c)};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// A ball of light of radius R at the distance d, whose radiance is L, gives a white floor L (R / d)^2 cos.
void run_balls(Lab& lab) {
  for (const float ratio : {1e-3F, 0.1F, 0.9F}) {
    world::Scene scene = make_lit_plane(0.0F);
    Light ball;
    ball.position = vec3(0.6F, 0.8F, 0.0F);
    ball.radius = ratio * 0.8F;
    ball.attenuation = Attenuation::kInverseSquare;
    ball.diffuse = ball.specular = vec3(2.0F);
    scene.lights = {ball};
    // The light's intensity is pi R^2 L. The distance is 1.
    const double expected = 2.0 / std::numbers::pi * 0.8;
    lab.expect_at_most(fmt::format("light of a ball, |mean / closed form - 1|, R / d {:g}", 0.8 * ratio), 0.001,
                       error_of_mean(lab, scene, make_near_view(vec3(0.0F)), expected));
  }
}

/// A convex body under light of one colour from everywhere has this colour times its albedo, in each sample.
void run_white_sky(Lab& lab) {
  world::Scene scene;
  scene.materials = {make_lambert(0.5F)};
  scene.environment.ambient = scene.environment.background = vec3(1.0F);
  scene.objects = {{"ball", world::Sphere{vec3(0.0F), 1.0F}, 0}};
  View view;
  view.size = uvec2(64);
  view.camera.eye = vec3(0, 0, 4);
  view.camera.look = vec3(0, 0, -1);
  view.camera.up = vec3(0, 1, 0);
  view.camera.yfov = 0.3F;
  view.mode.integrator = Integrator::kDirect;
  double worst = 0.0;
  for (const vec3& pixel : make_renderer(lab.device(), scene).render(view).image.pixels) {
    worst = std::max(worst, std::abs(static_cast<double>(pixel.x) - 0.5));
  }
  lab.expect_at_most("sample of a ball of albedo 1/2 under a white sky, |L - 1/2|", 1e-6, worst);
}

/// Triangles that emit light: large, small, a sliver that nearly touches the floor, and nearly a half space.
void run_emissive(Lab& lab) {
  struct Lamp {
    const char* name;
    dvec3 a, b, c;
  };
  const Lamp lamps[] = {{"large", {-1.0, 0.6, -0.5}, {0.2, 0.6, 1.1}, {1.2, 0.8, -0.7}},
                        {"small", {0.0, 0.6, 0.0}, {0.02, 0.6, 0.05}, {0.05, 0.6, 0.0}},
                        {"1e-3 wide", {-0.5, 0.4, 0.2}, {0.5, 0.4, 0.2}, {0.0, 0.4, 0.201}},
                        {"half space", {-3.0, 0.02, -4.0}, {0.0, 0.02, 5.0}, {4.0, 0.02, -3.0}}};
  for (const auto& [name, a, b, c] : lamps) {
    world::Scene scene = make_lit_plane(2.0F);
    scene.objects.push_back({"lamp", make_lamp(dvec3(vec3(a)), dvec3(vec3(b)), dvec3(vec3(c))), 1});
    const double expected = 2.0 / std::numbers::pi * test::irradiance_of({a, b, c}, dvec3(0.0));
    lab.expect_at_most(fmt::format("light of a triangle, |mean / closed form - 1|, {}", name), 0.002,
                       error_of_mean(lab, scene, make_near_view(vec3(0.0F)), expected));
  }
}

/// Many lamps, one of which each sample chooses, give the sum of their closed forms. They are so small that they hardly
/// hide each other.
void run_many(Lab& lab) {
  for (const uint32_t count : {17U, 1000U}) {
    world::Scene scene = make_lit_plane(2.0F);
    Random random(63);
    double expected = 0.0;
    for (uint32_t i = 0; i < count; ++i) {
      const vec3 at(random.uniform(-2.0, 2.0), random.uniform(1.0, 2.0), random.uniform(-2.0, 2.0));
      const vec3 b = at + vec3(0.01F, 0.0F, 0.002F);
      const vec3 c = at + vec3(0.0F, 0.004F, 0.01F);
      scene.objects.push_back({"lamp", make_lamp(dvec3(at), dvec3(b), dvec3(c)), 1});
      expected += 2.0 / std::numbers::pi * test::irradiance_of({dvec3(at), dvec3(b), dvec3(c)}, dvec3(0.0));
    }
    View view = make_near_view(vec3(0.0F));
    view.size = uvec2(32);
    lab.expect_at_most(fmt::format("light of small triangles, |mean / closed form - 1|, {} lamps", count), 0.005,
                       error_of_mean(lab, scene, view, expected));
  }
}

/// Between six planes that emit 1 and scatter 0.6, each sample has the closed form of its number of bounces.
void run_paths(Lab& lab) {
  world::Scene scene;
  scene.materials = {make_lambert(0.6F, 1.0F)};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      vec3 normal(0.0F);
      normal[axis] = -side;
      scene.objects.push_back({"wall", world::Plane{(-2.0F - static_cast<float>(axis)) * normal, normal}, 0});
    }
  }
  View view;
  view.size = uvec2(32);
  view.camera.eye = vec3(0.2F, 0.1F, 0.3F);
  view.mode.integrator = Integrator::kPath;
  for (const uint32_t depth : {1U, 6U, 50U}) {
    view.max_depth = depth;
    const double expected = (1.0 - std::pow(0.6, depth + 1)) / 0.4;
    double worst = 0.0;
    for (const vec3& pixel : make_renderer(lab.device(), scene).render(view).image.pixels) {
      worst = std::max(worst, std::abs(static_cast<double>(pixel.x) / expected - 1.0));
    }
    lab.expect_at_most(fmt::format("sample in a closed box, |L / closed form - 1|, depth {}", depth), 1e-5, worst);
  }
}

constexpr HardCase kLightRows[] = {HardCase{60, "LightsWithSize", run_balls}, HardCase{61, "WhiteSky", run_white_sky},
                                   HardCase{62, "EmissiveTriangles", run_emissive}, HardCase{63, "ManyLamps", run_many},
                                   HardCase{64, "PathsInAClosedBox", run_paths}};

}  // namespace

std::span<const HardCase> light_cases() {
  return kLightRows;
}

}  // namespace promin::hard
