// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/rounding.h"
#include "promin/error.h"
#include "scene/framing.h"
#include "scene/scene_hull.h"
#include "scene/upright.h"

namespace promin {
namespace {

/// The field of view of framed cameras, 40 degrees.
constexpr float kFramedYfov = 0.698131701F;
/// The field of view of a camera inside a scene, 60 degrees.
constexpr float kInsideYfov = 1.04719755F;

/// The direction from which a camera sees a scene, in degrees: the angle about the scene's up axis from the front to
/// the right, and the angle above the horizon.
struct Viewpoint {
  double azimuth;
  double elevation;
};

/// Returns the viewpoint "three quarters". `size` is the scene's size along the axes of its front and its up direction.
Viewpoint find_three_quarters(const dvec3& size) {
  if (16.0 * size.y < std::max(size.x, size.z) && size.y <= size.z) return {30.0, 45.0};
  if (4.0 * size.z < std::max(size.x, size.y)) return {0.0, 0.0};
  return {30.0, 17.0};
}

Viewpoint viewpoint_of(Framing framing, const dvec3& size) {
  switch (framing) {
    case Framing::kThreeQuarter:
      return find_three_quarters(size);
    case Framing::kFront:
    case Framing::kInside:
      return {0.0, 0.0};
    case Framing::kBack:
      return {180.0, 0.0};
    case Framing::kLeft:
      return {-90.0, 0.0};
    case Framing::kRight:
      return {90.0, 0.0};
    case Framing::kTop:
      return {0.0, 90.0};
    case Framing::kBottom:
      return {0.0, -90.0};
  }
  return {0.0, 0.0};
}

/// Returns sine and cosine of an angle in degrees; they are exact for multiples of a right angle.
dvec2 turn_by(double degrees) {
  const double quarters = degrees / 90.0;
  const double whole = std::round(quarters);
  const double rest = (quarters - whole) * 0.5 * std::numbers::pi;
  const double sine = std::sin(rest);
  const double cosine = std::cos(rest);
  // The additions of 0 turn -0 into 0.
  switch (static_cast<int>(whole - 4.0 * std::floor(0.25 * whole))) {
    case 1:
      return dvec2(cosine, -sine) + 0.0;
    case 2:
      return dvec2(-sine, -cosine) + 0.0;
    case 3:
      return dvec2(-cosine, sine) + 0.0;
    default:
      return dvec2(sine, cosine) + 0.0;
  }
}

/// Rotates a vector around a unit axis, anticlockwise for an eye at which the axis points.
dvec3 turn_around(const dvec3& v, const dvec3& axis, double degrees) {
  const dvec2 turn = turn_by(degrees);
  return turn.y * v + turn.x * glm::cross(axis, v) + (1.0 - turn.y) * glm::dot(axis, v) * axis + 0.0;
}

void check_aspect_ratio(float aspect_ratio) {
  if (aspect_ratio > 0.0F && std::isfinite(aspect_ratio)) return;
  throw UsageError({"framing.aspect", "the aspect ratio is not positive and finite", "framing",
                    "give the width divided by the height"});
}

void check_fit(float fit) {
  if (fit >= kMinFit && fit <= 1.0F) return;
  throw UsageError(
      {"framing.fit", "the fraction of the picture to cover is out of range", "framing", "give 0.05 to 1"});
}

/// The axes of a camera's picture, orthonormal.
struct Axes {
  dvec3 right;
  dvec3 up;
  dvec3 look;
};

Axes axes_of(const Camera& camera) {
  const dvec3 look = glm::normalize(dvec3(camera.look));
  const dvec3 right = glm::normalize(glm::cross(look, dvec3(camera.up)));
  return {right, glm::cross(right, look), look};
}

/// Two planes through a camera's eye, one to each side of its look, that touch the scene.
struct Opening {
  /// Coordinate of the eye along the look, measured from the center.
  double depth;
  /// The distance from the eye at which the planes are as far apart as the scene's width.
  double distance;
};

/// Returns two planes that touch the hull from both sides. They diverge from the look direction with this slope.
template <typename Hull>
Opening touch(const Hull& hull, const dvec3& side, const dvec3& look, double slope) {
  const auto reach = [&](const dvec3& direction) { return glm::dot(hull.farthest(direction), direction); };
  const double right = reach(side - slope * look);
  const double left = reach(-side - slope * look);
  return {-0.5 * (right + left) / slope, 0.5 * (reach(side) + reach(-side)) / slope};
}

/// Returns the coordinate across the look from which an eye at this depth sees the hull in the middle. The slope to the
/// hull's edge is the root of a convex, decreasing function. Newton's method finds it: it ends, because there are
/// finitely many vertices, and comes close to the root for round shapes.
template <typename Hull>
double find_middle(const Hull& hull, const dvec3& side, const dvec3& look, double slope, double depth) {
  constexpr int kMostSteps = 32;
  constexpr double kTolerance = 1e-7;
  double right = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const dvec3 at_right = hull.farthest(side - slope * look);
    const dvec3 at_left = hull.farthest(-side - slope * look);
    right = glm::dot(at_right, side - slope * look);
    const double left = glm::dot(at_left, -side - slope * look);
    const double rest = right + left + 2.0 * slope * depth;
    const double fall = glm::dot(at_right + at_left, look) - 2.0 * depth;
    if (!(std::abs(rest) > kTolerance * slope * fall) || !(fall > 0.0)) break;
    slope += rest / fall;
  }
  return right + slope * depth;
}

/// The position from which a camera with `axes` sees the whole hull.
struct Fitted {
  dvec3 eye;
  double half_height = 1.0;
};

/// Returns the smallest and the largest depth of the hull along the look, measured from the center.
template <typename Hull>
dvec2 depths_of(const Hull& hull, const dvec3& look) {
  return {glm::dot(hull.farthest(-look), look), glm::dot(hull.farthest(look), look)};
}

template <typename Hull>
Fitted fit_parallel(const Hull& hull, const Axes& axes, double aspect_ratio, double fit) {
  const auto reach = [&](const dvec3& axis) { return glm::dot(hull.farthest(axis), axis); };
  const dvec2 most(reach(axes.right), reach(axes.up));
  const dvec2 least(-reach(-axes.right), -reach(-axes.up));
  const dvec2 depths = depths_of(hull, axes.look);
  const dvec2 half = 0.5 * (most - least);
  const dvec2 middle = 0.5 * (most + least);
  const double half_height = std::max(half.y, half.x / aspect_ratio) / fit;
  const double size = std::max({half.x, half.y, depths.y - depths.x});
  const double depth = depths.x - (size > 0.0 ? size : 1.0);
  return {middle.x * axes.right + middle.y * axes.up + depth * axes.look, half_height > 0.0 ? half_height : 1.0};
}

template <typename Hull>
Fitted fit_perspective(const Hull& hull, const Axes& axes, double aspect_ratio, double tan_y, double fit) {
  const double slope_x = fit * tan_y * aspect_ratio;
  const double slope_y = fit * tan_y;
  const Opening x = touch(hull, axes.right, axes.look, slope_x);
  const Opening y = touch(hull, axes.up, axes.look, slope_y);
  // The smallest distance of the eye. Without it, the eye could be inside an object that points at the eye, and the
  // object would still lie between the planes.
  constexpr double kClearance = 0x1p-8;
  const double nearest = depths_of(hull, axes.look).x;
  double depth = std::min({x.depth, y.depth, nearest - kClearance * std::min(x.distance, y.distance)});
  // If the scene has neither width nor height, it lies along the look.
  if (x.distance == 0.0 && y.distance == 0.0) depth = 2.0 * nearest;
  // A single point has no size.
  if (depth == 0.0) depth = -1.0;
  // Far from the origin, the eye must still differ in fp32 from the point at which it looks.
  const dvec3 magnitude = glm::abs(hull.center());
  depth = std::min(depth, -0x1p-20 * std::max({magnitude.x, magnitude.y, magnitude.z}));
  const double right = find_middle(hull, axes.right, axes.look, slope_x, depth);
  const double up = find_middle(hull, axes.up, axes.look, slope_y, depth);
  return {right * axes.right + up * axes.up + depth * axes.look};
}

template <typename Hull>
Camera fit_to(const Hull& hull, Camera camera, double aspect_ratio, double fit) {
  const Axes axes = axes_of(camera);
  const bool is_perspective = camera.projection == Projection::kPerspective;
  const double tan_y = std::tan(0.5 * static_cast<double>(camera.yfov));
  const Fitted fitted = is_perspective ? fit_perspective(hull, axes, aspect_ratio, tan_y, fit)
                                       : fit_parallel(hull, axes, aspect_ratio, fit);
  camera.eye = vec3(hull.center() + fitted.eye);
  if (!is_perspective) camera.ymag = static_cast<float>(fitted.half_height);
  camera.aspect_ratio = static_cast<float>(aspect_ratio);
  return camera;
}

/// The space that a scene covers while it turns around a vertical axis through its center, approximately: points at the
/// edge of its outline. The largest distance is smaller by at most a thousandth.
class TurnedHull {
 public:
  TurnedHull(const SceneHull& hull, const dvec3& axis) : axis_(axis), center_(hull.center()) {
    constexpr double kStepDeg = 5.0;
    const dmat3 turn = turn_up_to(axis);
    for (double elevation = -90.0; elevation <= 90.0; elevation += kStepDeg) {
      for (double azimuth = 0.0; azimuth < 360.0; azimuth += kStepDeg) {
        const dvec2 around = turn_by(azimuth);
        const dvec2 upwards = turn_by(elevation);
        const dvec3 direction(upwards.y * around.x, upwards.x, upwards.y * around.y);
        const dvec3 point = hull.farthest(turn * direction);
        const double height = glm::dot(point, axis);
        outline_.push_back({glm::length(point - height * axis), height});
      }
    }
  }

