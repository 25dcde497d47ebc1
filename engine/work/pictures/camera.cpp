// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/camera.h"

#include "promin/error.h"

namespace promin {
namespace {

const dvec3 kStartLook(0.0, 0.0, -1.0);
const dvec3 kStartUp(0.0, 1.0, 0.0);

/// Largest error of orthonormal vectors. Unit vectors rounded to fp32 miss |v| = 1 and u.v = 0 by 1.2e-7 to 2.1e-7, and
/// printing may add the same error.
constexpr double kOrthonormalTolerance = 1e-6;

/// Smallest sine of the angle between two directions. With a smaller one, fp32 cannot determine which direction is up.
constexpr double kMinSine = 1e-6;

/// Returns a matrix from its rows. GLM's constructor takes columns, but the formulas are written in rows.
dmat3 matrix_from_rows(const dvec3& x, const dvec3& y, const dvec3& z) {
  return glm::transpose(dmat3(x, y, z));
}

/// One Newton-Schulz step to the nearest orthonormal matrix (Higham, "Computing the Polar Decomposition", 1986; Bjoerck
/// & Bowie 1971). It squares the error, so that one step per rotation leaves only rounding errors, and it treats all
/// axes equally.
dmat3 orthonormalize(const dmat3& q) {
  return 0.5 * q * (3.0 * dmat3(1.0) - glm::transpose(q) * q);
}

bool is_orthonormal(const dvec3& a, const dvec3& b) {
  return std::abs(glm::dot(a, a) - 1.0) <= kOrthonormalTolerance &&
         std::abs(glm::dot(b, b) - 1.0) <= kOrthonormalTolerance && std::abs(glm::dot(a, b)) <= kOrthonormalTolerance;
}

}  // namespace

dmat3 make_rotation_x(double gamma) {
  const double c = std::cos(gamma);
  const double s = std::sin(gamma);
  return matrix_from_rows({1, 0, 0},   //
                          {0, c, -s},  //
                          {0, s, c});
}

dmat3 make_rotation_y(double beta) {
  const double c = std::cos(beta);
  const double s = std::sin(beta);
  return matrix_from_rows({c, 0, s},  //
                          {0, 1, 0},  //
                          {-s, 0, c});
}

dmat3 make_rotation_z(double alpha) {
  const double c = std::cos(alpha);
  const double s = std::sin(alpha);
  return matrix_from_rows({c, -s, 0},  //
                          {s, c, 0},   //
                          {0, 0, 1});
}

// The columns of Q are the images of X, Y and Z. Initially they are right, up and -look.
FreeCamera::FreeCamera(const Camera& camera)
    : position_(camera.eye),
      rotation_(glm::cross(dvec3(camera.look), dvec3(camera.up)), dvec3(camera.up), -dvec3(camera.look)),
      camera_(camera) {}

FreeCamera FreeCamera::from_pose(const vec3& eye, const vec3& look, const vec3& up) {
  Camera camera;
  camera.eye = eye;
  camera.look = look;
  camera.up = up;
  if (is_orthonormal(look, up)) return FreeCamera(camera);
  const dvec3 unit_look = glm::normalize(dvec3(look));
  const dvec3 side = glm::cross(unit_look, glm::normalize(dvec3(up)));
  // The condition is written so that NaN, from zero and infinite directions, is refused too.
  if (!(glm::length(side) >= kMinSine)) {
    throw UsageError({"camera.direction",
                      "the camera's direction of view and its up direction are zero, not finite or parallel", "",
                      "give two finite directions that differ"});
  }
  camera.look = unit_look;
  camera.up = glm::cross(glm::normalize(side), unit_look);
  return FreeCamera(camera);
}

void FreeCamera::move(double ahead, double up, double right) {
  position_ += ahead * this->look() + up * this->up() + right * this->right();
  camera_.eye = position_;
}

void FreeCamera::rotate(double alpha, double beta, double gamma) {
  const dmat3 m = make_rotation_z(alpha) * make_rotation_y(beta) * make_rotation_x(gamma);
  rotation_ = orthonormalize(rotation_ * m);
  camera_.look = look();
  camera_.up = up();
}

dvec3 FreeCamera::look() const {
  return rotation_ * kStartLook;
}
dvec3 FreeCamera::up() const {
  return rotation_ * kStartUp;
}
dvec3 FreeCamera::right() const {
  return glm::cross(look(), up());
}

}  // namespace promin
