// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "promin/scene.h"

// A scene prepared for the device: everything is in world space, in the fp32 numbers that the device uses. Statements
// about exact pictures and hits refer to these numbers.
namespace promin::world {

/// An object that has an index but is never drawn.
struct NotDrawn {};

/// Normals are unit vectors to fp32 rounding.
using Mesh = promin::Mesh;

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , TYPE
using Shape = std::variant<NotDrawn, Mesh
#include "promin/kinds/primitives.def"
                           >;

struct Object {
  std::string name;
  Shape shape;
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Whether it is a mesh whose triangles have exchanged second and third corners (place).
  bool is_rewound = false;
};

struct Scene {
  std::filesystem::path file;
  std::vector<Object> objects;
  std::vector<Material> materials;
  std::vector<std::shared_ptr<const TextureImage>> images;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
};

/// Returns a mesh in world space. Positions and normals are transformed in double and rounded once. A mirroring
/// transform reverses the winding, so that counterclockwise still means outside. Under the identity positions keep
/// their bits.
Mesh place(Mesh mesh, const dmat4& world_from_object);

/// The purpose of a scene in world space.
enum class Purpose {
  /// Pictures: meshes are prepared for textures (scene/picture_meshes.h), with more vertices but the same triangles.
  kPictures,
  /// Casting rays, or only a tree: there are neither images nor textures.
  kHits,
};

/// Returns all objects in world space, in their order. The scene must be valid.
Scene flatten(const promin::Scene& scene, Purpose purpose = Purpose::kPictures);

/// Number of triangles (degenerate ones included), 1 for an analytic shape, 0 for NotDrawn.
uint32_t primitive_count(const Shape& shape);

/// Bounds of everything finite; empty if there is nothing finite.
Bounds bounds_of(const Scene& scene);
/// Returns a camera in front of the scene and slightly above it, with the corners of its bounds in the picture. Tests
/// and measurements use it for scenes without a camera, so that they do not depend on how scenes are framed for people
/// (promin/framing.h).
Camera look_from_front(const Scene& scene, float aspect_ratio);
/// Does the same as promin::add_default_lights.
AddedLights add_default_lights(Scene& scene);

Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle);

/// Returns whether a triangle can never be hit, because corners coincide or are exactly collinear.
bool is_degenerate(const Mesh& mesh, uint32_t triangle);

}  // namespace promin::world
