// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/camera_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "promin/error.h"
#include "support/temp_folder.h"
#include "work/pictures/camera.h"

namespace promin {
namespace {

using testing::HasSubstr;

/// Returns a path with many small rotations, so that its axes are as inexact as fp32 allows.
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
    path.frames.push_back(frame);
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

  /// Returns the error of reading a file with this text; empty if there is none.
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
  path.frames[1].camera.projection = Projection::kOrthographic;
  path.frames[1].camera.ymag = 0.1F;
  path.frames[1].camera.yfov = Camera().yfov;
  for (const std::optional<double> fps : {std::optional(29.97), std::optional<double>()}) {
    path.fps = fps;
    write_camera_path(file(), path);
    EXPECT_EQ(read_camera_path(file()).fps, fps);
  }
  const CameraPath read = read_camera_path(file());
  ASSERT_EQ(read.frames.size(), path.frames.size());
  for (size_t i = 0; i < path.frames.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(read.frames[i].time_s, path.frames[i].time_s);
    expect_same_bits(read.frames[i].camera, path.frames[i].camera);
  }
}

TEST_F(CameraPathTest, StoredFramesComeBackToTheBitAndEndsHold) {
  const CameraPath path = make_path(100);
  for (const TimedCamera& frame : path.frames) expect_same_bits(camera_at(path, frame.time_s), frame.camera);
  expect_same_bits(camera_at(path, -1.0), path.frames.front().camera);
  expect_same_bits(camera_at(path, 1e9), path.frames.back().camera);
}

TEST_F(CameraPathTest, BetweenFramesTheBasisStaysOrthonormal) {
  const CameraPath path = make_path(100);
  for (double time = path.frames.front().time_s; time < path.frames.back().time_s; time += 0.037) {
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
    CameraPath path{{{1.0, start}, {3.0, turned.camera()}}, std::nullopt};
    path.frames[1].camera.yfov = 0.5F;
    const Camera half = camera_at(path, 2.0);
    EXPECT_EQ(half.eye, vec3(0, 1, -2));
    EXPECT_FLOAT_EQ(half.yfov, 0.75F);
    EXPECT_NEAR(half.look.x, -std::sin(0.5 * angle), 1e-6);
    EXPECT_NEAR(half.look.z, -std::cos(0.5 * angle), 1e-6);
    EXPECT_NEAR(half.up.y, 1.0, 1e-6);
  }
}

// A slerp of a single rotation would give a different result.
TEST_F(CameraPathTest, ARestKeepsItsBits) {
  CameraPath path = make_path(100);
  for (size_t i = 1; i < path.frames.size(); i += 2) path.frames[i].camera = path.frames[i - 1].camera;
  for (size_t i = 1; i < path.frames.size(); i += 2) {
    const double between = 0.7 * path.frames[i - 1].time_s + 0.3 * path.frames[i].time_s;
    expect_same_bits(camera_at(path, between), path.frames[i].camera);
  }
}

TEST_F(CameraPathTest, PicturesAreTakenBySecondsOrAsStored) {
  CameraPath path = make_path(3);
  path.frames[0].time_s = 0.1;
  path.frames[1].time_s = 0.2;
  path.frames[2].time_s = 0.7;  // 0.7 times 10 is slightly less than 7
  const PathPictures stored(path);
  ASSERT_EQ(stored.count(), 3U);
  EXPECT_EQ(stored.interval_s(), 0.0);
  for (size_t i = 0; i < 3; ++i) expect_same_bits(stored.camera(i), path.frames[i].camera);

  const PathPictures timed(path, 10.0);
  ASSERT_EQ(timed.count(), 8U);
  EXPECT_EQ(timed.interval_s(), 0.1);
  for (const size_t i : {0U, 1U}) expect_same_bits(timed.camera(i), path.frames[0].camera);
  expect_same_bits(timed.camera(2), path.frames[1].camera);
  expect_same_bits(timed.camera(4), camera_at(path, 0.4));
  EXPECT_NE(timed.camera(4).eye, path.frames[1].camera.eye);
  expect_same_bits(timed.camera(7), path.frames[2].camera);
  EXPECT_EQ(PathPictures(path, 9.0).count(), 7U) << "the last at 6/9 s";

  path.fps = 20.0;
  EXPECT_EQ(PathPictures(path).count(), 15U);
  EXPECT_EQ(PathPictures(path, 10.0).count(), 8U);
  EXPECT_EQ(PathPictures(path, PathPictures::kStored).count(), 3U);
  path.frames[2].time_s = 1e9;
  EXPECT_THROW(PathPictures{path}, UsageError);
}

TEST_F(CameraPathTest, AFrameOfVersion2MayLookAtAPoint) {
  const auto text = [](int version, const std::string& look) {
    return R"({"format": "promin camera path", "version": )" + std::to_string(version) +
           R"(, "frames": [{"time_s": 0, "eye": [1000000.1, 0, 5], "up": [0, 1, 0], "fov_deg": 40)" + look + "}]}";
  };
  const std::string look = R"(, "look": [0.6, 0, -0.8])";
  const std::string look_at = R"(, "look_at": [1000003.1, 0, 1])";
  const auto look_of = [&](int version, const std::string& words) {
    std::ofstream(folder_ / "path.json") << text(version, words);
    return read_camera_path(folder_ / "path.json").frames[0].camera.look;
  };
  EXPECT_EQ(look_of(1, look), vec3(0.6F, 0.0F, -0.8F));
  EXPECT_EQ(look_of(2, look), vec3(0.6F, 0.0F, -0.8F));
  EXPECT_EQ(look_of(1, look + look_at), vec3(0.6F, 0.0F, -0.8F)) << "version 1 knows no points";
  EXPECT_NEAR(glm::length(look_of(2, look_at) - vec3(0.6F, 0.0F, -0.8F)), 0.0F, 1e-6F);
  EXPECT_THAT(refusal(text(1, look_at)), HasProblem("path.frame.wrong"));
  EXPECT_THAT(refusal(text(2, "")), HasProblem("path.frame.choice"));
  EXPECT_THAT(refusal(text(2, look + look_at)), HasProblem("path.frame.choice"));
  EXPECT_THAT(refusal(text(2, R"(, "look_at": [1000000.1, 0, 5])")), HasProblem("camera.direction"));
  EXPECT_THAT(refusal(text(3, look)), HasProblem("json.range version:"));
}

TEST_F(CameraPathTest, BadFilesAreRefusedWithAllTheirProblems) {
  const std::string good = R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 40})";
  EXPECT_EQ(refusal_of_frames(good), "");
  const std::pair<std::string, std::string> cases[] = {
      {"", "path.frames.missing"},
      {good + ", " + good, "path.time.order frames[1]"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 40})",
       "camera.direction parallel"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0]})", "path.frame.choice fov_deg ymag"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 4, "ymag": 1})",
       "path.frame.choice fov_deg ymag"},
      {R"({"time_s": 0, "eye": [0, 0, 0], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 180})", "json.range 180"},
      {R"({"time_s": -1, "eye": [0, 0], "look": [0, 0, -1], "up": "y", "fov_deg": 40})", "json.type array"},
      {R"({"eye": [0, 0, 1e99], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 40})", "json.missing \"time_s\""},
      {"7", "json.type 7 object"},
  };
  for (const auto& [frames, problem] : cases) EXPECT_THAT(refusal_of_frames(frames), HasProblem(problem)) << frames;
  EXPECT_THAT(refusal(R"({"format": "promin camera path", "version": 1, "fps": 0, "frames": []})"),
              HasSubstr("path.json: fps: "));
  EXPECT_THAT(refusal("{"), HasProblem("json.syntax"));
  EXPECT_THAT(refusal("[]"), HasProblem("json.type array object"));
  EXPECT_THAT(refusal(std::string(1000, '[')), HasProblem("json.depth 1000"));
  EXPECT_THAT(refusal(R"({"format": "other", "version": 2, "frames": []})"), HasProblem("json.choice promin camera"));
  EXPECT_THROW(read_camera_path(folder_ / "none.json"), InputError);
}

}  // namespace
}  // namespace promin
