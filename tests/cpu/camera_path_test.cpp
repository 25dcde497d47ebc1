// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "camera.h"
#include "core/error.h"
#include "cpu/temp_folder.h"

namespace promin {
namespace {

using testing::HasSubstr;

/// As uneven as fp32 allows: turned in many small steps.
CameraPath make_path(size_t count) {
  CameraPath path;
  std::mt19937 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  FreeCamera camera;
  for (size_t i = 0; i < count; ++i) {
    camera.move(uniform(), 1e3 * uniform(), uniform() - 0.5);
    camera.rotate(uniform(), uniform(), uniform());
    TimedCamera frame{static_cast<double>(i) + uniform(), camera.camera()};
    frame.camera.yfov = static_cast<float>(0.01 + 3.0 * uniform());
    frame.camera.near = static_cast<float>(uniform());
    path.push_back(frame);
  }
  return path;
}

void expect_same_bits(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.projection, b.projection);
  EXPECT_EQ(a.eye, b.eye);
  EXPECT_EQ(a.look, b.look);
  EXPECT_EQ(a.up, b.up);
  EXPECT_EQ(a.yfov, b.yfov);
  EXPECT_EQ(a.ymag, b.ymag);
  EXPECT_EQ(a.near, b.near);
}

class CameraPathTest : public TempFolder {
 protected:
  std::filesystem::path file() const { return folder_ / "path.json"; }

  /// What reading a file of this text says; empty if nothing is wrong.
  std::string refusal(const std::string& text) const {
    std::ofstream(file()) << text;
    return message_of([&] { read_camera_path(file()); });
  }
  std::string refusal_of_frames(const std::string& frames) const {
    return refusal(R"({"format": "promin camera path", "version": 1, "frames": [)" + frames + "]}");
  }
};

TEST_F(CameraPathTest, AFileKeepsEveryBit) {
  CameraPath path = make_path(1000);
  path[1].camera.projection = Projection::kOrthographic;
  path[1].camera.ymag = 0.1F;
  path[1].camera.yfov = Camera().yfov;
  write_camera_path(file(), path);
  const CameraPath read = read_camera_path(file());
  ASSERT_EQ(read.size(), path.size());
  for (size_t i = 0; i < path.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(read[i].time_s, path[i].time_s);
    expect_same_bits(read[i].camera, path[i].camera);
  }
}

TEST_F(CameraPathTest, StoredFramesComeBackToTheBitAndEndsHold) {
  const CameraPath path = make_path(100);
  for (const TimedCamera& frame : path) expect_same_bits(camera_at(path, frame.time_s), frame.camera);
  expect_same_bits(camera_at(path, -1.0), path.front().camera);
  expect_same_bits(camera_at(path, 1e9), path.back().camera);
}

TEST_F(CameraPathTest, BetweenFramesTheBasisStaysOrthonormal) {
  const CameraPath path = make_path(100);
  for (double time = path.front().time_s; time < path.back().time_s; time += 0.037) {
    const Camera camera = camera_at(path, time);
    EXPECT_NEAR(glm::length(dvec3(camera.look)), 1.0, 1.2e-7);
    EXPECT_NEAR(glm::length(dvec3(camera.up)), 1.0, 1.2e-7);
    EXPECT_NEAR(glm::dot(dvec3(camera.look), dvec3(camera.up)), 0.0, 1.2e-7);
  }
}

TEST_F(CameraPathTest, HalfWayIsHalfTheTurnAndHalfTheWay) {
  for (const double angle : {0.3, 1.5, 3.0}) {
    Camera start;
    start.yfov = 1.0F;
    FreeCamera turned(start);
    turned.move(4.0, 2.0, 0.0);
    turned.rotate(0.0, angle, 0.0);
    CameraPath path{{1.0, start}, {3.0, turned.camera()}};
    path[1].camera.yfov = 0.5F;
    const Camera half = camera_at(path, 2.0);
    EXPECT_EQ(half.eye, vec3(0, 1, -2));
    EXPECT_FLOAT_EQ(half.yfov, 0.75F);
    EXPECT_NEAR(half.look.x, -std::sin(0.5 * angle), 1e-6);
    EXPECT_NEAR(half.look.z, -std::cos(0.5 * angle), 1e-6);
    EXPECT_NEAR(half.up.y, 1.0, 1e-6);
  }
}

TEST_F(CameraPathTest, BadFilesAreRefusedWithAllTheirProblems) {
  const std::string good = R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 40})";
  EXPECT_EQ(refusal_of_frames(good), "");
  const std::pair<std::string, std::string> cases[] = {
      {"", "there are no frames"},
      {good + ", " + good, "frames[1]; order the frames by their times"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 40})", "zero or parallel"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0]})", "one of fov_deg and ymag"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 4, "ymag": 1})", "one of"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 180})", "out of range"},
      {R"({"time_s": -1, "eye": [0, 0], "look": [0, 0, -1], "up": "y", "fov_deg": 40})", "1 of 3 problems"},
      {R"({"eye": [0, 0, 1e99], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 40})", "\"time_s\" is missing"},
      {"7", "7 stands where an object belongs"},
  };
  for (const auto& [frames, part] : cases) EXPECT_THAT(refusal_of_frames(frames), HasSubstr(part)) << frames;
  EXPECT_THAT(refusal("{"), HasSubstr("the JSON cannot be read"));
  EXPECT_THAT(refusal("[]"), HasSubstr("a JSON array stands where an object belongs"));
  EXPECT_THAT(refusal(std::string(1000, '[')), HasSubstr("nests 1000 deep"));
  EXPECT_THAT(refusal(R"({"format": "other", "version": 2, "frames": []})"), HasSubstr("is none of promin camera"));
  EXPECT_THROW(read_camera_path(folder_ / "none.json"), InputError);
}

}  // namespace
}  // namespace promin
