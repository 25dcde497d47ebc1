// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "promin/error.h"
#include "promin/view.h"
#include "scene/framing.h"
#include "scene/glass.h"
#include "scene/stray_geometry.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

constexpr double kFrameMargin = 1.05;

/// From where a box is framed.
struct Viewpoint {
  /// About +Y from +Z towards +X, and above the horizon, radians.
  double azimuth;
  double elevation;
  /// The vertical field of view, radians.
  float yfov;
};
constexpr Viewpoint kFromTheFront = {0.0, 0.25, 0.7F};
constexpr float kThreeQuarterYfov = 0.698131701F;
constexpr Viewpoint kFromThreeQuarters = {std::numbers::pi / 6.0, 17.0 * std::numbers::pi / 180.0, kThreeQuarterYfov};
constexpr Viewpoint kAtABoard = {0.0, 0.0, kThreeQuarterYfov};
constexpr Viewpoint kOntoTheGround = {std::numbers::pi / 6.0, std::numbers::pi / 4.0, kThreeQuarterYfov};

Viewpoint choose_viewpoint(const dvec3& size, Framing framing) {
  if (framing == Framing::kFront) return kFromTheFront;
  if (16.0 * size.y < std::max(size.x, size.z) && size.y <= size.z) return kOntoTheGround;
  if (4.0 * size.z < std::max(size.x, size.y)) return kAtABoard;
  return kFromThreeQuarters;
}

/// The geometry of an object that has one. Throws InputError if it is not there.
const Geometry& geometry_of(const Scene& scene, const Object& object) {
  if (object.geometry < scene.geometries.size()) return scene.geometries[object.geometry];
  throw InputError(
      {"an object names a geometry that is not there", "object " + object.name, "see what validate() tells"});
}

/// Computes the bounds of an object in the world, without a copy of its mesh.
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
        throw InputError({"a triangle names a position that is not there", "in a mesh", "see what validate() tells"});
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

/// The place of an unbounded shape; nullopt for other shapes.
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
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) continue;
    bounds.extend(bounds_of(scene, object));
  }
  return bounds;
}

uint32_t primitive_count(const Geometry& geometry) {
  const auto* mesh = std::get_if<Mesh>(&geometry);
  return mesh == nullptr ? 1 : static_cast<uint32_t>(mesh->triangles.size());
}

uint32_t primitive_count(const Scene& scene, const Object& object) {
  return object.geometry == Object::kNoGeometry ? 0 : primitive_count(geometry_of(scene, object));
}

uint32_t object_number(const Scene& scene, uint32_t object) {
  return object < scene.object_numbers.size() ? scene.object_numbers[object] : object;
}

std::span<const std::string_view> framing_names() {
  using std::string_view_literals::operator""sv;
  static constexpr std::array kNames = {"three-quarter"sv, "front"sv};
  return kNames;
}

Camera frame_scene(const Scene& scene, float aspect_ratio, Framing framing) {
  if (!(aspect_ratio > 0.0F && std::isfinite(aspect_ratio))) {
    throw UsageError({"the aspect ratio is not positive and finite", "in frame_scene", "give width over height"});
  }
  return frame_bounds(frame_of(scene), aspect_ratio, framing);
}

Camera frame_bounds(const Bounds& frame, float aspect_ratio, Framing framing) {
  const dvec3 center = 0.5 * (dvec3(frame.lo) + dvec3(frame.hi));
  const dvec3 half = 0.5 * (dvec3(frame.hi) - dvec3(frame.lo));

  const Viewpoint from = choose_viewpoint(2.0 * half, framing);
  const dvec2 turn(std::sin(from.azimuth), std::cos(from.azimuth));
  const dvec2 tilt(std::sin(from.elevation), std::cos(from.elevation));
  // Differences from 0 are never -0.
  const dvec3 right(turn.y, 0.0, 0.0 - turn.x);
  const dvec3 look(0.0 - tilt.y * turn.x, 0.0 - tilt.x, 0.0 - tilt.y * turn.y);
  const dvec3 up(0.0 - tilt.x * turn.x, tilt.y, 0.0 - tilt.x * turn.y);
  const double tan_y = std::tan(0.5 * static_cast<double>(from.yfov));
  const double tan_x = tan_y * static_cast<double>(aspect_ratio);

  // The least distance at which each corner of the box lies within both fields of view.
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
    const dvec3 offset = sign * half;
    const double across = std::max(std::abs(glm::dot(offset, right)) / tan_x, std::abs(glm::dot(offset, up)) / tan_y);
    distance = std::max(distance, across - glm::dot(offset, look));
  }
  distance *= kFrameMargin;
  // A lone point has no size to go by.
  if (distance == 0.0) distance = 1.0;
  // Far from the origin the eye must still be another fp32 number than what it looks at.
  const dvec3 magnitude = glm::abs(center);
  distance = std::max(distance, 0x1p-20 * std::max({magnitude.x, magnitude.y, magnitude.z}));

  Camera camera;
  camera.name = "framing";
  camera.eye = vec3(center - distance * look);
  camera.look = vec3(look);
  camera.up = vec3(up);
  camera.yfov = from.yfov;
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

bool shows_same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.look == b.look && a.up == b.up && a.projection == b.projection && a.yfov == b.yfov &&
         a.ymag == b.ymag && a.near == b.near;
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
  return a.size == b.size && a.mode == b.mode && a.max_depth == b.max_depth && a.filter == b.filter &&
         a.filter_width == b.filter_width && shows_same(a.camera, b.camera);
}

AddedLights add_default_lights(std::vector<Light>& lights, Environment& environment) {
  // A sky is light enough.
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
