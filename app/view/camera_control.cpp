// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/camera_control.h"

#include <algorithm>
#include <cmath>

#include "promin/framing.h"

namespace promin::app {
namespace {

/// Speeds in radians per second.
constexpr double kRollSpeed = 0.8;
constexpr double kOrbitSpeed = 0.8;
/// A second of orbiting nearer multiplies the distance to the center by exp(-kApproach).
constexpr double kApproach = 1.0;
/// Factor of the distance to the pivot for one step of the wheel.
constexpr double kZoomStep = 0.85;
/// Largest elevation, in degrees, to which the pointer can orbit the camera.
constexpr double kHighestElevation = 89.0;

}  // namespace

CameraControl::CameraControl(const Camera& camera, const Bounds& bounds, const vec3& up)
    : start_(camera),
      camera_(camera),
      middle_(bounds.is_empty() ? dvec3(0.0) : dvec3(bounds.center())),
      up_(glm::normalize(dvec3(up))),
      speed_(speed_to_cross(bounds)) {}

void CameraControl::apply(const Motion& motion, double window_height) {
  // If there is no motion, all values keep their bits.
  if (motion.is_none()) return;
  if (motion.orbit != dvec2(0.0)) turn_around(motion.orbit, window_height);
  if (motion.pan != dvec2(0.0)) pan(motion.pan, window_height);
  if (motion.zoom != 0.0) zoom(motion.zoom);
  const bool is_perspective = camera().projection == Projection::kPerspective;
  const double radians_a_pixel = (is_perspective ? static_cast<double>(camera().yfov) : 1.0) / window_height;
  const double alpha = kRollSpeed * motion.roll;
  const double beta = radians_a_pixel * motion.turn.x;
  const double gamma = radians_a_pixel * motion.turn.y;
  if (center_ && (motion.travel != dvec3(0.0) || motion.roll != 0.0 || motion.turn != dvec2(0.0))) {
    const double distance = glm::distance(camera_.position(), *center_) * std::exp(-kApproach * motion.travel.z);
    return swing(alpha, beta + kOrbitSpeed * motion.travel.x, gamma - kOrbitSpeed * motion.travel.y, distance);
  }
  if (motion.roll != 0.0 || motion.turn != dvec2(0.0)) camera_.rotate(alpha, beta, gamma);
  const dvec3 way = speed_ * motion.travel;
  if (way != dvec3(0.0)) camera_.move(way.z, way.y, way.x);
}

dvec3 CameraControl::pivot() const {
  if (center_) return *center_;
  const double ahead = glm::dot(middle_ - camera_.position(), camera_.look());
  return ahead > 0.0 ? camera_.position() + ahead * camera_.look() : middle_;
}

void CameraControl::turn_around(const dvec2& pixels, double window_height) {
  const double degrees_a_pixel = 180.0 / window_height;
  const double elevation = glm::degrees(std::asin(std::clamp(-glm::dot(camera_.look(), up_), -1.0, 1.0)));
  const double wanted = elevation + degrees_a_pixel * pixels.y;
  // A camera that is already beyond the limit may move back.
  const double highest = std::max(kHighestElevation, std::abs(elevation));
  const Orbit orbit{.azimuth_deg = -degrees_a_pixel * pixels.x,
                    .elevation_deg = std::clamp(wanted, -highest, highest) - elevation};
  camera_ = FreeCamera(orbit_camera(camera(), pivot(), orbit, vec3(up_)));
}

void CameraControl::pan(const dvec2& pixels, double window_height) {
  const bool is_perspective = camera().projection == Projection::kPerspective;
  const double half_height = is_perspective
                                 ? glm::distance(camera_.position(), pivot()) * std::tan(0.5 * double{camera().yfov})
                                 : double{camera().ymag};
  const dvec2 way = 2.0 * half_height / window_height * pixels;
  if (center_) *center_ += way.y * camera_.up() - way.x * camera_.right();
  camera_.move(0.0, way.y, -way.x);
}

void CameraControl::zoom(double steps) {
  const double factor = std::pow(kZoomStep, std::clamp(steps, -100.0, 100.0));
  if (camera().projection == Projection::kOrthographic) {
    Camera zoomed = camera();
    zoomed.ymag *= static_cast<float>(factor);
    camera_ = FreeCamera(zoomed);
    return;
  }
  const dvec3 way = (1.0 - factor) * (pivot() - camera_.position());
  camera_.move(glm::dot(way, camera_.look()), glm::dot(way, camera_.up()), glm::dot(way, camera_.right()));
}

void CameraControl::place(const Camera& camera) {
  camera_ = FreeCamera(camera);
  center_.reset();
}

void CameraControl::move(const dvec3& offset) {
  start_.eye = vec3(dvec3(start_.eye) + offset);
  middle_ += offset;
  Camera moved = camera_.camera();
  moved.eye = vec3(camera_.position() + offset);
  camera_ = FreeCamera(moved);
  if (center_) *center_ += offset;
}

void CameraControl::reset() {
  place(start_);
}

void CameraControl::orbit(const dvec3& center) {
  const dvec3 ahead = center - camera_.position();
  const double distance = glm::length(ahead);
  if (!(distance > 0.0)) return;
  center_ = center;
  // Angles to the center about the camera's own up and right axes.
  const double right = glm::dot(ahead, camera_.right());
  const double up = glm::dot(ahead, camera_.up());
  const double forward = glm::dot(ahead, camera_.look());
  const double beta = -std::atan2(right, forward);
  const double gamma = std::atan2(up, std::hypot(right, forward));
  if (beta != 0.0 || gamma != 0.0) camera_.rotate(0.0, beta, gamma);
}

void CameraControl::swing(double alpha, double beta, double gamma, double distance) {
  camera_.rotate(alpha, beta, gamma);
  const dvec3 way = *center_ - distance * camera_.look() - camera_.position();
  camera_.move(glm::dot(way, camera_.look()), glm::dot(way, camera_.up()), glm::dot(way, camera_.right()));
}

double speed_to_cross(const Bounds& bounds) {
  constexpr double kSeconds = 8.0;
  const double size = bounds.is_empty() ? 0.0 : glm::length(dvec3(bounds.extent()));
  return size > 0.0 ? size / kSeconds : 1.0;
}

}  // namespace promin::app
