// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "camera.h"
#include "view/motion.h"

namespace promin::app {

/// Moves the free camera. Either it flies: all angles are about the camera's own axes and no direction of the world is
/// up, so that no pose is special and there is no gimbal to lock. Or it orbits a point, which it faces.
class CameraControl {
 public:
  /// `speed` is in world units a second.
  CameraControl(const Camera& camera, double speed) : start_(camera), camera_(camera), speed_(speed) {}

  /// `window_height` is in pixels. A drag over all of it turns the camera by the field of view, so that what is under
  /// the pointer stays there.
  void apply(const Motion& motion, double window_height);

  /// Takes another pose; the start pose is kept.
  void place(const Camera& camera);
  /// Takes all that it holds elsewhere: the pose, the start pose and what it orbits.
  void move(const dvec3& offset);
  /// Goes back to the pose that the control was made with, and flies.
  void reset();

  /// Turns towards `center` and orbits it from now on, unless the camera is there.
  void orbit(const dvec3& center);
  void fly() { center_.reset(); }
  bool is_orbiting() const { return center_.has_value(); }

  double speed() const { return speed_; }
  /// Makes the camera faster by steps of the wheel, slower by negative ones.
  void change_speed(double steps);

  const Camera& camera() const { return camera_.camera(); }
  const dvec3& position() const { return camera_.position(); }

 private:
  /// Moves on a sphere around the center: it turns, then goes to where the center is straight ahead.
  void swing(double alpha, double beta, double gamma, double distance);

  Camera start_;
  FreeCamera camera_;
  std::optional<dvec3> center_;
  double speed_;
};

/// The speed at which a scene is crossed in some seconds.
double speed_to_cross(const Bounds& bounds);

}  // namespace promin::app
