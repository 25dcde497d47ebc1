// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "view/camera_control.h"

namespace promin::app {
namespace {

constexpr double kHeight = 360.0;
constexpr vec3 kUp(0.0F, 1.0F, 0.0F);

/// The scene is a cube of side 2 around this point. The camera is ten units in front of its middle.
const vec3 kMiddle(1.0F, 2.0F, 3.0F);
CameraControl make_control() {
  Camera camera;
  camera.eye = kMiddle + vec3(0.0F, 0.0F, 10.0F);
  return {camera, Bounds{kMiddle - 1.0F, kMiddle + 1.0F}, kUp};
}

/// Holds the key that moves the camera ahead for a second, and the key for fast motion for the middle half of this
/// second. The frames are at these times.
Motion fly(const std::vector<double>& frame_times) {
  MotionSum motion;
  motion.take(1.0);
  Motion sum;
  const auto take = [&](double time) {
    const Motion part = motion.take(time);
    sum.travel += part.travel;
    sum.roll += part.roll;
  };
  const auto play = [&](double from, double to) {
    for (const double time : frame_times) {
      if (time >= from && time < to) take(time);
    }
  };
  motion.set(Hold::kAhead, true, 1.0);
  motion.set(Hold::kRollLeft, true, 1.0);
  play(1.0, 1.25);
  motion.set(Hold::kFast, true, 1.25);
  play(1.25, 1.75);
  motion.set(Hold::kFast, false, 1.75);
  play(1.75, 2.0);
  motion.set(Hold::kAhead, false, 2.0);
  motion.set(Hold::kRollLeft, false, 2.0);
  take(3.0);
  return sum;
}

TEST(Motion, DoesNotDependOnTheFrames) {
  const Motion expected = fly({});
  EXPECT_NEAR(expected.travel.z, 0.5 + 0.5 * MotionSum::kFastFactor, 1e-12);
  EXPECT_NEAR(glm::length(fly({1.1, 1.3, 1.31, 1.9}).travel - expected.travel), 0.0, 1e-12);
  EXPECT_NEAR(fly({1.5, 1.99}).roll, expected.roll, 1e-12);
}

TEST(Motion, OppositeKeysCancelAndReleasedOnesRest) {
  MotionSum motion;
  motion.set(Hold::kLeft, true, 0.0);
  motion.set(Hold::kRight, true, 0.0);
  EXPECT_TRUE(motion.is_held());
  EXPECT_TRUE(motion.take(5.0).is_none());
  motion.set(Hold::kLeft, false, 5.0);
  motion.release_all(6.0);
  EXPECT_FALSE(motion.is_held());
  EXPECT_EQ(motion.take(9.0).travel, dvec3(1.0, 0.0, 0.0));
}

TEST(CameraControl, KeepsTheBitsOfACameraThatRests) {
  Camera camera;
  camera.eye = vec3(0.1F, 0.2F, 0.3F);
  camera.look = glm::normalize(vec3(0.3F, -0.2F, -0.9F));
  camera.up = glm::normalize(glm::cross(glm::cross(camera.look, vec3(0, 1, 0)), camera.look));
  CameraControl control(camera, Bounds(), kUp);
  control.apply({}, kHeight);
  EXPECT_EQ(control.camera().look, camera.look);
  EXPECT_EQ(control.camera().up, camera.up);
  EXPECT_EQ(control.camera().eye, camera.eye);
}

// The point under the pointer in the middle stays there, except for terms of second order.
TEST(CameraControl, ADragTurnsByTheFieldOfView) {
  CameraControl control(Camera{}, Bounds(), kUp);
  Motion motion;
  motion.turn = dvec2(kHeight, 0.0);
  control.apply(motion, kHeight);
  const double angle = std::acos(static_cast<double>(glm::dot(control.camera().look, Camera{}.look)));
  EXPECT_NEAR(angle, static_cast<double>(Camera{}.yfov), 1e-6);
  EXPECT_LT(control.camera().look.x, 0.0F);  // to the right, so the camera turns to the left
}

TEST(CameraControl, AnOrbitFacesItsCenterAtTheSameDistance) {
  Camera camera;
  camera.eye = vec3(3, 1, 8);
  CameraControl control(camera, Bounds(), kUp);
  const dvec3 center(0.5, -1.0, 0.25);
  const double distance = glm::distance(dvec3(camera.eye), center);
  control.orbit(center);
  Motion motion;
  motion.travel = dvec3(0.01, 0.02, 0.0);
  motion.turn = dvec2(3.0, -2.0);
  motion.roll = 0.01;
  for (int i = 0; i < 10000; ++i) {
    control.apply(motion, kHeight);
    if (i % 1000 > 0) continue;
    const dvec3 ahead = center - control.position();
    ASSERT_NEAR(glm::length(ahead), distance, 1e-9);
    ASSERT_NEAR(glm::dot(glm::normalize(ahead), dvec3(control.camera().look)), 1.0, 1e-6);
  }
  motion = {};
  motion.travel.z = 1.0;
  control.apply(motion, kHeight);
  EXPECT_LT(glm::distance(control.position(), center), 0.5 * distance);
}

TEST(CameraControl, ADragTakesItAroundTheMiddleOfTheScene) {
  CameraControl control = make_control();
  Motion motion;
  motion.orbit = dvec2(0.5 * kHeight, 0.0);  // half of the window's height is a quarter of the circle
  control.apply(motion, kHeight);
  EXPECT_NEAR(glm::distance(control.position(), dvec3(kMiddle) + dvec3(-10.0, 0.0, 0.0)), 0.0, 1e-5);
  EXPECT_NEAR(glm::dot(dvec3(control.camera().look), dvec3(1.0, 0.0, 0.0)), 1.0, 1e-6);
  // For any motion of the pointer downwards, the camera does not reach the point straight above and stays upright.
  motion.orbit = dvec2(0.0, 10.0 * kHeight);
  for (int i = 0; i < 5; ++i) control.apply(motion, kHeight);
  EXPECT_NEAR(glm::distance(control.position(), dvec3(kMiddle)), 10.0, 1e-4);
  EXPECT_GT(control.position().y, 11.99);
  EXPECT_GT(control.camera().up.y, 0.0F);
}

TEST(CameraControl, TheWheelGoesNearerToWhatItLooksAt) {
  CameraControl control = make_control();
  Motion motion;
  motion.zoom = 3.0;
  control.apply(motion, kHeight);
  const double near = glm::distance(control.position(), dvec3(kMiddle));
  EXPECT_LT(near, 7.0);
  EXPECT_GT(near, 5.0);
  motion.zoom = -3.0;
  control.apply(motion, kHeight);
  EXPECT_NEAR(glm::distance(control.position(), dvec3(kMiddle)), 10.0, 1e-5);
}

TEST(CameraControl, WhatIsUnderThePointerGoesWithIt) {
  CameraControl control = make_control();
  Motion motion;
  motion.pan = dvec2(kHeight, 0.0);
  control.apply(motion, kHeight);
  const double height = 2.0 * 10.0 * std::tan(0.5 * double{control.camera().yfov});
  EXPECT_NEAR(control.position().x, double{kMiddle.x} - height, 1e-5);
  EXPECT_NEAR(control.position().z, double{kMiddle.z} + 10.0, 1e-5);
}

TEST(CameraControl, ResetGoesBackToTheStart) {
  Camera camera;
  camera.eye = vec3(1, 2, 3);
  CameraControl control(camera, Bounds(), kUp);
  control.set_speed(2.0);
  Motion motion;
  motion.travel = dvec3(0, 0, 3);
  control.apply(motion, kHeight);
  EXPECT_EQ(control.camera().eye, vec3(1, 2, -3));
  control.orbit(dvec3(0.0));
  control.reset();
  EXPECT_EQ(control.camera().eye, camera.eye);
  EXPECT_FALSE(control.is_orbiting());
}

}  // namespace
}  // namespace promin::app
