// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "promin/scene.h"
#include "scene/glass.h"
#include "shapes/shapes.h"

namespace promin {

/// Returns the material of a triangle of a mesh whose object has the material `of_object`.
inline uint32_t triangle_material(const Mesh& mesh, size_t triangle, uint32_t of_object) {
  return mesh.triangle_materials.empty() ? of_object : mesh.triangle_materials[triangle];
}

/// A triangle in the world, counterclockwise as seen from outside. Solids are represented by the facets of their
/// bounds.
struct Facet {
  std::array<dvec3, 3> corners;
  /// True if the facet is also visible from behind.
  bool shows_back = true;
};

/// Calls `use` with facets until `use` returns true. Returns whether it has returned true.
template <class Use>
struct FacetFinder {
  const Scene& scene;
  const Object& object;
  const Use& use;

  bool operator()(const Mesh& mesh) const {
    const dmat4& matrix = object.world_from_object;
    const Placement placement(matrix);
    const bool is_mirrored = placement.is_mirroring();
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      Facet facet{.corners = {}, .shows_back = shows_back(mesh, t)};
      for (int i = 0; i < 3; ++i) {
        const dvec3 corner(mesh.positions[mesh.triangles[t][i]]);
        const auto place = static_cast<size_t>(is_mirrored ? 2 - i : i);
        facet.corners[place] = placement.is_identity() ? corner : dvec3(matrix * dvec4(corner, 1.0));
      }
      if (use(facet)) return true;
    }
    return false;
  }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                \
  bool operator()(const TYPE& shape) const {                                        \
    const std::optional placed = place(shape, Placement(object.world_from_object)); \
    return placed && use_box(promin::bounds_of(*placed));                           \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  bool operator()(const TYPE& /*shape*/) const {                         \
    return false;                                                        \
  }
#include "promin/kinds/primitives.def"

  bool shows_back(const Mesh& mesh, size_t triangle) const {
    const uint32_t material = triangle_material(mesh, triangle, object.material);
    return material >= scene.materials.size() || shows_backs(scene.materials[material]);
  }

  /// Calls `use` with two triangles for each of the six sides.
  bool use_box(const Bounds& bounds) const {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (const bool is_high : {false, true}) {
        const auto corner = [&](bool is_high_u, bool is_high_v) {
          dvec3 p(0.0);
          p[axis] = double{is_high ? bounds.hi[axis] : bounds.lo[axis]};
          p[u] = double{is_high_u ? bounds.hi[u] : bounds.lo[u]};
          p[v] = double{is_high_v ? bounds.hi[v] : bounds.lo[v]};
          return p;
        };
        // u x v is the direction of the axis.
        if (use(Facet{{corner(false, false), corner(is_high, !is_high), corner(true, true)}})) return true;
        if (use(Facet{{corner(false, false), corner(true, true), corner(!is_high, is_high)}})) return true;
      }
    }
    return false;
  }
};

/// Calls `use` with the facets of a valid scene, without unbounded objects, until `use` returns true. Returns whether
/// it has returned true. Ignores objects for whose index `is_skipped` returns true.
template <class IsSkipped, class Use>
bool any_facet(const Scene& scene, const IsSkipped& is_skipped, const Use& use) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.geometry == Object::kNoGeometry || is_skipped(i)) continue;
    if (std::visit(FacetFinder<Use>{scene, object, use}, scene.geometries[object.geometry])) return true;
  }
  return false;
}

}  // namespace promin
