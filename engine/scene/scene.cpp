// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/scene.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "promin/error.h"
#include "promin/view.h"
#include "scene/framing.h"
#include "scene/glass.h"
#include "scene/placed_bounds.h"
#include "scene/stray_geometry.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

/// Returns the geometry of an object that has one. Throws InputError if the geometry does not exist.
const Geometry& geometry_of(const Scene& scene, const Object& object) {
  if (object.geometry < scene.geometries.size()) return scene.geometries[object.geometry];
  throw InputError({"scene.reference.range", "an object refers to a geometry that does not exist",
                    "object " + object.name, "see the problems that validate() returns"});
}

/// Returns the bounds of an object in the world, without copying its mesh.
struct BoundsInWorld {
  const dmat4& world_from_object;

  Bounds operator()(const Mesh& mesh) const {
    const bool is_moved = !Placement(world_from_object).is_identity();
    constexpr size_t kTriangles = 16384;
    Bounds bounds;
    for (const Bounds& part :
         make_parts(mesh.triangles.size(), kTriangles, 0, Bounds(), [&](size_t begin, size_t end, Bounds&some) {
           for (size_t i = begin; i < end; ++i) extend(some, mesh, i, is_moved);
         })) {
      bounds.extend(part);
    }
    return bounds;
  }
  void extend(Bounds& bounds, const Mesh& mesh, size_t triangle, bool is_moved) const {
    for (int i = 0; i < 3; ++i) {
      const uint32_t vertex = mesh.triangles[triangle][i];
      if (vertex >= mesh.positions.size()) {
        throw InputError({"scene.reference.range", "a triangle refers to a position that does not exist", "mesh",
                          "see the problems that validate() returns"});
      }
      const vec3& p = mesh.positions[vertex];
      bounds.extend(is_moved ? vec3(world_from_object * dvec4(p, 1.0)) : p);
    }
  }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)         \
  Bounds operator()(const TYPE& shape) const {                               \
    const std::optional placed = place(shape, Placement(world_from_object)); \
    return placed ? bounds_of(*placed) : Bounds();                           \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  Bounds operator()(const TYPE&) const {                                 \
    return {};                                                           \
  }
#include "promin/kinds/primitives.def"
};

/// Returns a point of an unbounded shape; nullopt for other shapes.
struct CenterOfUnbounded {
  const dmat4& world_from_object;

  template <class Bounded>
  std::optional<vec3> operator()(const Bounded&) const {
    return std::nullopt;
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  std::optional<vec3> operator()(const TYPE& shape) const {              \
    return vec3(center_of(shape, Placement(world_from_object)));         \
  }
#include "promin/kinds/primitives.def"
};

}  // namespace

Bounds frame_of(const Scene& scene) {
  const Bounds bounds = find_main_part(scene).bounds;
  if (!bounds.is_empty()) return bounds;
  vec3 center(0.0F);
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) continue;
    const auto found = std::visit(CenterOfUnbounded{object.world_from_object}, geometry_of(scene, object));
    if (!found) continue;
    center = *found;
    break;
  }
  return bounds_around(center);
}

Bounds bounds_around(const vec3& center) {
  Bounds bounds;
  bounds.extend(center - 1.0F);
  bounds.extend(center + 1.0F);
  return bounds;
}

Object& Scene::add(std::string name, Geometry geometry, uint32_t material, const dmat4& world_from_object) {
  geometries.push_back(std::move(geometry));
  objects.push_back({std::move(name), static_cast<uint32_t>(geometries.size() - 1), material, world_from_object});
  return objects.back();
}

Bounds bounds_of(const Scene& scene, const Object& object) {
  return std::visit(BoundsInWorld{object.world_from_object}, geometry_of(scene, object));
}

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Bounds& box : bounds_of_objects(scene)) bounds.extend(box);
  return bounds;
}

uint32_t primitive_count(const Geometry& geometry) {
  const auto* mesh = std::get_if<Mesh>(&geometry);
  return mesh == nullptr ? 1 : static_cast<uint32_t>(mesh->triangles.size());
}

uint32_t primitive_count(const Scene& scene, const Object& object) {
  return object.geometry == Object::kNoGeometry ? 0 : primitive_count(geometry_of(scene, object));
}

bool shows_same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.look == b.look && a.up == b.up && a.projection == b.projection && a.yfov == b.yfov &&
         a.ymag == b.ymag && a.near == b.near && a.aperture_radius == b.aperture_radius &&
         a.focus_distance == b.focus_distance;
}

uint32_t default_max_depth(const Scene& scene) {
  const auto is_glass = [&](uint32_t material) {
    return material < scene.materials.size() && is_clear(scene.materials[material]);
  };
  const auto shows_glass = [&](const Object& object) {
    if (object.geometry >= scene.geometries.size()) return false;
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
    if (mesh == nullptr || mesh->triangle_materials.empty()) return is_glass(object.material);
    return std::ranges::any_of(mesh->triangle_materials, is_glass);
  };
  return std::ranges::any_of(scene.objects, shows_glass) ? kMaxDepthOfGlass : View{}.max_depth;
}

bool shows_same(const View& a, const View& b) {
  return a.size == b.size && a.mode == b.mode && a.max_depth == b.max_depth &&
         a.occlusion_distance == b.occlusion_distance && a.filter == b.filter && a.filter_width == b.filter_width &&
         a.seed == b.seed && shows_same(a.camera, b.camera);
}

AddedLights add_default_lights(std::vector<Light>& lights, Environment& environment) {
  // A scene with a sky needs no default lights.
  if (!lights.empty() || environment.has_sky()) return {};
  lights.push_back(make_headlight());
  AddedLights added{.has_headlight = true, .has_ambient = environment.ambient == vec3(0.0F)};
  if (added.has_ambient) environment.ambient = vec3(kDefaultAmbient);
  return added;
}

AddedLights add_default_lights(Scene& scene) {
  return add_default_lights(scene.lights, scene.environment);
}

Light make_headlight() {
  Light light;
  light.name = "headlight";
  light.kind = LightKind::kHeadlight;
  return light;
}

}  // namespace promin
