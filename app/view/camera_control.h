// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "view/motion.h"
#include "work/pictures/camera.h"

namespace promin::app {

/// Moves the free camera. It either flies or orbits. When flying, all angles are about the camera's own axes and no
/// direction of the world is up, so no pose is special and there is no gimbal lock. When orbiting, it faces a point. In
/// both cases the pointer moves it around the point that it looks at.
class CameraControl {
 public:
  /// `bounds` are the bounds of the scene. `up` is the scene's up direction, of any length except 0.
  CameraControl(const Camera& camera, const Bounds& bounds, const vec3& up);

  /// `window_height` is in pixels. A drag over the whole height turns the camera by the field of view, so that the
  /// scene follows the pointer. When orbiting, such a drag moves the camera halfway around the pivot.
  void apply(const Motion& motion, double window_height);

  /// Returns the point at which the camera looks. When orbiting it is the center. Otherwise it is the point on the
  /// camera's axis nearest to the middle of the scene, or that middle itself if it lies behind the camera.
  dvec3 pivot() const;

  /// Sets another pose. The start pose does not change.
  void place(const Camera& camera);
  /// Moves everything by an offset: the pose, the start pose and the orbited point.
  void move(const dvec3& offset);
  /// Returns the camera to the start pose and to flying.
  void reset();

  /// Turns the camera towards `center` and lets it orbit this point from now on. Does nothing if the camera is at this
  /// point.
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
  /// Moves the camera on a sphere around the center: turns it, then moves it so that the center is straight ahead.
  void swing(double alpha, double beta, double gamma, double distance);

  Camera start_;
  FreeCamera camera_;
  std::optional<dvec3> center_;
  /// The middle of the scene, and its up direction of unit length.
  dvec3 middle_;
  dvec3 up_;
  /// Speed in world units per second.
  double speed_;
};

/// Returns a speed with which the camera crosses the scene in a few seconds.
double speed_to_cross(const Bounds& bounds);

}  // namespace promin::app
