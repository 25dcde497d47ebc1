// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "promin/camera.h"
#include "promin/environment.h"
#include "promin/export.h"
#include "promin/lights.h"
#include "promin/materials.h"
#include "promin/math.h"
#include "promin/shapes.h"
#include "promin/textures.h"

namespace promin {

struct Motion;

/// A geometry with a transform and a material. Hits and AOVs identify it by its index in Scene::objects.
struct Object {
  /// The value of `geometry` for an object without geometry.
  static constexpr uint32_t kNoGeometry = std::numeric_limits<uint32_t>::max();

  /// The display name; empty if there is none.
  std::string name;
  /// Index into Scene::geometries; several objects may share a geometry. An object with kNoGeometry is not drawn and
  /// only keeps its index (for points, lines or hidden objects).
  uint32_t geometry = kNoGeometry;
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// The transform from object space to the world, affine and not singular; the identity by default. It must not
  /// distort an analytic shape (see promin/shapes.h). A mesh may have any such transform.
  dmat4 world_from_object{1.0};
};

/// A format extension that a scene's file uses.
struct FileExtension {
  /// The extension's name, e.g. "KHR_materials_ior".
  std::string name;
  /// True if promin applies the extension, false if it ignores the extension.
  bool is_used = true;
  /// True if the file declares the extension as required.
  bool is_required = false;
};

/// A description of the objects, materials, lights and cameras to render. The world's unit of length is arbitrary. A
/// Scene has neither a tree nor device data. The constructors of Renderer and Caster read it and keep no reference to
/// it: later changes take effect through Renderer::set_lights and similar functions, or in a new Renderer. load_scene
/// returns a valid scene; validate() checks any other. Several threads may read a Scene while none changes it.
struct Scene {
  /// The file that the scene was read from; empty for a scene made in memory.
  std::filesystem::path file;
  /// The world coordinates of the scene's origin. A position in the scene is the position in the world minus `center`,
  /// subtracted in double. load_scene() sets `center` for scenes so far from the world's origin that fp32 is too
  /// coarse; otherwise it is 0. Only the programs and the Python module add it again to their results.
  dvec3 center{0.0};
  /// The geometries of the objects, each stored once.
  std::vector<Geometry> geometries;
  /// The objects. Hits and AOVs number objects in this order.
  std::vector<Object> objects;
  /// The materials. There is at least one if an object has a geometry.
  std::vector<Material> materials;
  /// The images of textures, never null. Scenes share them, because images are large.
  std::vector<std::shared_ptr<const TextureImage>> images;
  /// The textures that materials refer to.
  std::vector<Texture> textures;
  /// The lights. May be empty: light_scene (promin/lighting.h) and add_default_lights add lights.
  std::vector<Light> lights;
  /// The cameras in depth-first order of their nodes. Empty if the file has none: see frame_scene (promin/framing.h).
  std::vector<Camera> cameras;
  /// The surroundings of the scene: ambient light, background, sky and backdrop.
  Environment environment;
  /// True if the scene was made for classic light: an NFF file, or a glTF file whose materials are all declared as
  /// Phong materials (PROMIN_materials_phong). If a scene has no lights, light_scene() adds a headlight to a classic
  /// scene and a studio to any other scene.
  bool is_classic = false;
  /// The nodes, skins and animations of the file, by which scene_at() changes the pose of the scene (promin/motion.h);
  /// null if nothing can move.
  std::shared_ptr<const Motion> motion;
  /// Names of the file's material variants (LoadOptions::material_variant).
  std::vector<std::string> variants;
  /// The extensions that the file uses, in the file's order; empty for formats without extensions.
  std::vector<FileExtension> extensions;
  /// Features of the file that promin does not model, and the assumptions that it made instead. Each warning is one
  /// sentence.
  std::vector<std::string> warnings;

  /// Adds a geometry and an object that has this geometry and the material with this index. Returns the object; the
  /// reference is valid until objects are added or removed.
  PROMIN_EXPORT Object& add(std::string name, Geometry geometry, uint32_t material = 0,
                            const dmat4& world_from_object = dmat4(1.0));
};

/// Returns the bounds of all finite geometry in the world; empty if there is no finite geometry. Throws InputError if
/// an object refers to a geometry that does not exist, or a triangle to a position that does not exist.
PROMIN_EXPORT Bounds bounds_of(const Scene& scene);

/// Returns the number of primitives of an object's geometry; 0 for an object without a geometry. Throws InputError if
/// the object refers to a geometry that does not exist.
PROMIN_EXPORT uint32_t primitive_count(const Scene& scene, const Object& object);

/// Returns the default of View::max_depth for a scene: the number of bounces, which is larger for scenes with glass.
PROMIN_EXPORT uint32_t default_max_depth(const Scene& scene);

/// The lights that add_default_lights() has added.
struct AddedLights {
  /// True if a headlight was added.
  bool has_headlight = false;
  /// True if ambient light was added.
  bool has_ambient = false;
};

/// Adds a headlight (make_headlight) to a scene without lights, and ambient light of kDefaultAmbient if it has none.
/// The headlight follows the camera of each view. The function does not change a scene with lights or a sky.
PROMIN_EXPORT AddedLights add_default_lights(Scene& scene);
/// Each component of the ambient light that add_default_lights adds.
inline constexpr float kDefaultAmbient = 0.1F;

}  // namespace promin
