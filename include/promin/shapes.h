// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "promin/export.h"
#include "promin/math.h"

// The shapes of promin/kinds/primitives.def, each in a header of its own.
#define PROMIN_SHAPE_SOURCES
#include "promin/kinds/primitives.def"

namespace promin {

/// A triangle mesh in its own space. Corners run counter-clockwise seen from outside.
struct Mesh {
  /// Any number; none of them is beyond 1e15.
  std::vector<vec3> positions;
  /// Vertex normals of any length but 0; empty (sharp polygons) or one per position.
  std::vector<vec3> normals;
  /// Linear RGBA vertex colours that multiply ambient and diffuse; empty or one per position.
  std::vector<vec4> colors;
  /// Texture coordinates of sets 0 (x, y) and 1 (z, w), finite; empty or one per position.
  std::vector<vec4> uvs;
  /// Tangents for normal textures, xyz of any length but 0, w = 1 or -1 the side of the bitangent; empty or one per
  /// position. Where there are none and a texture of normals is shown, they are made of the texture coordinates
  /// (docs/model.md, "Textures").
  std::vector<vec4> tangents;
  /// Indices into `positions`. Degenerate triangles stay here, so that numbering holds; they are never hit.
  std::vector<uvec3> triangles;
  /// Index into Scene::materials of each triangle; empty where Object::material holds for all.
  std::vector<uint32_t> triangle_materials;
};

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , TYPE
/// What an object is made of: a Mesh or an analytic shape, in its own space.
using Geometry = std::variant<Mesh
#include "promin/kinds/primitives.def"
                              >;

/// Names for people of Geometry's alternatives, in its order, in the plural: "meshes", "spheres", …
inline constexpr std::string_view kGeometryNames[] = {
    "meshes",
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) NAME,
#include "promin/kinds/primitives.def"
};

/// Number of triangles (degenerate ones included), or 1 for an analytic shape.
PROMIN_EXPORT uint32_t primitive_count(const Geometry& geometry);

}  // namespace promin
