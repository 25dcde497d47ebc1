// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin {

// The three rotations, angles in radians, right-handed: each turns anticlockwise for an eye on the positive axis.

/// Mx(gamma): Y towards Z. A camera at the start pose looks up for gamma > 0.
dmat3 make_rotation_x(double gamma);
/// My(beta): Z towards X. A camera at the start pose turns left for beta > 0.
dmat3 make_rotation_y(double beta);
/// Mz(alpha): X towards Y. A camera at the start pose rolls anticlockwise for alpha > 0, seen from behind it: its up
/// tips to the left, and the picture turns clockwise.
dmat3 make_rotation_z(double alpha);

/// The thesis's free camera (docs/model.md, "Rays and camera"): a position O and a rotation matrix Q.
///   M(alpha, beta, gamma) = Mz(alpha) My(beta) Mx(gamma),  Q <- Q M
///   look = Q (0, 0, -1),  up = Q (0, 1, 0),  right = look x up
/// The vectors are always computed from the start vectors and never from already rotated ones. M is on the right, so
/// angles are about the camera's own axes. Q stays orthonormal however long the camera is used.
class FreeCamera {
 public:
  /// At the origin, looking along -Z with +Y up; the projection is Camera's default.
  FreeCamera() : FreeCamera(Camera{}) {}

  /// Uses this pose and projection. `look` and `up` are orthonormal up to fp32 rounding, as Camera requires.
  explicit FreeCamera(const Camera& camera);

  /// Makes a camera of directions of any length. They are used as given, to the bit, where they are orthonormal to
  /// rounding; otherwise up is made perpendicular to look. Throws UsageError if they are zero, not finite or parallel.
  static FreeCamera from_pose(const vec3& eye, const vec3& look, const vec3& up);

  /// O <- O + ahead * look + up * up + right * right, in world units.
  void move(double ahead, double up, double right);

  /// Q <- Q M(alpha, beta, gamma), radians: rolls anticlockwise, turns left, looks up.
  void rotate(double alpha, double beta, double gamma);

  const dvec3& position() const { return position_; }
  const dmat3& rotation() const { return rotation_; }
  dvec3 look() const;
  dvec3 up() const;
  dvec3 right() const;

  /// Returns pose and projection for the renderer. Values that were neither moved nor rotated keep their bits.
  const Camera& camera() const { return camera_; }

 private:
  dvec3 position_;
  dmat3 rotation_;
  Camera camera_;
};

}  // namespace promin
