// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "promin/math.h"

namespace promin {

// Every shape is in world space, in the fp32 numbers that the device sees. Where a new kind of shape goes:
// its struct here, its line in `Shape` (scene.h), its functions in shapes.cpp, its packing in
// render/pack_primitives.cpp and its shader file in shaders/primitives/.

/// |P - center| = radius.
struct Sphere {
  vec3 center{0.0F};
  float radius = 0.5F;
};

/// (P - point) . normal = 0, infinite. `normal` is a unit vector to fp32 rounding.
struct Plane {
  vec3 point{0.0F};
  vec3 normal{0.0F, 1.0F, 0.0F};
};

/// A solid cylinder closed by two disks. `center` is the middle of the axis segment, `axis` a unit vector to fp32
/// rounding; the disks lie at center -+ axis * half_height.
struct Cylinder {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius = 0.25F;
};

/// A solid cone or frustum closed by its disks. The radius goes linearly from `radius_bottom` at
/// center - axis * half_height to `radius_top` at center + axis * half_height; at most one of them is 0 (the apex).
struct Cone {
  vec3 center{0.0F};
  vec3 axis{0.0F, 1.0F, 0.0F};
  float half_height = 0.25F;
  float radius_bottom = 0.25F;
  float radius_top = 0.0F;
};

/// A triangle mesh. Corners run counter-clockwise seen from outside.
struct Mesh {
  std::vector<vec3> positions;
  /// Unit vertex normals; empty (sharp polygons) or one per position.
  std::vector<vec3> normals;
  /// Linear RGBA vertex colours that multiply ambient and diffuse; empty or one per position.
  std::vector<vec4> colors;
  /// Indices into `positions`. Degenerate triangles stay here, so that numbering holds; they are never hit.
  std::vector<uvec3> triangles;
  /// Index into Scene::materials of each triangle; empty where Object::material holds for all.
  std::vector<uint32_t> triangle_materials;
};

/// Something that takes an object number but is never drawn (points, lines, a shape without a fallback).
struct NotDrawn {};

/// Conservative bounds in fp32, tight up to rounding. A Plane has none: it is unbounded and has no overload.
Bounds bounds_of(const Sphere& sphere);
Bounds bounds_of(const Cylinder& cylinder);
Bounds bounds_of(const Cone& cone);
Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle);

/// Whether a triangle can be hit at all: its corners are distinct and not exactly collinear.
bool is_degenerate(const Mesh& mesh, uint32_t triangle);

}  // namespace promin
