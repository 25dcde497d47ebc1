// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "promin/camera.h"
#include "promin/export.h"
#include "promin/lights.h"
#include "promin/materials.h"
#include "promin/math.h"
#include "promin/shapes.h"

namespace promin {

/// A geometry in its place, with a material. Its index in Scene::objects is the number that hits and AOVs give.
struct Object {
  static constexpr uint32_t kNoGeometry = std::numeric_limits<uint32_t>::max();

  std::string name;
  /// Index into Scene::geometries, which several objects may share. kNoGeometry: nothing is drawn, the object only
  /// takes its number (points, lines, something hidden).
  uint32_t geometry = kNoGeometry;
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Affine. A shape must keep its form under it (promin/shapes.h says how); meshes take any that is not singular.
  dmat4 world_from_object{1.0};
};

/// What there is beside objects and lights.
struct Environment {
  /// i_a of docs/model.md.
  vec3 ambient{0.0F};
  /// What a ray brings that leaves the scene.
  vec3 background{0.0F};
};

/// A description of what is to be rendered. It has no tree and nothing of a device: any part may be changed, and what
/// is made of it (Renderer, Caster) told of the change. load_scene gives one that is valid, validate() checks any
/// other.
struct Scene {
  std::filesystem::path file;
  std::vector<Geometry> geometries;
  std::vector<Object> objects;
  /// Not empty where there are objects with a geometry.
  std::vector<Material> materials;
  std::vector<Light> lights;
  /// In depth-first order of the nodes that carry them. Empty where the file has none: see frame_scene.
  std::vector<Camera> cameras;
  Environment environment;
  /// What the file asks for and the renderer does not model, and what it assumed instead; one sentence each.
  std::vector<std::string> warnings;

  /// Adds a geometry and an object that shows it.
  PROMIN_EXPORT Object& add(std::string name, Geometry geometry, uint32_t material = 0,
                            const dmat4& world_from_object = dmat4(1.0));
};

/// Bounds of everything finite in the world; empty if there is nothing finite.
PROMIN_EXPORT Bounds bounds_of(const Scene& scene);

/// Of an object: its geometry's, or 0 where it has none.
PROMIN_EXPORT uint32_t primitive_count(const Scene& scene, const Object& object);

/// A perspective camera that looks down -Z, a little from above, and frames everything finite in the scene.
/// `aspect_ratio` is width over height of the picture.
PROMIN_EXPORT Camera frame_scene(const Scene& scene, float aspect_ratio);

/// What add_default_lights has added.
struct AddedLights {
  bool has_headlight = false;
  bool has_ambient = false;
};

/// Gives a scene without lights a headlight (make_headlight), which follows the camera of each view, and ambient light
/// of kDefaultAmbient where it has none. A scene with lights stays as it is.
PROMIN_EXPORT AddedLights add_default_lights(Scene& scene);
inline constexpr float kDefaultAmbient = 0.1F;

}  // namespace promin
