// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/glass_solids.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "scene/facets.h"
#include "scene/glass.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

struct BoundsOf {
  Bounds operator()(const world::NotDrawn& /*shape*/) const { return {}; }
  Bounds operator()(const Mesh& mesh) const {
    Bounds bounds;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) bounds.extend(world::bounds_of_triangle(mesh, i));
    return bounds;
  }
  Bounds operator()(const world::Plane& /*plane*/) const {
    constexpr float kAll = std::numeric_limits<float>::max();
    return {vec3(-kAll), vec3(kAll)};
  }
  template <class Solid>
  Bounds operator()(const Solid& solid) const {
    return bounds_of(solid);
  }
};

/// The position of a point relative to an axis: its coordinate along the axis from the centre, and its distance from
/// the axis.
struct BesideAxis {
  template <class Shape>
  BesideAxis(const Shape& shape, const dvec3& point) {
    const dvec3 axis = glm::normalize(dvec3(shape.axis));
    const dvec3 from_center = point - dvec3(shape.center);
    along = glm::dot(from_center, axis);
    off = glm::length(from_center - along * axis);
  }
  double along = 0.0;
  double off = 0.0;
};

struct Contains {
  dvec3 point;

  bool operator()(const world::NotDrawn& /*shape*/) const { return false; }
  bool operator()(const world::Sphere& s) const { return glm::distance(point, dvec3(s.center)) < double{s.radius}; }
  bool operator()(const world::Plane& p) const { return glm::dot(point - dvec3(p.point), dvec3(p.normal)) < 0.0; }
  bool operator()(const world::Cylinder& c) const {
    const BesideAxis at(c, point);
    return std::abs(at.along) < double{c.half_height} && at.off < double{c.radius};
  }
  bool operator()(const world::Cone& c) const {
    const BesideAxis at(c, point);
    const double share = 0.5 + 0.5 * at.along / double{c.half_height};
    return share > 0.0 && share < 1.0 && at.off < std::lerp(double{c.radius_bottom}, double{c.radius_top}, share);
  }
  bool operator()(const world::Capsule& c) const {
    // A capsule is a family of balls between its ends. A search over a convex function finds the ball nearest to the
    // point.
    const BesideAxis at(c, point);
    const auto distance = [&](double share) {
      const double center = (2.0 * share - 1.0) * double{c.half_height};
      return std::hypot(at.along - center, at.off) - std::lerp(double{c.radius_bottom}, double{c.radius_top}, share);
    };
    double lo = 0.0;
    double hi = 1.0;
    for (int i = 0; i < 100; ++i) {
      const double a = lo + (hi - lo) / 3.0;
      const double b = hi - (hi - lo) / 3.0;
      (distance(a) < distance(b) ? hi : lo) = distance(a) < distance(b) ? b : a;
    }
    return distance(0.5 * (lo + hi)) < 0.0;
  }
  bool operator()(const world::Box& b) const {
    const dvec3 turn(b.turn);
    const glm::dquat rotation(std::sqrt(std::max(0.0, 1.0 - glm::dot(turn, turn))), turn.x, turn.y, turn.z);
    const dvec3 local = glm::abs(glm::conjugate(rotation) * (point - dvec3(b.center)));
    return glm::all(glm::lessThan(local, dvec3(b.half_size)));
  }
  /// Adds up the solid angles of all triangles (van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE
  /// TBE 30).
  bool operator()(const Mesh& mesh) const {
    double sum = 0.0;
    for (const uvec3& corners : mesh.triangles) {
      const dvec3 a = dvec3(mesh.positions[corners.x]) - point;
      const dvec3 b = dvec3(mesh.positions[corners.y]) - point;
      const dvec3 c = dvec3(mesh.positions[corners.z]) - point;
      const double la = glm::length(a);
      const double lb = glm::length(b);
      const double lc = glm::length(c);
      const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
      sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), denominator);
    }
    return sum / (4.0 * std::numbers::pi) > 0.5;
  }
};

/// Returns a mesh of positions and triangles alone.
Mesh make_corners(std::vector<vec3> positions, std::vector<uvec3> triangles) {
  Mesh corners;
  corners.positions = std::move(positions);
  corners.triangles = std::move(triangles);
  return corners;
}

/// Returns the material of an object. For a mesh it is the material of the first triangle, because a mesh counts as one
/// solid.
uint32_t material_of(const world::Object& object) {
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  return mesh == nullptr ? object.material : triangle_material(*mesh, 0, object.material);
}

