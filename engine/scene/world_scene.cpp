// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/world_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "core/free_memory.h"
#include "core/parallel.h"
#include "core/rounding.h"
#include "scene/choose_instances.h"
#include "scene/copies.h"
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

vec3 place_normal(const vec3& n, const Placement& placement) {
  const dvec3 normal = placement.normal(dvec3(n));
  return vec3(normal / glm::length(normal));
}

/// Transforms a tangent like a difference of positions. A mirroring transform exchanges the sides of bitangents.
vec4 place_tangent(const vec4& t, const Placement& placement) {
  const dvec3 tangent = placement.direction(dvec3(vec3(t)));
  const double length = glm::length(tangent);
  return {length > 0.0 ? vec3(tangent / length) : vec3(0.0F), placement.is_mirroring() ? -t.w : t.w};
}

/// Replaces each value by change(value).
template <typename Value, typename Change>
void change_all(std::vector<Value>& values, const Change& change) {
  for_each_pixel(values.size(), [&](size_t i) { values[i] = change(values[i]); });
}

struct ShapeInWorld {
  const dmat4& world_from_object;

  Shape operator()(const Mesh& mesh) const { return place(mesh, world_from_object); }
  template <class Described>
  Shape operator()(const Described& described) const {
    auto placed = promin::place(described, Placement(world_from_object));
    // In a valid scene no transform distorts its shapes.
    return placed ? Shape(*placed) : Shape(NotDrawn{});
  }
};

}  // namespace

Mesh place(Mesh mesh, const dmat4& world_from_object) {
  const Placement placement(world_from_object);
  if (!placement.is_identity()) {
    change_all(mesh.positions, [&](const vec3& p) { return vec3(world_from_object * dvec4(p, 1.0)); });
  }
  change_all(mesh.normals, [&](const vec3& n) { return place_normal(n, placement); });
  change_all(mesh.tangents, [&](const vec4& t) { return place_tangent(t, placement); });
  if (placement.is_mirroring()) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
  }
  return mesh;
}

