// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "promin/export.h"
#include "promin/math.h"
#include "promin/shapes/box.h"
#include "promin/shapes/capsule.h"
#include "promin/shapes/cone.h"
#include "promin/shapes/cylinder.h"
#include "promin/shapes/plane.h"
#include "promin/shapes/sphere.h"

namespace promin {

/// A triangle mesh in its own space. The corners of a triangle run counter-clockwise as seen from outside.
struct Mesh {
  /// Any number of positions; no coordinate exceeds 1e15 in magnitude.
  std::vector<vec3> positions;
  /// Vertex normals of any length except 0. There is one per position, or the list is empty for flat shading.
  std::vector<vec3> normals;
  /// Vertex colours, linear RGBA. They multiply ambient and diffuse light. There is one per position, or the list is
  /// empty.
  std::vector<vec4> colors;
  /// Texture coordinates of set 0 (x, y) and set 1 (z, w), finite. There is one entry per position, or the list is
  /// empty.
  std::vector<vec4> uvs;
  /// Tangents for normal textures: xyz of any length except 0, w is 1 or -1 and gives the side of the bitangent. There
  /// is one per position, or the list is empty. For a normal texture without tangents, promin computes tangents from
  /// the texture coordinates (docs/model.md, "Textures").
  std::vector<vec4> tangents;
  /// The corners of each triangle as indices into `positions`. Degenerate triangles stay in the list so that triangle
  /// numbers do not change; no ray hits them.
  std::vector<uvec3> triangles;
  /// Index into Scene::materials for each triangle; empty if Object::material applies to all.
  std::vector<uint32_t> triangle_materials;
};

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , TYPE
/// The shape of an object: a Mesh or an analytic shape, in its own space.
using Geometry = std::variant<Mesh
#include "promin/kinds/primitives.def"
                              >;

/// Display names of the alternatives of Geometry, in the variant's order and in the plural: "meshes", "spheres", …
inline constexpr std::string_view kGeometryNames[] = {
    "meshes",
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) NAME,
#include "promin/kinds/primitives.def"
};

/// Returns the number of triangles, including degenerate ones, or 1 for an analytic shape.
PROMIN_EXPORT uint32_t primitive_count(const Geometry& geometry);

}  // namespace promin
