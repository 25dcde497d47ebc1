// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/camera.h"

#include <gtest/gtest.h>

#include <bit>
#include <numbers>
#include <random>

#include "promin/error.h"
#include "support/expect_near.h"

namespace promin {
namespace {

using test::expect_near;

constexpr double kRight = std::numbers::pi / 2.0;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPoseTolerance = 1e-14;

/// Returns |QtQ - I|: the largest element.
double orthonormality_error(const dmat3& q) {
  const dmat3 difference = glm::transpose(q) * q - dmat3(1.0);
  double error = 0.0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) error = std::fmax(error, std::abs(difference[column][row]));
  }
  return error;
}

/// Returns Q as the renderer gets it: right, up and -look in fp32.
dmat3 matrix_in_use(const Camera& camera) {
  return {dvec3(glm::cross(camera.look, camera.up)), dvec3(camera.up), -dvec3(camera.look)};
}

bool are_same_bits(const vec3& a, const vec3& b) {
  for (int i = 0; i < 3; ++i) {
    if (std::bit_cast<uint32_t>(static_cast<float>(a[i])) != std::bit_cast<uint32_t>(static_cast<float>(b[i]))) {
      return false;
    }
  }
  return true;
}

TEST(RotationMatrices, TurnEachAxisTowardsTheNext) {
  expect_near(make_rotation_x(kRight) * dvec3(0, 1, 0), {0, 0, 1}, kPoseTolerance);
  expect_near(make_rotation_y(kRight) * dvec3(0, 0, 1), {1, 0, 0}, kPoseTolerance);
  expect_near(make_rotation_z(kRight) * dvec3(1, 0, 0), {0, 1, 0}, kPoseTolerance);
}

TEST(RotationMatrices, AreTheFormulas) {
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  const dvec3 v(2, 3, 5);
  expect_near(make_rotation_x(0.3) * v, {2, 3 * c - 5 * s, 3 * s + 5 * c}, kPoseTolerance);
  expect_near(make_rotation_y(0.3) * v, {2 * c + 5 * s, 3, -2 * s + 5 * c}, kPoseTolerance);
  expect_near(make_rotation_z(0.3) * v, {2 * c - 3 * s, 2 * s + 3 * c, 5}, kPoseTolerance);
}

TEST(FreeCamera, StartsAtTheOriginLookingAlongMinusZ) {
  const FreeCamera camera;
  EXPECT_EQ(camera.position(), dvec3(0.0));
  EXPECT_EQ(camera.rotation(), dmat3(1.0));
  EXPECT_EQ(camera.look(), dvec3(0, 0, -1));
  EXPECT_EQ(camera.up(), dvec3(0, 1, 0));
  EXPECT_EQ(camera.right(), dvec3(1, 0, 0));
}

TEST(FreeCamera, PositiveBetaTurnsLeft) {
  FreeCamera camera;
  camera.rotate(0, kRight, 0);
  expect_near(camera.look(), {-1, 0, 0}, kPoseTolerance);
  expect_near(camera.up(), {0, 1, 0}, kPoseTolerance);
  expect_near(camera.right(), {0, 0, -1}, kPoseTolerance);
}

TEST(FreeCamera, PositiveGammaLooksUp) {
  FreeCamera camera;
  camera.rotate(0, 0, kRight);
  expect_near(camera.look(), {0, 1, 0}, kPoseTolerance);
  expect_near(camera.up(), {0, 0, 1}, kPoseTolerance);
  expect_near(camera.right(), {1, 0, 0}, kPoseTolerance);
}

TEST(FreeCamera, PositiveAlphaRollsAnticlockwiseSeenFromBehind) {
  FreeCamera camera;
  camera.rotate(kRight, 0, 0);
  expect_near(camera.look(), {0, 0, -1}, kPoseTolerance);
  expect_near(camera.up(), {-1, 0, 0}, kPoseTolerance);
  expect_near(camera.right(), {0, 1, 0}, kPoseTolerance);
}

TEST(FreeCamera, OneRotationIsMzMyMx) {
  FreeCamera camera;
  camera.rotate(0.2, 0.3, 0.5);
  // Mx takes -Z to (0, sin, -cos); My and then Mz are written out.
  const dvec3 after_x(0, std::sin(0.5), -std::cos(0.5));
  const dvec3 after_y(std::sin(0.3) * after_x.z, after_x.y, std::cos(0.3) * after_x.z);
  const dvec3 after_z(std::cos(0.2) * after_y.x - std::sin(0.2) * after_y.y,
                      std::sin(0.2) * after_y.x + std::cos(0.2) * after_y.y, after_y.z);
  expect_near(camera.look(), after_z, kPoseTolerance);
}

TEST(FreeCamera, RotatesAboutItsOwnAxes) {
  // The rotation is Q M, so "up" is still the camera's up after a turn to the left. M Q would rotate about the world's
  // X axis.
  FreeCamera camera;
  camera.rotate(0, kRight, 0);
  camera.rotate(0, 0, kRight);
  expect_near(camera.look(), {0, 1, 0}, kPoseTolerance);
  expect_near(camera.up(), {1, 0, 0}, kPoseTolerance);
}

TEST(FreeCamera, FourStepsOfTenDegreesAreForty) {
  FreeCamera camera;
  for (int step = 0; step < 4; ++step) camera.rotate(0, 10 * kDegree, 0);
  expect_near(camera.look(), {-std::sin(40 * kDegree), 0, -std::cos(40 * kDegree)}, kPoseTolerance);
}

