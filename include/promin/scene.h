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

/// A geometry in its place, with a material. Its index in Scene::objects is the number that hits and AOVs give.
struct Object {
  /// The `geometry` of an object that shows none.
  static constexpr uint32_t kNoGeometry = std::numeric_limits<uint32_t>::max();

  /// For people; empty where there is none.
  std::string name;
  /// Index into Scene::geometries, which several objects may share. kNoGeometry: nothing is drawn, the object only
  /// takes its number (points, lines, something hidden).
  uint32_t geometry = kNoGeometry;
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Affine, not singular; the identity by default. A shape must keep its form under it (promin/shapes.h says how);
  /// meshes take any that is not singular.
  dmat4 world_from_object{1.0};
};

/// An extension of the format that a scene's file has.
struct FileExtension {
  /// As "KHR_materials_ior".
  std::string name;
  /// Whether the scene has what it says, or is as without it.
  bool is_used = true;
  /// Whether the file says that it cannot be shown without.
  bool is_required = false;
};

/// A description of what is to be rendered, in a world whose unit of length is anything. It has no tree and nothing of
/// a device. Renderer and Caster read it while they are made and keep nothing of it: a later change takes effect by
/// Renderer::set_lights and its like, or with a new Renderer. load_scene gives a valid scene, validate() checks any
/// other. As any plain value it may be read by several threads while none changes it.
struct Scene {
  /// Where it was read from; empty for a scene made in memory.
  std::filesystem::path file;
  /// Where the origin of the scene lies in the world: places in the scene are those in the world less this, which was
  /// subtracted in double. load_scene moves what lies so far from the world's origin that fp32 is too coarse for it;
  /// 0 otherwise. Nothing but the programs and Python's module adds it.
  dvec3 center{0.0};
  /// What objects are made of, each once.
  std::vector<Geometry> geometries;
  /// What is in the scene, in the order that hits and AOVs number.
  std::vector<Object> objects;
  /// The number that the file has for each object, where one object of the file is several here, as in NFF; promin's
  /// commands show these. Empty where the file numbers objects as they lie here.
  std::vector<uint32_t> object_numbers;
  /// Not empty where there are objects with a geometry.
  std::vector<Material> materials;
  /// What textures show; shared, because images are large. Not null.
  std::vector<std::shared_ptr<const TextureImage>> images;
  /// What materials name.
  std::vector<Texture> textures;
  /// Any number, none too: see light_scene (promin/lighting.h) and add_default_lights.
  std::vector<Light> lights;
  /// In depth-first order of the nodes that carry them. Empty where the file has none: see frame_scene
  /// (promin/framing.h).
  std::vector<Camera> cameras;
  /// Ambient light and background.
  Environment environment;
  /// Whether it was written for classic light: an NFF file, or a glTF file all of whose materials are Phong's as
  /// written (PROMIN_materials_phong). Without lights such a scene gets a headlight, any other a studio.
  bool is_classic = false;
  /// The names of the variants of materials that the file has (LoadOptions::material_variant).
  std::vector<std::string> variants;
  /// The extensions of the file, in its order; empty for a format that has none.
  std::vector<FileExtension> extensions;
  /// What the file asks for and the renderer does not model, and what it assumed instead; one sentence each.
  std::vector<std::string> warnings;

  /// Adds a geometry and an object that shows it, with the material of this index. The reference is valid until objects
  /// are added or removed.
  PROMIN_EXPORT Object& add(std::string name, Geometry geometry, uint32_t material = 0,
                            const dmat4& world_from_object = dmat4(1.0));
};

/// Bounds of everything finite in the world; empty if there is nothing finite. Throws InputError where an object or a
/// triangle names what is not there.
PROMIN_EXPORT Bounds bounds_of(const Scene& scene);

/// Number of an object's primitives: that of its geometry, or 0 where it has none. Throws InputError where the object
/// names a geometry that is not there.
PROMIN_EXPORT uint32_t primitive_count(const Scene& scene, const Object& object);

/// The number that the scene's file has for the object at this index (Scene::object_numbers).
PROMIN_EXPORT uint32_t object_number(const Scene& scene, uint32_t object);

/// The bounces that show a scene well (View::max_depth): more where it has glass.
PROMIN_EXPORT uint32_t default_max_depth(const Scene& scene);

/// What add_default_lights has added.
struct AddedLights {
  /// Whether a headlight was added.
  bool has_headlight = false;
  /// Whether ambient light was added.
  bool has_ambient = false;
};

/// Gives a scene without lights a headlight (make_headlight), which follows the camera of each view, and ambient light
/// of kDefaultAmbient where it has none. A scene with lights or with a sky stays as it is.
PROMIN_EXPORT AddedLights add_default_lights(Scene& scene);
/// Each component of the ambient light that add_default_lights adds.
inline constexpr float kDefaultAmbient = 0.1F;

}  // namespace promin
