// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "promin/instances.h"
#include "promin/scene.h"

// A scene prepared for the device. All coordinates are in world space, in the fp32 numbers that the device uses.
// Statements about exact pictures and hits refer to these numbers.
namespace promin::world {

/// An object that has an index but is never drawn.
struct NotDrawn {};

/// A mesh whose normals are unit vectors up to fp32 rounding.
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
  /// True if the object is a mesh whose triangles have their second and third corners exchanged (place).
  bool is_rewound = false;
};

/// The transform of an instance in the fp32 numbers R and c of the device: a point p of the mesh lies at c + R^-1 p.
/// Statements about exact pictures and hits refer to these numbers.
struct InstanceMap {
  /// R, from directions in the world to the space of the mesh: the inverse of the transform, rounded.
  glm::mat3 object_from_world{1.0F};
  /// c, the place of the mesh's origin.
  vec3 origin{0.0F};
};
InstanceMap map_of(const dmat4& world_from_object);

/// An object that shares a mesh. The object's shape is NotDrawn.
struct Instance {
  /// Index into Scene::objects.
  uint32_t object = 0;
  /// Index into Scene::meshes.
  uint32_t mesh = 0;
  InstanceMap map = {};
};

struct Scene {
  std::filesystem::path file;
  std::vector<Object> objects;
  /// Meshes in their own space, which instances share.
  std::vector<Mesh> meshes = {};
  /// The instances in the order of their objects.
  std::vector<Instance> instances = {};
  std::vector<Material> materials;
  std::vector<std::shared_ptr<const TextureImage>> images;
  std::vector<Texture> textures;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
};

/// Returns a mesh in world space. Positions and normals are transformed in double and rounded once. A mirroring
/// transform reverses the winding, so that counterclockwise still means outside. With the identity, positions keep
/// their bits.
Mesh place(Mesh mesh, const dmat4& world_from_object);

/// The purpose of a scene in world space.
enum class Purpose {
  /// The scene is for pictures. Meshes are prepared for textures (scene/picture_meshes.h), with more vertices but the
  /// same triangles.
  kPictures,
  /// The scene is for casting rays or for a tree. It has neither images nor textures.
  kHits,
};

/// Returns all objects in world space, in their order. The scene must be valid. Objects that become instances
/// (scene/choose_instances.h) are not drawn, and are in Scene::instances. Throws RunError if the copies of the other
/// objects are too many or do not fit into memory (scene/copies.h).
Scene flatten(const promin::Scene& scene, Purpose purpose = Purpose::kPictures,
              Instancing instancing = Instancing::kNone);

/// Returns the number of triangles, including degenerate ones; 1 for an analytic shape; 0 for NotDrawn.
uint32_t primitive_count(const Shape& shape);

/// Returns bounds of all finite geometry; empty if there is none. They are not the smallest ones if there are
/// instances.
Bounds bounds_of(const Scene& scene);
/// Returns a box that contains c + R^-1 p for every point p in the boxes, of which there is at least one.
Bounds bounds_of(const InstanceMap& map, std::span<const Bounds> boxes);
/// Returns a camera in front of the scene and slightly above it, so that all corners of its bounds are in the picture.
/// Tests and measurements use this camera for scenes without a camera, so that they do not depend on how scenes are
/// framed for people (promin/framing.h).
Camera look_from_front(const Scene& scene, float aspect_ratio);
/// Adds default lights like promin::add_default_lights().
AddedLights add_default_lights(Scene& scene);

Bounds bounds_of_triangle(const Mesh& mesh, uint32_t triangle);

/// Returns whether no ray can hit a triangle, because its corners coincide or are exactly collinear.
bool is_degenerate(const Mesh& mesh, uint32_t triangle);

}  // namespace promin::world
