// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/picture_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "oracle/lobe.h"
#include "scene/light_kinds.h"

namespace promin::measure {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool is_black(const vec3& color) {
  return std::max({color.x, color.y, color.z}) <= 0.0F;
}

/// A metallic-roughness material does not trace a mirror ray whose weight is less (LEAST_MIRROR_WEIGHT of its shader).
constexpr float kLeastMirrorWeight = 1.0F / 256.0F;

/// The point that a ray has hit, and the weight of the light from it.
struct Point {
  vec3 position{0.0F};
  /// Start of shadow rays, before it is lifted off the surface.
  vec3 shadow_position{0.0F};
  /// The normal is interpolated if the mesh has normals. Both normals face the ray.
  vec3 normal{0.0F};
  vec3 geometric_normal{0.0F};
  /// Color from the mesh's vertices.
  vec3 color{1.0F};
  /// Direction of the ray, a unit vector.
  vec3 direction{0.0F};
  vec3 weight{0.0F};
  uint32_t material = 0;
};

/// The rules of shaders/shade/shading.glsl, lights.glsl and path.glsl that determine which rays are traced.
class PictureRules {
 public:
  PictureRules(const world::Scene& scene, const View& view) : scene_(scene), view_(view) {
    const Bounds bounds = bounds_of(scene);
    offset_ = 1e-5F * (bounds.is_empty() ? 1.0F : glm::length(bounds.extent()));
  }

  Point point_of(const Ray& ray, const Hit& hit, const vec3& weight) const {
    const world::Object& object = scene_.objects[static_cast<size_t>(hit.object)];
    const float side = glm::dot(hit.normal, ray.direction) > 0.0F ? -1.0F : 1.0F;
    Point point;
    point.position = ray.origin + hit.t * ray.direction;
    point.shadow_position = point.position;
    point.geometric_normal = side * hit.normal;
    point.normal = point.geometric_normal;
    point.direction = glm::normalize(ray.direction);
    point.weight = weight;
    point.material = object.material;
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) interpolate(*mesh, object.is_rewound, hit, side, point);
    return point;
  }

  /// Returns whether the light reaches the point if nothing lies between them.
  bool reaches(const Light& light, const Point& point) const {
    if (!light.is_on) return false;
    const vec3 way = has_place(light.kind) ? light.position - point.position : -direction_of(light);
    const vec3 to_light = glm::normalize(way);
    const float cosine = glm::dot(point.normal, to_light);
    if (!(cosine > 0.0F)) return false;
    if (light.attenuation != Attenuation::kNone && !(glm::length(way) < light.range)) return false;
    if (light.kind == LightKind::kSpot && !(-glm::dot(to_light, light.direction) > std::cos(light.outer_cone_angle))) {
      return false;
    }
    const auto reflects = [&](const auto& model) { return does_reflect(model, light, point, to_light); };
    return std::visit(reflects, scene_.materials[point.material].model);
  }

  Ray shadow_ray(const Light& light, const Point& point) const {
    const vec3 origin = point.shadow_position + offset_ * point.geometric_normal;
    if (has_place(light.kind)) return {origin, 0.0F, light.position - origin, 1.0F};
    return {origin, 0.0F, -direction_of(light), kInfinity};
  }

  vec3 weight_of_mirror(const Point& point) const {
    const auto weigh = [&](const auto& model) { return mirror_weight(model, point); };
    return point.weight * std::visit(weigh, scene_.materials[point.material].model);
  }

  Ray mirror_ray(const Point& point) const {
    const vec3 mirrored = glm::reflect(point.direction, point.normal);
    const float below = std::min(0.0F, glm::dot(mirrored, point.geometric_normal));
    return {point.position + offset_ * point.geometric_normal, 0.0F,
            glm::normalize(mirrored - 2.0F * below * point.geometric_normal), kInfinity};
  }

 private:
  /// Returns whether the model reflects any light from a direction above the surface to the eye.
  static bool does_reflect(const Phong& phong, const Light& light, const Point& point, const vec3& to_light) {
    if (!is_black(phong.diffuse * point.color * light.diffuse)) return true;
    // A narrow highlight is 0 in fp32 except for directions near its own.
    const float highlight =
        glm::dot(2.0F * glm::dot(point.normal, to_light) * point.normal - to_light, -point.direction);
    return phong.shininess > 0.0F && highlight > 0.0F &&
           !is_black(phong.specular * light.specular * std::pow(std::min(highlight, 1.0F), phong.shininess));
  }
  static bool does_reflect(const MetallicRoughness& material, const Light& light, const Point& point, const vec3&) {
    const bool is_diffuse = material.metallic < 1.0F && !is_black(material.base_color * point.color * light.diffuse);
    const bool is_glossy = (material.metallic > 0.0F || material.specular > 0.0F) && !is_black(light.specular);
    return is_diffuse || is_glossy;
  }
  static bool does_reflect(const Unlit&, const Light&, const Point&, const vec3&) { return false; }

  static vec3 mirror_weight(const Phong& phong, const Point&) { return phong.reflection; }
  static vec3 mirror_weight(const MetallicRoughness& material, const Point& point) {
    const oracle::Real cosine = -glm::dot(point.normal, point.direction);
    const oracle::Lobe lobe(material, oracle::Vector(point.color),
                            oracle::look_up_lobe_shares(cosine, material.roughness));
    const vec3 weight(lobe.sharpness() * lobe.reflectance());
    return std::max({weight.x, weight.y, weight.z}) < kLeastMirrorWeight ? vec3(0.0F) : weight;
  }
  static vec3 mirror_weight(const Unlit&, const Point&) { return vec3(0.0F); }

  vec3 direction_of(const Light& light) const {
    return light.kind == LightKind::kHeadlight ? view_.camera.look : light.direction;
  }

  /// Computes the values at the point from the mesh's vertices. A hit's weights belong to the corners in the file's
  /// order.
  static void interpolate(const Mesh& mesh, bool is_rewound, const Hit& hit, float side, Point& point) {
    const uvec3& corners = mesh.triangles[static_cast<size_t>(hit.primitive)];
    const vec3 weights(1.0F - hit.u - hit.v, is_rewound ? hit.v : hit.u, is_rewound ? hit.u : hit.v);
    if (!mesh.colors.empty()) {
      point.color = vec3(0.0F);
      for (int i = 0; i < 3; ++i) point.color += weights[i] * vec3(mesh.colors[corners[i]]);
    }
    if (mesh.normals.empty()) return;
    vec3 sum(0.0F);
    for (int i = 0; i < 3; ++i) sum += weights[i] * side * mesh.normals[corners[i]];
    if (!(glm::length(sum) > 0.0F)) return;
    point.normal = glm::normalize(sum);
    // This is lift_to_curve() of shaders/shade/shading.glsl.
    vec3 lifted(0.0F);
    for (int i = 0; i < 3; ++i) {
      const vec3 normal = side * mesh.normals[corners[i]];
      const float height = std::min(0.0F, glm::dot(point.position - mesh.positions[corners[i]], normal));
      lifted += weights[i] * (point.position - height * normal);
    }
    point.shadow_position = lifted;
  }

  const world::Scene& scene_;
  const View& view_;
  float offset_;
};

}  // namespace

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

}  // namespace promin::measure
