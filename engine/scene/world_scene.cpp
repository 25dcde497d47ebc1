// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/world_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/framing.h"
#include "scene/picture_meshes.h"
#include "shapes/shapes.h"

namespace promin::world {
namespace {

struct BoundsOfShape {
  Bounds operator()(const NotDrawn&) const { return {}; }
  Bounds operator()(const Mesh& mesh) const {
    Bounds bounds;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) bounds.extend(bounds_of_triangle(mesh, i));
    return bounds;
  }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  Bounds operator()(const TYPE& shape) const {                       \
    return promin::bounds_of(shape);                                 \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  Bounds operator()(const TYPE&) const {                                 \
    return {};                                                           \
  }
#include "promin/kinds/primitives.def"
};

std::vector<vec3> place_normals(const std::vector<vec3>& normals, const Placement& placement) {
  std::vector<vec3> placed;
  placed.reserve(normals.size());
  for (const vec3& n : normals) {
    const dvec3 normal = placement.normal(dvec3(n));
    placed.emplace_back(normal / glm::length(normal));
  }
  return placed;
}

/// Tangents go along with positions; a mirroring transform exchanges the sides of bitangents.
std::vector<vec4> place_tangents(const std::vector<vec4>& tangents, const Placement& placement) {
  std::vector<vec4> placed;
  placed.reserve(tangents.size());
  for (const vec4& t : tangents) {
    const dvec3 tangent = placement.direction(dvec3(vec3(t)));
    const double length = glm::length(tangent);
    placed.emplace_back(length > 0.0 ? vec3(tangent / length) : vec3(0.0F), placement.is_mirroring() ? -t.w : t.w);
  }
  return placed;
}

struct ShapeInWorld {
  const dmat4& world_from_object;

  Shape operator()(const Mesh& mesh) const { return place(mesh, world_from_object); }
  template <class Described>
  Shape operator()(const Described& described) const {
    auto placed = promin::place(described, Placement(world_from_object));
    // A valid scene keeps the form of its shapes.
    return placed ? Shape(*placed) : Shape(NotDrawn{});
  }
};

}  // namespace

Mesh place(const Mesh& mesh, const dmat4& world_from_object) {
  const Placement placement(world_from_object);
  Mesh placed;
  if (placement.is_identity()) {
    placed.positions = mesh.positions;
  } else {
    placed.positions.reserve(mesh.positions.size());
    for (const vec3& p : mesh.positions) placed.positions.emplace_back(world_from_object * dvec4(p, 1.0));
  }
  placed.normals = place_normals(mesh.normals, placement);
  placed.colors = mesh.colors;
  placed.uvs = mesh.uvs;
  placed.tangents = place_tangents(mesh.tangents, placement);
  placed.triangles = mesh.triangles;
  placed.triangle_materials = mesh.triangle_materials;
  if (placement.is_mirroring()) {
    for (uvec3& triangle : placed.triangles) std::swap(triangle.y, triangle.z);
  }
  return placed;
}

namespace {

Object flatten(const promin::Scene& scene, const promin::Object& object, PictureMeshes* meshes) {
  Object result{object.name, NotDrawn{}, object.material};
  if (object.geometry == promin::Object::kNoGeometry) return result;
  const Geometry& geometry = scene.geometries[object.geometry];
  const std::shared_ptr<const Mesh> mesh = meshes == nullptr ? nullptr : meshes->find(object);
  const ShapeInWorld in_world{object.world_from_object};
  result.shape = mesh == nullptr ? std::visit(in_world, geometry) : in_world(*mesh);
  result.is_rewound = std::holds_alternative<Mesh>(geometry) && Placement(object.world_from_object).is_mirroring();
  return result;
}

constexpr double kFrontElevation = 0.25;
constexpr float kFrontYfov = 0.7F;
constexpr double kFrontMargin = 1.05;

Bounds box_to_look_at(const Scene& scene) {
  const Bounds bounds = bounds_of(scene);
  if (!bounds.is_empty()) return bounds;
  for (const Object& object : scene.objects) {
    if (const auto* plane = std::get_if<Plane>(&object.shape)) return bounds_around(plane->point);
  }
  return bounds_around(vec3(0.0F));
}

}  // namespace

Scene flatten(const promin::Scene& scene, Purpose purpose) {
  Scene result{scene.file, {}, scene.materials, {}, {}, scene.lights, scene.cameras, scene.environment};
  std::optional<PictureMeshes> meshes;
  if (purpose == Purpose::kPictures) {
    result.images = scene.images;
    result.textures = scene.textures;
    meshes.emplace(scene);
  }
  result.objects.reserve(scene.objects.size());
  for (const promin::Object& object : scene.objects) {
    result.objects.push_back(flatten(scene, object, meshes ? &*meshes : nullptr));
  }
  return result;
}

uint32_t primitive_count(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return static_cast<uint32_t>(mesh->triangles.size());
  return std::holds_alternative<NotDrawn>(shape) ? 0 : 1;
}

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) bounds.extend(std::visit(BoundsOfShape{}, object.shape));
  return bounds;
}

Camera look_from_front(const Scene& scene, float aspect_ratio) {
  const Bounds frame = box_to_look_at(scene);
  const dvec3 center = 0.5 * (dvec3(frame.lo) + dvec3(frame.hi));
  const dvec3 half = 0.5 * (dvec3(frame.hi) - dvec3(frame.lo));
  const double sine = std::sin(kFrontElevation);
  const double cosine = std::cos(kFrontElevation);
  // Differences from 0 are never -0.
  const dvec3 look(0.0, 0.0 - sine, 0.0 - cosine);
  const dvec3 up(0.0, cosine, 0.0 - sine);
  const double tan_y = std::tan(0.5 * static_cast<double>(kFrontYfov));
  const double tan_x = tan_y * static_cast<double>(aspect_ratio);

  // The least distance at which each corner of the box lies within both fields of view.
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
    const dvec3 offset = sign * half;
    const double across = std::max(std::abs(offset.x) / tan_x, std::abs(glm::dot(offset, up)) / tan_y);
    distance = std::max(distance, across - glm::dot(offset, look));
  }
  distance *= kFrontMargin;
  // A lone point has no size to go by.
  if (distance == 0.0) distance = 1.0;
  // Far from the origin the eye must still be another fp32 number than what it looks at.
  const dvec3 magnitude = glm::abs(center);
  distance = std::max(distance, 0x1p-20 * std::max({magnitude.x, magnitude.y, magnitude.z}));

  Camera camera;
  camera.name = "framing";
  camera.eye = vec3(center - distance * look);
  camera.look = vec3(look);
  camera.up = vec3(up);
  camera.yfov = kFrontYfov;
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

AddedLights add_default_lights(Scene& scene) {
  return promin::add_default_lights(scene.lights, scene.environment);
}

Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle) {
  Bounds bounds;
  const uvec3 corners = mesh.triangles[triangle];
  for (int i = 0; i < 3; ++i) bounds.extend(mesh.positions[corners[i]]);
  return bounds;
}

bool is_degenerate(const Mesh& mesh, uint32_t triangle) {
  const uvec3 corners = mesh.triangles[triangle];
  const dvec3 a(mesh.positions[corners.x]);
  // Differences of nearby fp32 numbers and their products are exact in double, so collinear means exactly zero.
  return glm::cross(dvec3(mesh.positions[corners.y]) - a, dvec3(mesh.positions[corners.z]) - a) == dvec3(0.0);
}

}  // namespace promin::world