/// Returns whether a shape is open. No point is inside an open shape.
struct IsOpen {
  template <class Shape>
  bool operator()(const Shape& shape) const {
    if constexpr (requires { shape.is_open; }) return shape.is_open;
    return false;
  }
};

/// Returns the volume of a box, infinite if the box is unbounded. Solids are sorted by this volume.
double volume_of(const Bounds& bounds) {
  const dvec3 size = dvec3(bounds.hi) - dvec3(bounds.lo);
  return size.x * size.y * size.z;
}

bool is_within(const Bounds& bounds, const vec3& point) {
  return glm::all(glm::greaterThanEqual(point, bounds.lo)) && glm::all(glm::lessThanEqual(point, bounds.hi));
}

}  // namespace

bool GlassSolids::contains(const Solid& solid, const vec3& point) {
  if (solid.mesh == nullptr) return std::visit(Contains{dvec3(point)}, solid.shape);
  // No map changes whether a point is inside a mesh.
  return Contains{dmat3(solid.map.object_from_world) * (dvec3(point) - dvec3(solid.map.origin))}(*solid.mesh);
}

void GlassSolids::add_instances(const world::Scene& scene) {
  std::vector<std::shared_ptr<const Mesh>> meshes(scene.meshes.size());
  std::vector<Bounds> boxes(scene.meshes.size());
  for (const world::Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangles.empty()) continue;
    const uint32_t material = triangle_material(mesh, 0, scene.objects[instance.object].material);
    if (!bounds_volume(scene.materials[material])) continue;
    std::shared_ptr<const Mesh>& shared = meshes[instance.mesh];
    if (shared == nullptr) {
      shared = std::make_shared<const Mesh>(make_corners(mesh.positions, mesh.triangles));
      boxes[instance.mesh] = BoundsOf()(mesh);
    }
    const Bounds& box = boxes[instance.mesh];
    solids_.push_back({world::NotDrawn{}, instance.object, material, world::bounds_of(instance.map, {&box, 1}), shared,
                       box, instance.map});
  }
}

/// Sorts the solids by descending volume. Among equal ones instances come last, then the order is that of objects.
void GlassSolids::sort() {
  std::ranges::sort(solids_, {}, [](const Solid& solid) {
    return std::tuple(-volume_of(solid.bounds), solid.mesh != nullptr, solid.object);
  });
}

std::shared_ptr<const GlassSolids> GlassSolids::moved(const std::shared_ptr<const GlassSolids>& solids,
                                                      std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
  const auto find = [&](const Solid& solid) -> const dmat4* {
    if (solid.mesh == nullptr) return nullptr;
    const auto found =
        std::ranges::lower_bound(world_from_object, solid.object, {}, &std::pair<uint32_t, dmat4>::first);
    return found == world_from_object.end() || found->first != solid.object ? nullptr : &found->second;
  };
  if (solids == nullptr || std::ranges::none_of(solids->solids_, find)) return solids;
  GlassSolids result = *solids;
  for (Solid& solid : result.solids_) {
    const dmat4* transform = find(solid);
    if (transform == nullptr) continue;
    solid.map = world::map_of(*transform);
    solid.bounds = world::bounds_of(solid.map, {&solid.mesh_bounds, 1});
  }
  result.sort();
  return std::make_shared<const GlassSolids>(std::move(result));
}

GlassSolids::GlassSolids(const world::Scene& scene) {
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    const world::Object& object = scene.objects[i];
    if (world::primitive_count(object.shape) == 0 || std::visit(IsOpen(), object.shape)) continue;
    const uint32_t material = material_of(object);
    if (!bounds_volume(scene.materials[material])) continue;
    solids_.push_back({object.shape, i, material, std::visit(BoundsOf(), object.shape)});
    // Only the positions and triangles are needed.
    if (auto* mesh = std::get_if<Mesh>(&solids_.back().shape)) {
      *mesh = make_corners(std::move(mesh->positions), std::move(mesh->triangles));
    }
  }
  add_instances(scene);
  sort();
}

std::vector<uint32_t> GlassSolids::materials_around(const vec3& point) const {
  std::vector<uint32_t> materials;
  for (const Solid& solid : solids_) {
    if (!is_within(solid.bounds, point)) continue;
    if (contains(solid, point)) materials.push_back(solid.material);
  }
  return materials;
}

}  // namespace promin