namespace {

Object flatten(const promin::Scene& scene, const promin::Object& object, PictureMeshes* meshes) {
  Object result{object.name, NotDrawn{}, object.material};
  if (object.geometry == promin::Object::kNoGeometry) return result;
  const Geometry& geometry = scene.geometries[object.geometry];
  std::optional<Mesh> mesh = meshes == nullptr ? std::nullopt : meshes->find(object);
  result.shape = mesh ? Shape(place(std::move(*mesh), object.world_from_object))
                      : std::visit(ShapeInWorld{object.world_from_object}, geometry);
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

InstanceMap map_of(const dmat4& world_from_object) {
  return {glm::mat3(glm::inverse(dmat3(world_from_object))), vec3(world_from_object[3])};
}

namespace {

/// Adds the instances of a scene, and their meshes.
class InstanceAdder {
 public:
  InstanceAdder(const promin::Scene& scene, PictureMeshes* pictures, Scene& result)
      : scene_(scene), pictures_(pictures), result_(result) {}

  void add(uint32_t object) {
    const promin::Object& source = scene_.objects[object];
    const auto key = std::pair(source.geometry, pictures_ == nullptr ? 0 : pictures_->version_of(source));
    const auto [mesh, is_new] = meshes_.try_emplace(key, static_cast<uint32_t>(result_.meshes.size()));
    if (is_new) result_.meshes.push_back(make_mesh(source));
    result_.objects.push_back({source.name, NotDrawn{}, source.material});
    result_.instances.push_back({object, mesh->second, map_of(source.world_from_object)});
  }

 private:
  Mesh make_mesh(const promin::Object& object) {
    std::optional<Mesh> mesh = pictures_ == nullptr ? std::nullopt : pictures_->find(object);
    if (!mesh) mesh = std::get<Mesh>(scene_.geometries[object.geometry]);
    return place(std::move(*mesh), dmat4(1.0));
  }

  const promin::Scene& scene_;
  PictureMeshes* pictures_;
  Scene& result_;
  /// Meshes by geometry and version.
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> meshes_;
};

}  // namespace

Scene flatten(const promin::Scene& scene, Purpose purpose, Instancing instancing) {
  // Copies that take at most these bytes are made without a look at the free memory.
  constexpr uint64_t kFewBytes = uint64_t{256} << 20;
  const std::vector<bool> is_instance = choose_instances(scene, instancing);
  const Copies copies = count_copies(scene, is_instance);
  check_copies(copies, copies.bytes > kFewBytes ? available_memory() : std::nullopt, scene.file);
  Scene result;
  result.file = scene.file;
  result.materials = scene.materials;
  result.lights = scene.lights;
  result.cameras = scene.cameras;
  result.environment = scene.environment;
  std::optional<PictureMeshes> meshes;
  if (purpose == Purpose::kPictures) {
    result.images = scene.images;
    result.textures = scene.textures;
    meshes.emplace(scene);
  }
  result.objects.reserve(scene.objects.size());
  PictureMeshes* pictures = meshes ? &*meshes : nullptr;
  result.instances.reserve(static_cast<size_t>(std::ranges::count(is_instance, true)));
  InstanceAdder instances(scene, pictures, result);
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (is_instance[i]) {
      instances.add(i);
    } else {
      result.objects.push_back(flatten(scene, scene.objects[i], pictures));
    }
  }
  return result;
}

uint32_t primitive_count(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return static_cast<uint32_t>(mesh->triangles.size());
  return std::holds_alternative<NotDrawn>(shape) ? 0 : 1;
}

Bounds bounds_of(const world::InstanceMap& map, std::span<const Bounds> boxes) {
  const dmat3 turn = glm::inverse(dmat3(map.object_from_world));
  const dmat3 size(glm::abs(turn[0]), glm::abs(turn[1]), glm::abs(turn[2]));
  dvec3 lo(std::numeric_limits<double>::infinity());
  dvec3 hi(-std::numeric_limits<double>::infinity());
  dvec3 most(0.0);
  for (const Bounds& box : boxes) {
    const dvec3 center = 0.5 * (dvec3(box.lo) + dvec3(box.hi));
    const dvec3 half = 0.5 * (dvec3(box.hi) - dvec3(box.lo));
    const dvec3 placed = turn * center;
    const dvec3 reach = size * half;
    lo = glm::min(lo, placed - reach);
    hi = glm::max(hi, placed + reach);
    most = glm::max(most, size * glm::abs(center) + reach);
  }
  // The rounding of these sums, and of the inverse, is far smaller than this.
  const dvec3 rounding = 0x1p-40 * (most + glm::abs(dvec3(map.origin)));
  const dvec3 origin(map.origin);
  Bounds result;
  for (int i = 0; i < 3; ++i) {
    result.lo[i] = round_down(origin[i] + lo[i] - rounding[i]);
    result.hi[i] = round_up(origin[i] + hi[i] + rounding[i]);
  }
  return result;
}

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) bounds.extend(std::visit(BoundsOfShape{}, object.shape));
  std::vector<Bounds> boxes;
  for (const Mesh& mesh : scene.meshes) boxes.push_back(BoundsOfShape()(mesh));
  for (const Instance& instance : scene.instances) {
    const Bounds& box = boxes[instance.mesh];
    if (!box.is_empty()) bounds.extend(bounds_of(instance.map, {&box, 1}));
  }
  return bounds;
}

Camera look_from_front(const Scene& scene, float aspect_ratio) {
  const Bounds frame = box_to_look_at(scene);
  const dvec3 center = middle_of(frame);
  const dvec3 half = 0.5 * (dvec3(frame.hi) - dvec3(frame.lo));
  const double sine = std::sin(kFrontElevation);
  const double cosine = std::cos(kFrontElevation);
  // The subtractions from 0 prevent -0.
  const dvec3 look(0.0, 0.0 - sine, 0.0 - cosine);
  const dvec3 up(0.0, cosine, 0.0 - sine);
  const double tan_y = std::tan(0.5 * static_cast<double>(kFrontYfov));
  const double tan_x = tan_y * static_cast<double>(aspect_ratio);

  // The smallest distance at which each corner of the box lies within both fields of view.
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
    const dvec3 offset = sign * half;
    const double across = std::max(std::abs(offset.x) / tan_x, std::abs(glm::dot(offset, up)) / tan_y);
    distance = std::max(distance, across - glm::dot(offset, look));
  }
  distance *= kFrontMargin;
  // A single point has no size.
  if (distance == 0.0) distance = 1.0;
  // Far from the origin, the eye must still differ in fp32 from the point at which it looks.
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
  // Differences of nearby fp32 numbers and their products are exact in double, so the result is exactly 0 for collinear
  // corners.
  return glm::cross(dvec3(mesh.positions[corners.y]) - a, dvec3(mesh.positions[corners.z]) - a) == dvec3(0.0);
}

}  // namespace promin::world
