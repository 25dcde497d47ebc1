// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/place_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "motion/deform.h"
#include "scene/limits.h"
#include "scene/world_scene.h"
#include "shapes/placement.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

/// The smallest determinant of a transform. With a smaller one, the transform is almost singular or overflows.
constexpr double kLeastDeterminant = 1e-100;

struct KeepsForm {
  const Placement& placement;

  bool operator()(const Mesh&) const { return true; }
  template <class Described>
  bool operator()(const Described& shape) const {
    return place(shape, placement) && is_in_range(center_of(shape, placement)) &&
           std::ranges::all_of(sizes_of(shape, placement), is_valid);
  }
};

}  // namespace

bool is_mesh_in_range(const Mesh& mesh, const Bounds& box, const dmat4& world_from_object) {
  // Usually the corners of the mesh's box decide; otherwise each vertex is tested.
  return is_in_range(box, world_from_object) || std::ranges::all_of(mesh.positions, [&](const vec3& p) {
           return is_in_range(dvec3(world_from_object * dvec4(dvec3(p), 1.0)));
         });
}

Bounds bounds_of_positions(const Mesh& mesh) {
  Bounds box;
  for (const vec3& position : mesh.positions) box.extend(position);
  return box;
}

bool is_singular(const dmat4& world_from_object) {
  const double determinant = std::abs(glm::determinant(dmat3(world_from_object)));
  return !(determinant >= kLeastDeterminant && determinant <= 1.0 / kLeastDeterminant);
}

Mesh apply_transform(Mesh mesh, const dmat4& world_from_object, bool& has_lost_normals) {
  const Placement placement(world_from_object);
  const bool has_normals = std::ranges::all_of(
      mesh.normals, [&](const vec3& normal) { return has_length(placement.normal(dvec3(normal))); });
  has_lost_normals = !has_normals;
  if (!has_normals) mesh.normals.clear();
  return world::place(std::move(mesh), world_from_object);
}

bool keeps_form(const Geometry& geometry, const dmat4& world_from_object) {
  return std::visit(KeepsForm{Placement(world_from_object)}, geometry);
}

}  // namespace promin
