// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "promin/scene.h"

// A scene on its way to the device: all in world space, in the fp32 numbers that the device sees. What is exact about a
// picture or a hit is exact about these numbers.
namespace promin::world {

/// Something that takes an object number but is never drawn.
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
  /// Whether it is a mesh whose triangles have their second and third corners exchanged (place).
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

/// A mesh in the world. Positions and normals are transformed in double and rounded once. A mirroring transform
/// reverses the winding, so that counter-clockwise stays outside. Under the identity positions keep their bits.
Mesh place(Mesh mesh, const dmat4& world_from_object);

/// What a scene is put into the world for.
enum class Purpose {
  /// Meshes get what textures need (scene/picture_meshes.h): more vertices, but the same triangles.
  kPictures,
  /// Rays that are cast, or a tree alone: there are neither images nor textures.
  kHits,
};

/// All objects in their order. The scene is valid.
Scene flatten(const promin::Scene& scene, Purpose purpose = Purpose::kPictures);

/// Number of triangles (degenerate ones included), 1 for an analytic shape, 0 for NotDrawn.
uint32_t primitive_count(const Shape& shape);

/// Bounds of everything finite; empty if there is nothing finite.
Bounds bounds_of(const Scene& scene);
/// A camera in front of the scene, a little above, with the corners of its bounds in the picture. Tests and what
/// measures take it where a scene has no camera, so that their pictures and numbers do not depend on how scenes are
/// framed for people (promin/framing.h).
Camera look_from_front(const Scene& scene, float aspect_ratio);
/// The same as promin::add_default_lights.
AddedLights add_default_lights(Scene& scene);

Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle);

/// Whether a triangle can be hit at all: its corners are distinct and not exactly collinear.
bool is_degenerate(const Mesh& mesh, uint32_t triangle);

}  // namespace promin::world
