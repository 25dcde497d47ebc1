// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "core/parallel.h"
#include "promin/error.h"
#include "promin/motion_vectors.h"

namespace promin {
namespace {

/// The projection of points to a picture, in pixels from its centre, to the right and upwards. It is the inverse of the
/// camera's rays (shaders/picture/camera.glsl).
class Raster {
 public:
  Raster(const Camera& camera, const uvec2& size)
      : eye_(camera.eye), is_perspective_(camera.projection == Projection::kPerspective) {
    const double half_height = is_perspective_ ? std::tan(0.5 * double{camera.yfov}) : double{camera.ymag};
    const double pixel = 2.0 * half_height / size.y;
    const dvec3 look(camera.look);
    const dvec3 up(camera.up);
    world_from_film_ = dmat3(glm::cross(look, up) * pixel, up * pixel, look);
    film_from_world_ = glm::inverse(world_from_film_);
  }

  bool is_perspective() const { return is_perspective_; }

  /// Returns the place of a point; nullopt behind the eye of a perspective camera.
  std::optional<dvec2> place_of(const dvec3& point) const { return project(film_from_world_ * (point - eye_)); }
  /// Returns the place of a point at infinite distance. The camera is perspective.
  std::optional<dvec2> place_of_direction(const dvec3& direction) const {
    return project(film_from_world_ * direction);
  }
  /// Returns the direction through a place. The camera is perspective.
  dvec3 direction_through(const dvec2& place) const { return world_from_film_ * dvec3(place, 1.0); }

 private:
  std::optional<dvec2> project(const dvec3& on_film) const {
    if (!is_perspective_) return dvec2(on_film);
    if (!(on_film.z > 0.0)) return std::nullopt;
    return dvec2(on_film) / on_film.z;
  }

  dvec3 eye_;
  bool is_perspective_;
  dmat3 world_from_film_;
  dmat3 film_from_world_;
};

/// Returns the movement between two places. It is 0 if a place is missing or if fp32 cannot represent it.
vec2 difference_of(const std::optional<dvec2>& from, const std::optional<dvec2>& to) {
  if (!from || !to) return vec2(0.0F);
  const vec2 difference(*to - *from);
  return std::isfinite(difference.x) && std::isfinite(difference.y) ? difference : vec2(0.0F);
}

[[noreturn]] void refuse(const char* what) {
  throw InputError({"motion.next.other", std::string("the next frame has another scene: ") + what, "",
                    "use two poses of one scene (scene_at)"});
}

/// The movement of an object from one pose to another.
class ObjectMovement {
 public:
  ObjectMovement(const Scene& scene, const Scene& next, uint32_t object)
      : world_from_object_(scene.objects[object].world_from_object),
        object_from_world_(glm::inverse(world_from_object_)),
        next_world_from_object_(world_from_object_) {
    if (object >= next.objects.size()) return;
    const Object& then = next.objects[object];
    if (then.geometry == Object::kNoGeometry) return;
    next_world_from_object_ = then.world_from_object;
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[scene.objects[object].geometry]);
    const auto* next_mesh = std::get_if<Mesh>(&next.geometries[then.geometry]);
    if (mesh == nullptr || next_mesh == nullptr || mesh->positions == next_mesh->positions) return;
    if (mesh->positions.size() != next_mesh->positions.size() || mesh->triangles.size() != next_mesh->triangles.size())
      refuse("a mesh has another number of vertices");
    mesh_ = mesh;
    next_mesh_ = next_mesh;
  }

  /// Returns the displacement of a point of a primitive in the world.
  dvec3 displace(const dvec3& point, uint32_t primitive) const {
    if (mesh_ == nullptr) {
      const dvec4 in_object = object_from_world_ * dvec4(point, 1.0);
      return dvec3((next_world_from_object_ - world_from_object_) * in_object);
    }
    if (primitive >= mesh_->triangles.size()) refuse("a mesh has too few triangles");
    const dmat3 corners = corners_of(*mesh_, world_from_object_, primitive);
    const dmat3 next_corners = corners_of(*next_mesh_, next_world_from_object_, primitive);
    return (next_corners - corners) * weights_of(corners, point);
  }

