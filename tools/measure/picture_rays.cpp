// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/picture_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/file.h"
#include "scene/light_kinds.h"

namespace promin::measure {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool is_black(const vec3& color) {
  return std::max({color.x, color.y, color.z}) <= 0.0F;
}

/// What a ray has hit, and the weight of what it sees.
struct Point {
  vec3 position;
  vec3 normal;            // interpolated where the mesh has normals
  vec3 geometric_normal;  // both face the ray
  vec3 direction;         // of the ray
  vec3 weight;
  uint32_t material;
};

/// The rules of shaders/shading.glsl, lights.glsl and path.glsl as far as they decide which rays there are.
class PictureRules {
 public:
  PictureRules(const world::Scene& scene, const View& view) : scene_(scene), view_(view) {
    const Bounds bounds = bounds_of(scene);
    offset_ = 1e-5F * (bounds.is_empty() ? 1.0F : glm::length(bounds.extent()));
  }

  Point point_of(const Ray& ray, const Hit& hit, const vec3& weight) const {
    const world::Object& object = scene_.objects[static_cast<size_t>(hit.object)];
    const float side = glm::dot(hit.normal, ray.direction) > 0.0F ? -1.0F : 1.0F;
    const vec3 normal = side * hit.normal;
    return {ray.origin + hit.t * ray.direction,
            side * normal_of(object, hit),
            normal,
            glm::normalize(ray.direction),
            weight,
            object.material};
  }

  /// Whether the light brings anything where nothing is between.
  bool reaches(const Light& light, const Point& point) const {
    const Material& material = scene_.materials[point.material];
    const bool has_highlight = material.shininess > 0.0F && !is_black(material.specular * light.specular);
    if (!light.is_on || (is_black(material.diffuse * light.diffuse) && !has_highlight)) return false;
    const vec3 to_light = has_place(light.kind) ? light.position - point.position : -direction_of(light);
    if (!(glm::dot(point.normal, to_light) > 0.0F)) return false;
    if (light.attenuation != Attenuation::kNone && !(glm::length(to_light) < light.range)) return false;
    return light.kind != LightKind::kSpot ||
           -glm::dot(glm::normalize(to_light), light.direction) > std::cos(light.outer_cone_angle);
  }

  Ray shadow_ray(const Light& light, const Point& point) const {
    const vec3 origin = point.position + offset_ * point.geometric_normal;
    if (has_place(light.kind)) return {origin, 0.0F, light.position - origin, 1.0F};
    return {origin, 0.0F, -direction_of(light), kInfinity};
  }

  vec3 weight_of_mirror(const Point& point) const { return point.weight * scene_.materials[point.material].reflection; }

  Ray mirror_ray(const Point& point) const {
    const vec3 mirrored = glm::reflect(point.direction, point.normal);
    const float below = std::min(0.0F, glm::dot(mirrored, point.geometric_normal));
    return {point.position + offset_ * point.geometric_normal, 0.0F,
            glm::normalize(mirrored - 2.0F * below * point.geometric_normal), kInfinity};
  }

 private:
  vec3 direction_of(const Light& light) const {
    return light.kind == LightKind::kHeadlight ? view_.camera.look : light.direction;
  }

  /// As wound or outward, with vertex normals where there are any.
  static vec3 normal_of(const world::Object& object, const Hit& hit) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr || mesh->normals.empty()) return hit.normal;
    const uvec3& corners = mesh->triangles[static_cast<size_t>(hit.primitive)];
    // Hits tell of corners as the file winds them.
    const vec2 weights = object.is_rewound ? vec2(hit.v, hit.u) : vec2(hit.u, hit.v);
    const vec3 sum = (1.0F - hit.u - hit.v) * mesh->normals[corners.x] + weights.x * mesh->normals[corners.y] +
                     weights.y * mesh->normals[corners.z];
    return glm::length(sum) > 0.0F ? glm::normalize(sum) : hit.normal;
  }

  const world::Scene& scene_;
  const View& view_;
  float offset_;
};

}  // namespace

RayCounts PictureRays::counts() const {
  RayCounts counts;
  for (const std::vector<RaySet>* sets : {&camera_stage, &mirror_stage}) {
    for (const RaySet& set : *sets) {
      const bool is_camera = sets == &camera_stage;
      (set.query == HitQuery::kAny ? counts.shadow : is_camera ? counts.primary : counts.reflection) += set.rays.size();
    }
  }
  return counts;
}

PictureRays make_picture_rays(Caster& caster, const world::Scene& scene, const View& view) {
  const PictureRules rules(scene, view);
  PictureRays all;
  RaySet rays = make_camera_rays(view.camera, view.size);
  std::vector<vec3> weights(rays.rays.size(), vec3(1.0F));
  for (uint32_t bounce = 0;; ++bounce) {
    std::vector<Hit> hits(rays.rays.size());
    caster.cast(rays.rays, hits);
    std::vector<Point> points;
    for (size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].object >= 0) points.push_back(rules.point_of(rays.rays[i], hits[i], weights[i]));
    }
    RaySet shadow{fmt::format("shadow {}", bounce), HitQuery::kAny, {}};
    for (const Light& light : scene.lights) {
      for (const Point& point : points) {
        if (rules.reaches(light, point)) shadow.rays.push_back(rules.shadow_ray(light, point));
      }
    }
    std::vector<RaySet>& stage = bounce == 0 ? all.camera_stage : all.mirror_stage;
    stage.push_back(std::move(rays));
    if (!shadow.rays.empty()) stage.push_back(std::move(shadow));

    rays = {fmt::format("mirror {}", bounce + 1), HitQuery::kNearest, {}};
    weights.clear();
    for (const Point& point : points) {
      const vec3 weight = rules.weight_of_mirror(point);
      if (is_black(weight)) continue;
      rays.rays.push_back(rules.mirror_ray(point));
      weights.push_back(weight);
    }
    if (rays.rays.empty() || bounce == view.max_depth) return all;
  }
}

void write_rays(const std::filesystem::path& file, std::span<const Ray> rays) {
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, 8), }}", rays.size());
  // Magic, version and length take 10 bytes; the data begins at a multiple of 64.
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string head("\x93NUMPY\x01\0", 8);
  head += static_cast<char>(header.size() & 0xFF);
  head += static_cast<char>(header.size() >> 8);
  head += header;
  write_file(file, {std::as_bytes(std::span(head)), std::as_bytes(rays)});
}

}  // namespace promin::measure
