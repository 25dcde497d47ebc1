// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "camera.h"
#include "view/motion.h"

namespace promin::app {

/// Moves the free camera. Either it flies: all angles are about the camera's own axes and no direction of the world is
/// up, so that no pose is special and there is no gimbal to lock. Or it orbits a point, which it faces. The pointer
/// takes it around what it looks at, in either case.
class CameraControl {
 public:
  /// `bounds` is of the scene, and `up` its direction, of any length but 0.
  CameraControl(const Camera& camera, const Bounds& bounds, const vec3& up);

  /// `window_height` is in pixels. A drag over all of it turns the camera by the field of view, so that what is under
  /// the pointer stays there; one that orbits takes the camera half around the pivot.
  void apply(const Motion& motion, double window_height);

  /// What the camera looks at: the center of an orbit, else the point of its axis that is nearest to the middle of the
  /// scene, or that middle where it lies behind the camera.
  dvec3 pivot() const;

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
  void set_speed(double speed) { speed_ = speed; }

  const Camera& camera() const { return camera_.camera(); }
  const dvec3& position() const { return camera_.position(); }

 private:
  void turn_around(const dvec2& pixels, double window_height);
  void pan(const dvec2& pixels, double window_height);
  void zoom(double steps);
  /// Moves on a sphere around the center: it turns, then goes to where the center is straight ahead.
  void swing(double alpha, double beta, double gamma, double distance);

  Camera start_;
  FreeCamera camera_;
  std::optional<dvec3> center_;
  /// The middle of the scene, and its direction up, of unit length.
  dvec3 middle_;
  dvec3 up_;
  /// In world units a second.
  double speed_;
};

/// The speed at which a scene is crossed in some seconds.
double speed_to_cross(const Bounds& bounds);

}  // namespace promin::app
