// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/ray_sets.h"

#include <cmath>
#include <random>

#include "scene/light_kinds.h"

namespace promin::measure {
namespace {

constexpr float kNoEnd = std::numeric_limits<float>::infinity();
/// Distance of a shadow ray's start from its surface, as a fraction of the scene's size.
constexpr float kShadowOffset = 1e-4F;

float size_of(const world::Scene& scene) {
  const Bounds bounds = bounds_of(scene);
  return bounds.is_empty() ? 1.0F : glm::length(bounds.extent());
}

}  // namespace

Ray ray_towards(const dvec3& origin, const dvec3& target) {
  const vec3 start(origin);
  return {start, 0.0F, vec3(glm::normalize(target - dvec3(start))), kNoEnd};
}

RaySet make_camera_rays(const Camera& camera, const uvec2& size) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half = is_orthographic ? static_cast<double>(camera.ymag)  //
                                      : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half / size.y;
  const dvec3 look(camera.look);
  const dvec3 up(camera.up);
  const dvec3 right = glm::cross(look, up);
  RaySet set{"camera", HitQuery::kNearest, {}};
  set.rays.reserve(size_t{size.x} * size.y);
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) {
      const dvec3 on_film = pixel * ((x + 0.5 - 0.5 * size.x) * right - (y + 0.5 - 0.5 * size.y) * up);
      if (is_orthographic) {
        set.rays.push_back({vec3(dvec3(camera.eye) + on_film), camera.near, camera.look, kNoEnd});
      } else {
        set.rays.push_back({camera.eye, camera.near, vec3(look + on_film), kNoEnd});
      }
    }
  }
  return set;
}

RaySet make_shadow_rays(const RaySet& camera_rays, std::span<const Hit> hits, const world::Scene& scene,
                        const Camera& camera) {
  const float size = size_of(scene);
  Light light;
  light.position = camera.eye + size * (camera.up + glm::cross(camera.look, camera.up));
  if (!scene.lights.empty()) light = scene.lights.front();
  if (light.kind == LightKind::kHeadlight) light.direction = camera.look;
  RaySet set{"shadow", HitQuery::kAny, {}};
  for (size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].object < 0) continue;
    const Ray& ray = camera_rays.rays[i];
    const vec3 facing = glm::dot(hits[i].normal, ray.direction) > 0.0F ? -hits[i].normal : hits[i].normal;
    const vec3 origin = ray.origin + hits[i].t * ray.direction + kShadowOffset * size * facing;
    if (has_place(light.kind)) {
      set.rays.push_back({origin, 0.0F, light.position - origin, 1.0F});
    } else {
      set.rays.push_back({origin, 0.0F, -light.direction, kNoEnd});
    }
  }
  return set;
}

RaySet make_random_rays(const world::Scene& scene, size_t count) {
  std::mt19937 generator(1);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator()) * 0x1p-32 - 1.0; };
  const Bounds bounds = bounds_of(scene);
  const dvec3 center(bounds.is_empty() ? vec3(0.0F) : bounds.center());
  const double radius = 0.5 * static_cast<double>(size_of(scene));
  // Points are drawn by rejection, because square roots are the same on every platform and sines are not.
  const auto point = [&] {
    dvec3 v;
    double square = 0.0;
    do {
      const double x = uniform();
      const double y = uniform();
      v = dvec3(x, y, uniform());
      square = glm::dot(v, v);
    } while (square > 1.0 || square < 1e-6);
    return center + radius / std::sqrt(square) * v;
  };
  RaySet set{"random", HitQuery::kNearest, {}};
  set.rays.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const vec3 origin(point());
    set.rays.push_back({origin, 0.0F, vec3(point() - dvec3(origin)), kNoEnd});
  }
  return set;
}

}  // namespace promin::measure
