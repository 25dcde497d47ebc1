// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/primitive_numbers.h"
#include "core/unset_vector.h"
#include "promin/error.h"
#include "promin/math.h"
#include "scene/world_scene.h"
#include "shared/layout.h"

namespace promin {

/// Attributes of vertices other than positions. Each array is empty, or has a record for every vertex so far that has
/// the attribute.
struct VertexRecords {
  /// Normals with w = 0; empty if there are no smooth meshes.
  std::vector<vec4> normals;
  std::vector<vec4> colors;
  /// Texture coordinates and tangents in the form of Mesh::uvs and Mesh::tangents.
  std::vector<vec4> uvs;
  std::vector<vec4> tangents;

  /// The number of vertices so far.
  size_t count() const { return std::max({normals.size(), colors.size(), uvs.size(), tangents.size()}); }
};

/// Primitives, boxes and surfaces in (object, primitive) order, before the tree reorders them.
struct Collected {
  /// All primitives except unbounded primitives and degenerate triangles. `surfaces` and `boxes` have the same indices.
  UnsetVector<layout::Primitive> bounded;
  UnsetVector<layout::SurfaceRecord> bounded_surfaces;
  UnsetVector<Bounds> boxes;
  std::vector<layout::Primitive> unbounded;
  std::vector<layout::SurfaceRecord> unbounded_surfaces;
  /// Attributes of the vertices; see PackedSurfaces.
  VertexRecords vertices;
  PrimitiveNumbers numbers;
  /// The number of primitives so far, of all kinds.
  uint32_t order = 0;
  uint64_t degenerate_count = 0;
};

/// Returns the value of Primitive::c.w: hashes of the object and of the primitive.
uint32_t hashes_of(size_t object, uint32_t primitive);

/// Returns the primitives of a checked scene without its instances. Throws RunError if there are more than the layout
/// can hold. `numbers_of_object` has the number of numbers that each object takes if it is an instance; it may be
/// empty.
Collected collect_primitives(const world::Scene& scene, std::span<const uint32_t> numbers_of_object = {});

/// Throws RunError with the text "`who` `count` `what`" if the count exceeds `most`.
void check_at_most(uint32_t most, size_t count, const world::Scene& scene, const char* who, const char* what,
                   const char* cure = "", Setting setting = Setting::kNone);

}  // namespace promin
