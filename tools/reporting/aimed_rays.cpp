// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/aimed_rays.h"

#include <cmath>

#include "measure/meshes.h"
#include "measure/ray_sets.h"
#include "oracle/oracle.h"
#include "promin/error.h"

namespace promin::report {

using measure::ray_towards;

namespace {

/// Of the enclosing mesh.
constexpr uint32_t kMeshTriangles = 1024;

/// The one primitive without a struct of its own.
constexpr const char* kTriangle = "triangle";

/// A shape of about this size, turned as it comes. Of each row of the table: what is missing does not link.
template <class Shape>
Shape make_shape(const vec3& center, float size, Random& random);

template <>
world::Sphere make_shape(const vec3& center, float size, Random& /*random*/) {
  return {center, size};
}

template <>
world::Plane make_shape(const vec3& center, float /*size*/, Random& random) {
  return {center, vec3(random.direction())};
}

template <>
world::Cylinder make_shape(const vec3& center, float size, Random& random) {
  return {center, vec3(random.direction()), size, 0.5F * size};
}

template <>
world::Cone make_shape(const vec3& center, float size, Random& random) {
  return {center, vec3(random.direction()), size, 0.8F * size, 0.0F};
}

template <>
world::Box make_shape(const vec3& center, float size, Random& random) {
  // As far as turns go.
  constexpr double kMostSine = 0.52;
  const dvec3 axis = random.direction();
  return {center, size * vec3(0.8F, 0.5F, 0.6F), vec3(kMostSine * random.uniform() * axis)};
}

template <>
world::Capsule make_shape(const vec3& center, float size, Random& random) {
  return {center, vec3(random.direction()), 0.5F * size, 0.5F * size, 0.3F * size};
}

world::Shape make_shape(const std::string& name, const dvec3& center, double size, Random& random) {
  if (name == kTriangle) return measure::make_triangle(center, random, size);
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (name == #PREFIX) return make_shape<world::TYPE>(vec3(center), static_cast<float>(size), random);
#include "promin/kinds/primitives.def"
  throw UsageError({"unknown primitive \"" + name + "\"", "", "take one of primitive_names()"});
}

// A point of an edge, a corner or a rim, where a surface is most likely to leak.

/// It has none.
dvec3 point_at_rim(const world::Sphere& sphere, Random& random) {
  return dvec3(sphere.center) + static_cast<double>(sphere.radius) * random.direction();
}

dvec3 point_at_rim(const world::Cylinder& cylinder, Random& random) {
  const dvec3 axis(cylinder.axis);
  const double side = random.uniform() < 0.5 ? 1.0 : -1.0;
  return dvec3(cylinder.center) + side * static_cast<double>(cylinder.half_height) * axis +
         static_cast<double>(cylinder.radius) * random.perpendicular(axis);
}

dvec3 point_at_rim(const world::Cone& cone, Random& random) {
  const dvec3 axis(cone.axis);
  return dvec3(cone.center) - static_cast<double>(cone.half_height) * axis +
         static_cast<double>(cone.radius_bottom) * random.perpendicular(axis);
}

/// Of an edge; every third is a corner.
dvec3 point_at_rim(const world::Box& box, Random& random) {
  dvec3 share;
  for (int i = 0; i < 3; ++i) share[i] = random.uniform() < 0.5 ? 1.0 : -1.0;
  if (random.uniform() > 1.0 / 3.0) share[static_cast<int>(3.0 * random.uniform())] *= random.uniform();
  dvec3 point(box.center);
  for (int i = 0; i < 3; ++i) {
    point += share[i] * static_cast<double>(box.half_size[i]) * dvec3(oracle::axis_of(box, i));
  }
  return point;
}

/// Of the circles where the side touches the spheres.
dvec3 point_at_rim(const world::Capsule& capsule, Random& random) {
  const dvec3 axis(capsule.axis);
  const double height = 2.0 * static_cast<double>(capsule.half_height);
  const double sine = (static_cast<double>(capsule.radius_bottom) - static_cast<double>(capsule.radius_top)) / height;
  const bool is_top = random.uniform() < 0.5;
  const double radius = is_top ? capsule.radius_top : capsule.radius_bottom;
  return dvec3(capsule.center) + ((is_top ? 0.5 : -0.5) * height + sine * radius) * axis +
         std::sqrt(1.0 - sine * sine) * radius * random.perpendicular(axis);
}

dvec3 point_at_rim(const world::Shape& shape, Random& random) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (const auto* solid = std::get_if<world::TYPE>(&shape)) return point_at_rim(*solid, random);
#include "promin/kinds/primitives.def"
  throw UsageError({"a shape that encloses nothing has no rims", "", "take a solid"});
}

}  // namespace

const std::vector<std::string>& primitive_names() {
  static const std::vector<std::string> kNames = {
#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) #PREFIX,
#include "promin/kinds/primitives.def"
  };
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
  if (name != kTriangle) {
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
