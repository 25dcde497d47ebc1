// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "camera.h"
#include "view/motion.h"

namespace promin::app {

/// How motion moves the free camera. It flies: all angles are about the camera's own axes and no direction of the
/// world is up, so that no pose is special and there is no gimbal to lock. Or it orbits a point, which it faces.
class CameraControl {
 public:
  /// `speed` in world units a second.
  CameraControl(const Camera& camera, double speed) : start_(camera), camera_(camera), speed_(speed) {}

  /// `window_height` in pixels: a drag over all of it turns by the field of view, so that what is under the pointer
  /// stays there.
  void apply(const Motion& motion, double window_height);

  /// Another pose; the start is kept.
  void place(const Camera& camera);
  /// The pose that the control was made with, flying.
  void reset();

  /// Turns towards `center` and orbits it from now on. Not if the camera is there.
  void orbit(const dvec3& center);
  void fly() { center_.reset(); }
  bool is_orbiting() const { return center_.has_value(); }

  double speed() const { return speed_; }
  /// Faster by steps of the wheel, slower by negative ones.
  void change_speed(double steps);

  const Camera& camera() const { return camera_.camera(); }
  const dvec3& position() const { return camera_.position(); }

 private:
  /// Moves on a sphere around the center: turns, then goes to where the center is straight ahead.
  void swing(double alpha, double beta, double gamma, double distance);

  Camera start_;
  FreeCamera camera_;
  std::optional<dvec3> center_;
  double speed_;
};

/// At which a scene is crossed in some seconds.
double speed_to_cross(const Bounds& bounds);

}  // namespace promin::app
