// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "environment/shrink_panorama.h"
#include "environment/sky_radiance.h"
#include "scene/scene_hull.h"
#include "scene/upright.h"

namespace promin::work {
namespace {

/// The distance of the ground from the lowest point of the scene, relative to the scene's size. The ground does not
/// coincide with a floor of the scene.
constexpr double kGap = 1e-4;

/// The width to which a panorama is reduced before its light is added up.
constexpr uint32_t kSkyWidth = 256;

/// Returns the light of the environment on a surface that faces Environment::up: the irradiance divided by pi.
dvec3 light_from_above(Environment environment) {
  if (!environment.has_sky()) return dvec3(environment.ambient);
  if (auto* panorama = std::get_if<Panorama>(&environment.sky)) *panorama = shrink_panorama(*panorama, kSkyWidth, 0);
  constexpr int kRings = 128;
  dvec3 sum(0.0);
  for (int i = 0; i < kRings; ++i) {
    // Equal steps of the squared sine have equal parts of the cosine's integral.
    const double sine2 = (i + 0.5) / kRings;
    for (int j = 0; j < 4 * kRings; ++j) {
      const double azimuth = 2.0 * std::numbers::pi * (j + 0.5) / (4 * kRings);
      const double across = std::sqrt(sine2);
      sum += sky_radiance(environment,
                          turn_from_y(environment.up, dvec3(across * std::sin(azimuth), std::sqrt(1.0 - sine2),
                                                            across * std::cos(azimuth))));
    }
  }
  return sum / (4.0 * kRings * kRings);
}

/// Returns the light on the ground without shadows: the irradiance divided by pi.
vec3 light_on_ground(const Scene& scene) {
  const auto has = [&]<typename Model>(const Model& /*any*/) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& m) { return std::holds_alternative<Model>(m.model); });
  };
  // The factor by which docs/model.md, "Light", defines powers.
  const double factor = has(Phong()) && !has(MetallicRoughness()) ? 1.0 : 1.0 / std::numbers::pi;
  dvec3 sum = light_from_above(scene.environment);
  for (const Light& light : scene.lights) {
    if (light.kind != LightKind::kDirectional || !light.is_on) continue;
    sum += factor * std::max(-turn_to_y(scene.environment.up, light.direction).y, 0.0) * dvec3(light.diffuse);
  }
  return vec3(sum);
}

/// Returns the smallest coordinate of a scene's geometry along a unit vector. For vectors that are not parallel to an
/// axis, stray geometry (scene/stray_geometry.h) does not count.
double lowest_in(const Scene& scene, const Bounds& bounds, const dvec3& up) {
  const dvec3 along = glm::min(up * dvec3(bounds.lo), up * dvec3(bounds.hi));
  if (glm::abs(up.x) + glm::abs(up.y) + glm::abs(up.z) == 1.0) return along.x + along.y + along.z;
  const SceneHull hull(scene);
  return glm::dot(up, hull.center() + hull.farthest(-up));
}

}  // namespace

void add_ground(Scene& scene) {
  const Bounds bounds = bounds_of(scene);
  const vec3 light = light_on_ground(scene);
  if (bounds.is_empty() || light == vec3(0.0F)) return;
  const double size = glm::length(dvec3(bounds.hi) - dvec3(bounds.lo));
  const dvec3 up(scene.environment.up);
  Plane plane;
  plane.point = vec3((lowest_in(scene, bounds, up) - kGap * size) * up + 0.0);
  plane.normal = scene.environment.up;
  Unlit catcher;
  catcher.color = light;
  catcher.catches_shadows = true;
  scene.materials.push_back({.name = "ground", .model = catcher});
  scene.add("ground", plane, static_cast<uint32_t>(scene.materials.size() - 1));
}

void refresh_ground(Scene& scene) {
  if (scene.materials.empty()) return;
  auto* catcher = std::get_if<Unlit>(&scene.materials.back().model);
  if (catcher != nullptr && catcher->catches_shadows) catcher->color = light_on_ground(scene);
}

}  // namespace promin::work