 private:
  static dmat3 corners_of(const Mesh& mesh, const dmat4& world_from_object, uint32_t primitive) {
    dmat3 corners;
    for (int i = 0; i < 3; ++i) {
      const dvec3 corner(mesh.positions[mesh.triangles[primitive][i]]);
      corners[i] = dvec3(world_from_object * dvec4(corner, 1.0));
    }
    return corners;
  }

  /// Returns the barycentric weights of a point. A point beyond an edge by its rounding counts as a point of the edge.
  static dvec3 weights_of(const dmat3& corners, const dvec3& point) {
    const dvec3 e1 = corners[1] - corners[0];
    const dvec3 e2 = corners[2] - corners[0];
    const dvec3 normal = glm::cross(e1, e2);
    const double area = glm::dot(normal, normal);
    if (!(area > 0.0)) return {1.0, 0.0, 0.0};
    const dvec3 from = point - corners[0];
    const double v = std::clamp(glm::dot(glm::cross(from, e2), normal) / area, 0.0, 1.0);
    const double w = std::clamp(glm::dot(glm::cross(e1, from), normal) / area, 0.0, 1.0 - v);
    return {1.0 - v - w, v, w};
  }

  dmat4 world_from_object_;
  dmat4 object_from_world_;
  dmat4 next_world_from_object_;
  /// The meshes of an object that changes its form; null for any other.
  const Mesh* mesh_ = nullptr;
  const Mesh* next_mesh_ = nullptr;
};

/// Returns the movements of all visible objects.
std::map<uint32_t, ObjectMovement> find_movements(const Scene& scene, const Scene& next, const Aovs& aovs) {
  std::map<uint32_t, ObjectMovement> movements;
  uint32_t last = Aovs::kNoId;
  for (const uint32_t object : aovs.object) {
    if (object == last || object == Aovs::kNoId || movements.contains(object)) continue;
    if (object >= scene.objects.size() || scene.objects[object].geometry == Object::kNoGeometry)
      refuse("an object of the picture has no geometry");
    movements.emplace(object, ObjectMovement(scene, next, object));
    last = object;
  }
  return movements;
}

}  // namespace

void add_motion(const Scene& scene, const View& view, const Scene& next_scene, const Camera& next_camera, Aovs& aovs) {
  const PixelWindow window = view.crop.value_or(PixelWindow{uvec2(0), view.size});
  const size_t width = window.hi.x - window.lo.x;
  const size_t count = width * (window.hi.y - window.lo.y);
  if (aovs.position.size() != count || aovs.object.size() != count || aovs.primitive.size() != count) {
    throw UsageError({"motion.aovs", "motion needs the AOVs position, object and primitive of each pixel", "",
                      "select the AOV motion for the picture"});
  }
  const Raster raster(view.camera, view.size);
  const Raster next_raster(next_camera, view.size);
  const std::map<uint32_t, ObjectMovement> movements = find_movements(scene, next_scene, aovs);
  const bool shows_sky = scene.environment.shows_sky && scene.environment.has_sky() && raster.is_perspective() &&
                         next_raster.is_perspective();
  const dvec3 center_shift = scene.center - next_scene.center;
  const dvec2 middle = 0.5 * dvec2(view.size);
  aovs.motion.assign(count, vec2(0.0F));
  for_each_pixel(count, [&](size_t i) {
    if (const uint32_t object = aovs.object[i]; object != Aovs::kNoId) {
      const dvec3 point(aovs.position[i]);
      const dvec3 next_point = point + movements.at(object).displace(point, aovs.primitive[i]) + center_shift;
      aovs.motion[i] = difference_of(raster.place_of(point), next_raster.place_of(next_point));
    } else if (shows_sky) {
      const dvec2 pixel(static_cast<double>(window.lo.x + i % width), static_cast<double>(window.lo.y + i / width));
      const dvec3 direction = raster.direction_through({pixel.x + 0.5 - middle.x, middle.y - pixel.y - 0.5});
      aovs.motion[i] = difference_of(raster.place_of_direction(direction), next_raster.place_of_direction(direction));
    }
  });
}

}  // namespace promin