  const dvec3& center() const { return center_; }
  dvec3 farthest(const dvec3& direction) const {
    const double upwards = glm::dot(direction, axis_);
    const dvec3 level = direction - upwards * axis_;
    const double across = glm::length(level);
    const auto reach = [&](const dvec2& point) { return point.x * across + point.y * upwards; };
    const dvec2 most = *std::ranges::max_element(outline_, {}, reach);
    return (across > 0.0 ? most.x / across * level : dvec3(0.0)) + most.y * axis_;
  }

 private:
  dvec3 axis_;
  dvec3 center_;
  /// The distance from the axis and the height of each point.
  std::vector<dvec2> outline_;
};

/// Returns a camera that looks from a viewpoint at a scene. `turn` rotates +Y to the scene's up axis.
Camera look_from(const Viewpoint& from, const dmat3& turn) {
  const dvec2 azimuth = turn_by(from.azimuth);
  const dvec2 elevation = turn_by(from.elevation);
  const dvec3 look(-elevation.y * azimuth.x, -elevation.x, -elevation.y * azimuth.y);
  const dvec3 up(-elevation.x * azimuth.x, elevation.y, -elevation.x * azimuth.y);
  Camera camera;
  camera.name = "framing";
  camera.yfov = kFramedYfov;
  // The addition of 0 turns -0 into 0.
  camera.look = vec3(turn * look + 0.0);
  camera.up = vec3(turn * up + 0.0);
  return camera;
}

/// Returns a camera inside a scene. `size` is the scene's size along its up axis and its horizontal axes.
Camera stand_within(const dvec3& center, const dvec3& size, const dmat3& turn, float aspect_ratio) {
  const bool is_wider = size.x > size.z;
  Camera camera = look_from({is_wider ? 90.0 : 0.0, 0.0}, turn);
  camera.yfov = kInsideYfov;
  // The eye is a third of the length from one end. The distance to the other end is two thirds, and the middle is a
  // sixth away.
  camera.eye = vec3(center - (is_wider ? size.x : size.z) / 6.0 * dvec3(camera.look));
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

/// Returns the default framing. An open side of a room is found only if +Y is up; a room with another up axis is seen
/// from inside.
Framing assumed_framing(const Scene& scene, const MainPart& part, const dmat3& turn) {
  const Framing from = framing_of(scene, part);
  return from == Framing::kThreeQuarter || turn == dmat3(1.0) ? from : Framing::kInside;
}

}  // namespace

dvec3 normalize_up(const vec3& up) {
  const double length = glm::length(dvec3(up));
  if (length > 0.0 && std::isfinite(length)) return dvec3(up) / length;
  throw UsageError({"framing.up", "the scene's up direction is zero or not finite", "framing", "give a direction"});
}

std::span<const std::string_view> framing_names() {
  using std::string_view_literals::operator""sv;
  static constexpr std::array kNames = {"three-quarter"sv, "front"sv, "back"sv,   "left"sv,
                                        "right"sv,         "top"sv,   "bottom"sv, "inside"sv};
  return kNames;
}

Camera frame_scene(const Scene& scene, float aspect_ratio, const FrameOptions& options) {
  check_aspect_ratio(aspect_ratio);
  check_fit(options.fit);
  const dmat3 turn = turn_up_to(normalize_up(options.up));
  const SceneHull hull(scene);
  const dvec3 extent = dvec3(hull.bounds().hi) - dvec3(hull.bounds().lo);
  // The size of the box is measured along the rotated axes.
  const dvec3 size(glm::dot(glm::abs(turn[0]), extent), glm::dot(glm::abs(turn[1]), extent),
                   glm::dot(glm::abs(turn[2]), extent));
  const Framing from = options.from ? *options.from : assumed_framing(scene, hull.main_part(), turn);
  if (from == Framing::kInside) return stand_within(hull.center(), size, turn, aspect_ratio);
  return fit_to(hull, look_from(viewpoint_of(from, size), turn), static_cast<double>(aspect_ratio),
                static_cast<double>(options.fit));
}

Camera fit_camera(const Scene& scene, const Camera& camera, float aspect_ratio, float fit) {
  check_aspect_ratio(aspect_ratio);
  check_fit(fit);
  return fit_to(SceneHull(scene), camera, static_cast<double>(aspect_ratio), static_cast<double>(fit));
}

Camera fit_turning_camera(const Scene& scene, const Camera& camera, const vec3& up, float aspect_ratio, float fit) {
  check_aspect_ratio(aspect_ratio);
  check_fit(fit);
  return fit_to(TurnedHull(SceneHull(scene), normalize_up(up)), camera, static_cast<double>(aspect_ratio),
                static_cast<double>(fit));
}

Camera orbit_camera(const Camera& camera, const dvec3& target, const Orbit& orbit, const vec3& up) {
  if (orbit == Orbit()) return camera;
  const dvec3 pole = normalize_up(up);
  Axes axes = axes_of(camera);
  dvec3 offset = dvec3(camera.eye) - target;
  const auto turn = [&](const dvec3& axis, double degrees) {
    axes = {turn_around(axes.right, axis, degrees), turn_around(axes.up, axis, degrees),
            turn_around(axes.look, axis, degrees)};
    offset = turn_around(offset, axis, degrees);
  };
  turn(pole, orbit.azimuth_deg);
  turn(axes.right, -orbit.elevation_deg);
  // If the camera only rolls, the eye keeps its position.
  axes.up = turn_around(axes.up, axes.look, -orbit.roll_deg);
  Camera turned = camera;
  turned.eye = vec3(target + offset);
  turned.look = vec3(axes.look);
  turned.up = vec3(axes.up);
  return turned;
}

dvec3 orbit_target(const Scene& scene, const Camera& camera) {
  const Bounds bounds = frame_of(scene);
  const dvec3 center = middle_of(bounds);
  const dvec3 look = glm::normalize(dvec3(camera.look));
  const double depth = glm::dot(center - dvec3(camera.eye), look);
  return depth > 0.0 ? dvec3(camera.eye) + depth * look : center;
}

Camera widen_camera(const Camera& camera, const uvec2& size) {
  const auto own = static_cast<double>(camera.aspect_ratio);
  const dvec2 sides(size);
  // If the ratio of a size differs by less than this, the difference comes from rounding the width or the height.
  constexpr double kRounding = 1e-6;
  const double least = (1.0 + kRounding) * sides.x;
  const bool is_narrower = own > 0.0 && std::round(sides.y * own) > least && (sides.y - 0.5) * own > least;
  if (!is_narrower) return camera;
  const double growth = own * sides.y / sides.x;
  Camera wider = camera;
  wider.yfov = static_cast<float>(2.0 * std::atan(growth * std::tan(0.5 * static_cast<double>(camera.yfov))));
  wider.ymag = static_cast<float>(growth * static_cast<double>(camera.ymag));
  return wider;
}

}  // namespace promin
