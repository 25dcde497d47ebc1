// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin {

// The three rotations. Angles are in radians, and the rotations are right-handed: each is anticlockwise for an eye on
// the positive axis.

/// Mx(gamma) rotates Y towards Z. A camera in the start pose looks up for gamma > 0.
dmat3 make_rotation_x(double gamma);
/// My(beta) rotates Z towards X. A camera in the start pose turns left for beta > 0.
dmat3 make_rotation_y(double beta);
/// Mz(alpha) rotates X towards Y. A camera in the start pose rolls anticlockwise for alpha > 0, seen from behind the
/// camera: its up vector tips to the left, and the picture rotates clockwise.
dmat3 make_rotation_z(double alpha);

/// The thesis's free camera (docs/model.md, "Rays and camera"): a position O and a rotation matrix Q.
///   M(alpha, beta, gamma) = Mz(alpha) My(beta) Mx(gamma),  Q <- Q M
///   look = Q (0, 0, -1),  up = Q (0, 1, 0),  right = look x up
/// The vectors are always computed from the start vectors and never from already rotated ones. M is on the right, so
/// angles are about the camera's own axes. Q stays orthonormal however long the camera is used.
class FreeCamera {
 public:
  /// Creates a camera at the origin that looks along -Z with +Y up and has Camera's default projection.
  FreeCamera() : FreeCamera(Camera{}) {}

  /// Uses this pose and projection. `look` and `up` are orthonormal up to fp32 rounding, as Camera requires.
  explicit FreeCamera(const Camera& camera);

  /// Returns a camera with directions of any length. If the directions are orthonormal up to rounding, they keep their
  /// bits; otherwise `up` is made perpendicular to `look`. Throws UsageError if they are zero, not finite or parallel.
  static FreeCamera from_pose(const vec3& eye, const vec3& look, const vec3& up);

  /// Moves the camera: O <- O + ahead * look + up * up + right * right, in world units.
  void move(double ahead, double up, double right);

  /// Rotates the camera: Q <- Q M(alpha, beta, gamma), in radians. It rolls anticlockwise, turns left and looks up.
  void rotate(double alpha, double beta, double gamma);

  const dvec3& position() const { return position_; }
  const dmat3& rotation() const { return rotation_; }
  dvec3 look() const;
  dvec3 up() const;
  dvec3 right() const;

  /// Returns pose and projection for the renderer. Position and directions are unchanged, bit for bit, if the camera
  /// was neither moved nor rotated.
  const Camera& camera() const { return camera_; }

 private:
  dvec3 position_;
  dmat3 rotation_;
  Camera camera_;
};

}  // namespace promin