TEST(FreeCamera, MovesAlongItsOwnAxes) {
  FreeCamera camera;
  camera.rotate(0, kRight, 0);
  camera.move(2, 0, 0);
  expect_near(camera.position(), {-2, 0, 0}, kPoseTolerance);
  camera.move(0, 3, 0);
  expect_near(camera.position(), {-2, 3, 0}, kPoseTolerance);
  camera.move(0, 0, 5);
  expect_near(camera.position(), {-2, 3, -5}, kPoseTolerance);
  expect_near(camera.camera().eye, {-2, 3, -5}, kPoseTolerance);
}

TEST(FreeCamera, DoesNotDriftInAHundredThousandSteps) {
  std::mt19937 random(1);
  const auto angle = [&] { return (static_cast<double>(random()) * 0x1p-32 - 0.5) * 2.0; };
  FreeCamera camera;
  for (int step = 0; step < 100'000; ++step) {
    const double alpha = angle();
    const double beta = angle();
    camera.rotate(alpha, beta, angle());
    ASSERT_LE(orthonormality_error(matrix_in_use(camera.camera())), 1e-6) << step;
    ASSERT_LE(orthonormality_error(camera.rotation()), 1e-14) << step;
  }
}

TEST(FreeCamera, FindsItsWayBackAfterAHundredThousandSteps) {
  FreeCamera camera;
  for (int step = 0; step < 50'000; ++step) camera.rotate(0.001 * step, -0.7, 0.3);
  for (int step = 49'999; step >= 0; --step) {
    camera.rotate(0, 0, -0.3);
    camera.rotate(0, 0.7, 0);
    camera.rotate(-0.001 * step, 0, 0);
  }
  expect_near(camera.look(), {0, 0, -1}, 1e-10);
  expect_near(camera.up(), {0, 1, 0}, 1e-10);
}

TEST(FreeCamera, HasNoGimbalLock) {
  // The camera looks straight up and then turns. Every step turns it by the given angle, and `look` stays in the same
  // plane.
  FreeCamera camera;
  camera.rotate(0, 0, kRight);
  const dvec3 axis = camera.up();
  for (int step = 0; step < 360; ++step) {
    const dvec3 before = camera.look();
    camera.rotate(0, kDegree, 0);
    EXPECT_NEAR(std::acos(glm::dot(before, camera.look())), kDegree, 1e-12);
    expect_near(camera.up(), axis, 1e-13);
  }
  // The camera then passes the zenith, and `up` turns at the same rate.
  for (int step = 0; step < 180; ++step) {
    const dvec3 before = camera.up();
    camera.rotate(0, 0, kDegree);
    EXPECT_NEAR(std::acos(glm::dot(before, camera.up())), kDegree, 1e-12);
  }
  expect_near(camera.look(), {0, -1, 0}, 1e-12);
}

TEST(FreeCamera, GivesBackThePoseItTookToTheBit) {
  Camera taken;
  taken.name = "front";
  taken.eye = {0.1F, -0.0F, 1e7F};
  taken.look = glm::normalize(vec3(0.3F, -0.2F, -0.7F));
  taken.up = glm::normalize(glm::cross(glm::cross(taken.look, vec3(0.0F, 1.0F, 0.0F)), taken.look));
  taken.yfov = 1.1F;
  const Camera given = FreeCamera(taken).camera();
  EXPECT_EQ(given.name, "front");
  EXPECT_EQ(given.yfov, 1.1F);
  EXPECT_TRUE(are_same_bits(given.eye, taken.eye));
  EXPECT_TRUE(are_same_bits(given.look, taken.look));
  EXPECT_TRUE(are_same_bits(given.up, taken.up));

  FreeCamera moved(taken);
  moved.move(1, 0, 0);
  EXPECT_TRUE(are_same_bits(moved.camera().look, taken.look));
  EXPECT_TRUE(are_same_bits(moved.camera().up, taken.up));

  const FreeCamera posed = FreeCamera::from_pose(taken.eye, taken.look, taken.up);
  EXPECT_TRUE(are_same_bits(posed.camera().eye, taken.eye));
  EXPECT_TRUE(are_same_bits(posed.camera().look, taken.look));
  EXPECT_TRUE(are_same_bits(posed.camera().up, taken.up));
}

TEST(FreeCamera, ATakenPoseIsOrthonormalOnceRotated) {
  Camera taken;
  taken.look = {0.6F, 0.0F, -0.8F};
  FreeCamera camera(taken);
  camera.rotate(0, 0.1, 0);
  EXPECT_LE(orthonormality_error(camera.rotation()), 1e-13);
}

TEST(FreeCamera, DirectionsOfAnyLengthAndAngleMakeAPose) {
  const FreeCamera camera = FreeCamera::from_pose(vec3(0.0F), {0, 0, 3}, {0, 2, 5});
  expect_near(camera.look(), {0, 0, 1}, kPoseTolerance);
  expect_near(camera.up(), {0, 1, 0}, kPoseTolerance);
  expect_near(camera.right(), {-1, 0, 0}, kPoseTolerance);
  expect_near(FreeCamera::from_pose(vec3(0.0F), {1e30F, 0, 0}, {0, 1e-30F, 0}).right(), {0, 0, 1}, kPoseTolerance);
}

TEST(FreeCamera, DirectionsThatGiveNoPoseAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const vec3 x(1, 0, 0);
  for (const vec3& bad : {vec3(0.0F), x, -2.0F * x, vec3(nan, 0, 0), vec3(0, infinity, 0)}) {
    EXPECT_THROW(FreeCamera::from_pose(vec3(0.0F), x, bad), UsageError);
    EXPECT_THROW(FreeCamera::from_pose(vec3(0.0F), bad, x), UsageError);
  }
}

}  // namespace
}  // namespace promin
