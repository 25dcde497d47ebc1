// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/camera_control.h"

#include <algorithm>
#include <cmath>

namespace promin::app {
namespace {

/// The speeds are in radians a second.
constexpr double kRollSpeed = 0.8;
constexpr double kOrbitSpeed = 0.8;
/// A second of orbiting nearer multiplies the distance to the center by exp(-kApproach).
constexpr double kApproach = 1.0;
constexpr double kSpeedStep = 1.2;

}  // namespace

void CameraControl::apply(const Motion& motion, double window_height) {
  // What was not moved keeps its bits.
  if (motion.is_none()) return;
  const bool is_perspective = camera().projection == Projection::kPerspective;
  const double radians_a_pixel = (is_perspective ? static_cast<double>(camera().yfov) : 1.0) / window_height;
  const double alpha = kRollSpeed * motion.roll;
  const double beta = radians_a_pixel * motion.turn.x;
  const double gamma = radians_a_pixel * motion.turn.y;
  if (center_) {
    const double distance = glm::distance(camera_.position(), *center_) * std::exp(-kApproach * motion.travel.z);
    return swing(alpha, beta + kOrbitSpeed * motion.travel.x, gamma - kOrbitSpeed * motion.travel.y, distance);
  }
  if (motion.roll != 0.0 || motion.turn != dvec2(0.0)) camera_.rotate(alpha, beta, gamma);
  const dvec3 way = speed_ * motion.travel;
  camera_.move(way.z, way.y, way.x);
}

void CameraControl::place(const Camera& camera) {
  camera_ = FreeCamera(camera);
  center_.reset();
}

void CameraControl::move(const dvec3& offset) {
  start_.eye = vec3(dvec3(start_.eye) + offset);
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
  // The angles to the center about the camera's own up and right.
  const double right = glm::dot(ahead, camera_.right());
  const double up = glm::dot(ahead, camera_.up());
  const double forward = glm::dot(ahead, camera_.look());
  const double beta = -std::atan2(right, forward);
  const double gamma = std::atan2(up, std::hypot(right, forward));
  if (beta != 0.0 || gamma != 0.0) camera_.rotate(0.0, beta, gamma);
}

void CameraControl::change_speed(double steps) {
  speed_ *= std::pow(kSpeedStep, std::clamp(steps, -100.0, 100.0));
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
