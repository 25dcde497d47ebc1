// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "promin/framing.h"
#include "scene/choose_instances.h"
#include "scene/facets.h"
#include "scene/framing.h"
#include "scene/placed_bounds.h"

namespace promin {
namespace {

/// The visible space of a picture: the half-spaces that bound it, and the rays in its corners.
class Frustum {
 public:
  Frustum(const Camera& camera, double aspect_ratio)
      : eye_(camera.eye),
        look_(glm::normalize(dvec3(camera.look))),
        right_(glm::normalize(glm::cross(look_, dvec3(camera.up)))),
        up_(glm::cross(right_, look_)),
        near_(camera.near),
        is_parallel_(camera.projection == Projection::kOrthographic),
        half_height_(is_parallel_ ? double{camera.ymag} : std::tan(0.5 * static_cast<double>(camera.yfov))),
        half_width_(half_height_ * aspect_ratio) {}

  /// Returns a bit for each side of the picture beyond which a point lies.
  uint32_t sides_beyond(const dvec3& point) const {
    const Place place = place_of(point);
    const dvec2& half = place.half_size;
    const auto bit = [](bool is_beyond, uint32_t number) { return is_beyond ? 1U << number : 0U; };
    return bit(place.depth <= near_, 0) | bit(place.aside.x < -half.x, 1) | bit(place.aside.x > half.x, 2) |
           bit(place.aside.y < -half.y, 3) | bit(place.aside.y > half.y, 4);
  }

  /// Returns the position of a point in a picture whose sides are at -1 and 1; infinite for a point at the eye or
  /// behind it.
  dvec2 project(const dvec3& point) const {
    const Place place = place_of(point);
    if (place.depth <= 0.0) return dvec2(std::numeric_limits<double>::infinity());
    return place.aside / place.half_size;
  }

  /// Returns whether a ray of the picture intersects a plane. The boundary between rays that intersect the plane and
  /// rays that do not is a line in the picture. Therefore, if any ray intersects the plane, a ray in a corner does.
  bool meets(const world::Plane& plane) const {
    const dvec3 normal(plane.normal);
    for (const double x : {-half_width_, half_width_}) {
      for (const double y : {-half_height_, half_height_}) {
        const dvec3 aside = x * right_ + y * up_;
        const dvec3 origin = is_parallel_ ? eye_ + aside : eye_;
        const dvec3 direction = is_parallel_ ? look_ : look_ + aside;
        if (glm::dot(dvec3(plane.point) - origin, normal) * glm::dot(direction, normal) > 0.0) return true;
      }
    }
    return false;
  }

 private:
  /// A point in the camera's coordinates: its depth, its position beside the axis, and half of the picture's size at
  /// its depth.
  struct Place {
    double depth;
    dvec2 aside;
    dvec2 half_size;
  };

  Place place_of(const dvec3& point) const {
    const dvec3 v = point - eye_;
    const double depth = glm::dot(v, look_);
    const double growth = is_parallel_ ? 1.0 : depth;
    return {depth, {glm::dot(v, right_), glm::dot(v, up_)}, dvec2(half_width_, half_height_) * growth};
  }

  dvec3 eye_;
  dvec3 look_;
  dvec3 right_;
  dvec3 up_;
  double near_;
  bool is_parallel_;
  double half_height_;
  double half_width_;
};

/// Returns whether rays of a picture intersect an unbounded object.
struct MeetsUnbounded {
  const Frustum& frustum;
  const dmat4& world_from_object;

  template <class Bounded>
  bool operator()(const Bounded& /*bounded*/) const {
    return false;
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)     \
  bool operator()(const TYPE& shape) const {                                 \
    const std::optional placed = place(shape, Placement(world_from_object)); \
    return placed && frustum.meets(*placed);                                 \
  }
#include "promin/kinds/primitives.def"
};

}  // namespace

bool may_see(const Scene& scene, const Camera& camera, float aspect_ratio) {
  const Frustum frustum(camera, static_cast<double>(aspect_ratio));
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) continue;
    if (std::visit(MeetsUnbounded{frustum, object.world_from_object}, scene.geometries[object.geometry])) return true;
  }
  // If the box of an instance lies beyond a side, so do all its facets.
  const std::vector<bool> is_instance = choose_instances(scene, Instancing::kAuto);
  std::vector<Bounds> boxes;
  if (std::ranges::count(is_instance, true) > 0) boxes = bounds_of_objects(scene);
  const auto is_beyond = [&](size_t object) {
    if (!is_instance[object]) return false;
    uint32_t beyond = ~0U;
    for (uint32_t corner = 0; corner < 8; ++corner) {
      const glm::bvec3 is_high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
      beyond &= frustum.sides_beyond(glm::mix(dvec3(boxes[object].lo), dvec3(boxes[object].hi), is_high));
    }
    return beyond != 0;
  };
  return any_facet(scene, is_beyond, [&](const Facet& facet) {
    uint32_t beyond = ~0U;
    for (const dvec3& corner : facet.corners) beyond &= frustum.sides_beyond(corner);
    return beyond == 0;
  });
}

double covered_share(const Scene& scene, const Camera& camera, float aspect_ratio) {
  const Frustum frustum(camera, static_cast<double>(aspect_ratio));
  const Bounds box = frame_of(scene);
  dvec2 lo(std::numeric_limits<double>::infinity());
  dvec2 hi = -lo;
  for (uint32_t corner = 0; corner < 8; ++corner) {
    const glm::bvec3 is_high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    const dvec2 place = frustum.project(glm::mix(dvec3(box.lo), dvec3(box.hi), is_high));
    lo = glm::min(lo, place);
    hi = glm::max(hi, place);
  }
  const double share = 0.5 * std::max(hi.x - lo.x, hi.y - lo.y);
  return std::isnan(share) ? std::numeric_limits<double>::infinity() : share;
}

}  // namespace promin
