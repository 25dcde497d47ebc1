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

/// A triangle mesh in its own space. Corners run counter-clockwise seen from outside.
struct Mesh {
  /// Any number of positions; no coordinate exceeds 1e15 in magnitude.
  std::vector<vec3> positions;
  /// Vertex normals of any length except 0; one per position, or empty for flat shading.
  std::vector<vec3> normals;
  /// Linear RGBA vertex colours that multiply ambient and diffuse; empty or one per position.
  std::vector<vec4> colors;
  /// Texture coordinates of sets 0 (x, y) and 1 (z, w), finite; empty or one per position.
  std::vector<vec4> uvs;
  /// Tangents for normal textures: xyz of any length except 0, w = 1 or -1 for the side of the bitangent; empty or one
  /// per position. If a normal texture is used without tangents, they are computed from the texture coordinates
  /// (docs/model.md, "Textures").
  std::vector<vec4> tangents;
  /// Indices into `positions`. Degenerate triangles stay in the list so that triangle numbers do not change; they are
  /// never hit.
  std::vector<uvec3> triangles;
  /// Index into Scene::materials for each triangle; empty if Object::material applies to all.
  std::vector<uint32_t> triangle_materials;
};

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , TYPE
/// What an object is made of: a Mesh or an analytic shape, in its own space.
using Geometry = std::variant<Mesh
#include "promin/kinds/primitives.def"
                              >;

/// Names for people of the alternatives of Geometry, in its order and in the plural: "meshes", "spheres", …
inline constexpr std::string_view kGeometryNames[] = {
    "meshes",
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) NAME,
#include "promin/kinds/primitives.def"
};

/// Returns the number of triangles, including degenerate ones, or 1 for an analytic shape.
PROMIN_EXPORT uint32_t primitive_count(const Geometry& geometry);

}  // namespace promin
