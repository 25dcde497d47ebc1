// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/aimed_rays.h"

#include <cmath>

#include "measure/meshes.h"
#include "measure/ray_sets.h"

namespace promin::report {

using measure::ray_towards;

namespace {

/// Of the enclosing mesh.
constexpr uint32_t kMeshTriangles = 1024;

world::Shape make_shape(const std::string& name, const dvec3& center, double size, Random& random) {
  const vec3 axis(random.direction());
  const auto radius = static_cast<float>(size);
  if (name == "sphere") return world::Sphere{vec3(center), radius};
  if (name == "plane") return world::Plane{vec3(center), axis};
  if (name == "cylinder") return world::Cylinder{vec3(center), axis, radius, 0.5F * radius};
  if (name == "cone") return world::Cone{vec3(center), axis, radius, 0.8F * radius, 0.0F};
  return measure::make_triangle(center, random, size);
}

/// A point of a cylinder's or cone's rim, or of a sphere.
dvec3 point_at_rim(const world::Shape& shape, Random& random) {
  if (const auto* sphere = std::get_if<world::Sphere>(&shape)) {
    return dvec3(sphere->center) + static_cast<double>(sphere->radius) * random.direction();
  }
  const auto* cylinder = std::get_if<world::Cylinder>(&shape);
  const auto* cone = std::get_if<world::Cone>(&shape);
  const dvec3 axis(cylinder != nullptr ? cylinder->axis : cone->axis);
  const double half_height = cylinder != nullptr ? cylinder->half_height : cone->half_height;
  const double radius = cylinder != nullptr ? cylinder->radius : cone->radius_bottom;
  const double side = cylinder != nullptr && random.uniform() < 0.5 ? 1.0 : -1.0;
  return side * half_height * axis + radius * random.perpendicular(axis);
}

}  // namespace

const std::vector<std::string>& primitive_names() {
  static const std::vector<std::string> kNames = {"sphere", "plane", "cylinder", "cone", "triangle"};
  return kNames;
}

world::Scene make_primitive(const std::string& name, const dvec3& center, Random& random) {
  return measure::scene_of({make_shape(name, center, 1.0, random)}, name);
}

world::Scene make_primitives(const std::string& name, size_t count, Random& random) {
  std::vector<world::Shape> shapes;
  for (size_t i = 0; i < count; ++i) {
    shapes.push_back(make_shape(name, 4.0 * std::cbrt(random.uniform()) * random.direction(), 0.25, random));
  }
  return measure::scene_of(std::move(shapes), name);
}

std::vector<Ray> aim_rays(const world::Scene& scene, const dvec3& center, double distance, size_t count,
                          Random& random) {
  const auto* plane = std::get_if<world::Plane>(&scene.objects[0].shape);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const dvec3 view = random.direction();
    dvec3 across = random.perpendicular(view);
    // At a plane, at points of it.
    if (plane != nullptr) across = random.perpendicular(glm::normalize(dvec3(plane->normal)));
    const dvec3 target = center + 1.05 * std::sqrt(random.uniform()) * across;
    rays.push_back(ray_towards(target - distance * view, target));
  }
  return rays;
}

std::vector<Ray> make_chords(size_t count, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) rays.push_back(ray_towards(4.5 * random.direction(), 4.5 * random.direction()));
  return rays;
}

Enclosure make_enclosure(const std::string& name, size_t ray_count, Random& random) {
  if (name == "plane") return {make_primitive(name, dvec3(0.0), random), {}};
  if (name != "triangle") {
    Enclosure result{make_primitive(name, dvec3(0.0), random), {}};
    const world::Shape& shape = result.scene.objects[0].shape;
    while (result.rays.size() < ray_count) {
      const dvec3 origin = 0.05 * random.uniform() * random.direction();
      const bool is_at_rim = result.rays.size() % 4 != 0;
      result.rays.push_back(ray_towards(origin, is_at_rim ? point_at_rim(shape, random) : random.direction()));
    }
    return result;
  }
  Enclosure result{measure::make_wavy_sphere(kMeshTriangles), {}};
  const Mesh& mesh = std::get<Mesh>(result.scene.objects[0].shape);
  while (result.rays.size() < ray_count) {
    const auto index = static_cast<size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
    const uvec3& corners = mesh.triangles[index];
    // Every fourth at a vertex.
    const double share = result.rays.size() % 4 == 0 ? 0.0 : random.uniform();
    const dvec3 target = glm::mix(dvec3(mesh.positions[corners.x]), dvec3(mesh.positions[corners.y]), share);
    result.rays.push_back(ray_towards(0.2 * random.uniform() * random.direction(), target));
  }
  return result;
}

}  // namespace promin::report
