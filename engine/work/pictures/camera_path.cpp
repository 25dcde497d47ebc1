// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "formats/gltf/json_rule.h"
#include "formats/gltf/parse_json.h"
#include "promin/error.h"
#include "promin/validate.h"
#include "work/pictures/camera.h"

namespace promin {
namespace {

using nlohmann::json;

constexpr double kMaxTime = 1e9;
/// The smallest distance of a field of view from 0 and 180 degrees. With a smaller one, fp32 radians show nothing.
constexpr double kMinFovDeg = 1e-5;
constexpr double kMaxFovDeg = 180.0 - kMinFovDeg;
const char* const kWriteAnew = "record the path again or correct the file";

const std::array kRules{
    rules::object(""),
    rules::needed(rules::choice("format", "promin camera path")),
    rules::needed(rules::integer("version", 1, 2)),
    rules::number("fps", PathPictures::kMinFps, PathPictures::kMaxFps),
    rules::needed(rules::array("frames")),
    rules::object("frames[]"),
    rules::needed(rules::number("frames[].time_s", 0.0, kMaxTime)),
    rules::needed(rules::numbers("frames[].eye", 3, -kMaxCoordinate, kMaxCoordinate)),
    rules::numbers("frames[].look", 3, -kMaxCoordinate, kMaxCoordinate),
    rules::numbers("frames[].look_at", 3, -kMaxCoordinate, kMaxCoordinate),
    rules::needed(rules::numbers("frames[].up", 3, -kMaxCoordinate, kMaxCoordinate)),
    rules::number("frames[].fov_deg", kMinFovDeg, kMaxFovDeg),
    rules::number("frames[].ymag", kMinSize, kMaxCoordinate),
    rules::number("frames[].near", 0.0, kMaxCoordinate),
};

vec3 read_vector(const json& v) {
  return {v[0].get<float>(), v[1].get<float>(), v[2].get<float>()};
}

dvec3 read_place(const json& v) {
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

/// Refuses a frame that does not have exactly one of its version's directions of view.
void check_look(const json& frame, int version, const std::string& place, LoadReport& report) {
  if (version == 1) {
    if (!frame.contains("look")) report.refuse("path.frame.wrong", "\"look\" is missing", place, kWriteAnew);
  } else if (frame.contains("look") == frame.contains("look_at")) {
    report.refuse("path.frame.choice", "a frame has both look and look_at, or neither", place,
                  "give only one: a direction as look, or a point as look_at");
  }
}

/// Reads a valid frame.
TimedCamera read_frame(const json& frame, int version, const std::string& place, LoadReport& report) {
  TimedCamera timed;
  timed.time_s = frame["time_s"].get<double>();
  const bool looks_at = version > 1 && frame.contains("look_at");
  try {
    const vec3 look =
        looks_at ? vec3(read_place(frame["look_at"]) - read_place(frame["eye"])) : read_vector(frame["look"]);
    timed.camera = FreeCamera::from_pose(read_vector(frame["eye"]), look, read_vector(frame["up"])).camera();
  } catch (const UsageError&) {
    report.refuse("camera.direction",
                  looks_at ? "look_at is the position of the eye, or lies straight above or below it"
                           : "look and up are zero or parallel",
                  place, looks_at ? "give another point or another up" : "give two directions that differ");
  }
  if (frame.contains("fov_deg") == frame.contains("ymag")) {
    report.refuse("path.frame.choice", "a frame has both fov_deg and ymag, or neither", place,
                  "give fov_deg for a perspective camera, or ymag for an orthographic one");
  } else if (frame.contains("fov_deg")) {
    timed.camera.yfov = static_cast<float>(glm::radians(frame["fov_deg"].get<double>()));
  } else {
    timed.camera.projection = Projection::kOrthographic;
    timed.camera.ymag = frame["ymag"].get<float>();
  }
  timed.camera.near = frame.value("near", 0.0F);
  timed.rest = read_place(frame["eye"]) - dvec3(timed.camera.eye);
  return timed;
}

/// Nine digits distinguish any two floats.
std::string write_vector(const vec3& v) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", v.x, v.y, v.z);
}

/// Returns the eye as text. A position far from the origin needs more digits: as many as reproduce it.
std::string write_eye(const TimedCamera& frame) {
  if (frame.rest == dvec3(0.0)) return write_vector(frame.camera.eye);
  const dvec3 eye = frame.eye();
  return fmt::format("[{}, {}, {}]", eye.x, eye.y, eye.z);
}

std::string write_frame(const TimedCamera& frame) {
  const Camera& camera = frame.camera;
  // Nine digits of degrees distinguish any two floats in radians, too.
  const std::string projection =
      camera.projection == Projection::kPerspective
          ? fmt::format("\"fov_deg\": {:.9g}", glm::degrees(static_cast<double>(camera.yfov)))
          : fmt::format("\"ymag\": {:.9g}", camera.ymag);
  return fmt::format(R"({{"time_s": {}, "eye": {}, "look": {}, "up": {}, {}, "near": {:.9g}}})", frame.time_s,
                     write_eye(frame), write_vector(camera.look), write_vector(camera.up), projection, camera.near);
}

/// Returns the rotation of a camera: the Q of FreeCamera.
glm::dquat rotation_of(const Camera& camera) {
  return glm::normalize(glm::dquat(FreeCamera(camera).rotation()));
}

/// Returns a camera between two cameras. `share` is in (0, 1).
Camera interpolate(const Camera& from, const Camera& to, double share) {
  // A camera that does not move is returned unchanged, without rounding.
  if (shows_same(from, to)) return from;
  const auto mix = [&](const auto& a, const auto& b) { return a + share * (b - a); };
  const auto mix_real = [&](float a, float b) { return static_cast<float>(mix(double{a}, double{b})); };
  Camera camera = from;
  camera.eye = vec3(mix(dvec3(from.eye), dvec3(to.eye)));
  const dmat3 rotation = glm::mat3_cast(glm::normalize(glm::slerp(rotation_of(from), rotation_of(to), share)));
  camera.look = vec3(-rotation[2]);
  camera.up = vec3(rotation[1]);
  camera.near = mix_real(from.near, to.near);
  if (from.projection != to.projection) return camera;
  camera.yfov = mix_real(from.yfov, to.yfov);
  camera.ymag = mix_real(from.ymag, to.ymag);
  return camera;
}

/// Returns the path with cameras relative to this center.
CameraPath move_path(CameraPath path, const dvec3& center) {
  if (center == dvec3(0.0)) return path;
  for (TimedCamera& frame : path.frames) {
    frame.camera.eye = vec3(frame.eye() - center);
    frame.rest = center;
  }
  return path;
}

}  // namespace

CameraPath read_camera_path(const std::filesystem::path& file) {
  LoadReport report(file);
  const std::vector<std::byte> bytes = read_file(file);
  json document = parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, report, kWriteAnew);
  for (const JsonRule& rule : kRules) check_json_rule(document, rule, report);
  report.throw_if_refused();

  const int version = document["version"].get<int>();
  const json& frames = document["frames"];
  const auto place_of = [](size_t i) { return fmt::format("frames[{}]", i); };
  for (size_t i = 0; i < frames.size(); ++i) check_look(frames[i], version, place_of(i), report);
  report.throw_if_refused();

  CameraPath path;
  for (const json& frame : frames) {
    const std::string place = place_of(path.frames.size());
    const TimedCamera next = read_frame(frame, version, place, report);
    if (!path.frames.empty() && !(next.time_s > path.frames.back().time_s)) {
      report.refuse("path.time.order", "time_s does not increase from frame to frame", place,
                    "sort the frames by time");
    }
    path.frames.push_back(next);
  }
  if (document.contains("fps")) path.fps = document["fps"].get<double>();
  if (path.frames.empty()) report.refuse("path.frames.missing", "the path has no frames", "frames", kWriteAnew);
  report.throw_if_refused();
  return path;
}

void write_camera_path(const std::filesystem::path& file, const CameraPath& path) {
  std::string text = "{\n  \"format\": \"promin camera path\",\n  \"version\": 1,\n";
  if (path.fps) text += fmt::format("  \"fps\": {},\n", *path.fps);
  text += "  \"frames\": [";
  for (size_t i = 0; i < path.frames.size(); ++i) text += (i == 0 ? "\n    " : ",\n    ") + write_frame(path.frames[i]);
  write_text_file(file, text + "\n  ]\n}\n");
}

Camera camera_at(const CameraPath& path, double time_s) {
  const std::vector<TimedCamera>& frames = path.frames;
  assert(!frames.empty());
  const auto next = std::upper_bound(frames.begin(), frames.end(), time_s,
                                     [](double time, const TimedCamera& frame) { return time < frame.time_s; });
  if (next == frames.begin()) return frames.front().camera;
  const TimedCamera& last = *(next - 1);
  if (next == frames.end() || last.time_s == time_s) return last.camera;
  return interpolate(last.camera, next->camera, (time_s - last.time_s) / (next->time_s - last.time_s));
}

PathPictures::PathPictures(CameraPath path, std::optional<double> fps)
    : path_(std::move(path)), fps_(fps.value_or(path_.fps.value_or(kStored))), count_(path_.frames.size()) {
  if (fps_ == kStored) return;
  // Tolerance for the number of pictures: rounding may put the last frame's time slightly before its picture's time,
  // for example 0.3 s at 10 pictures per second.
  constexpr double kRounding = 1e-6;
  const double count = std::floor(path_.frames.back().time_s * fps_ + kRounding) + 1.0;
  if (count > static_cast<double>(kMaxCount)) {
    throw UsageError({"path.frames.many",
                      fmt::format("a path of {:g} s has {:.0f} pictures at {:g} per second, but the limit is {}",
                                  path_.frames.back().time_s, count, fps_, kMaxCount),
                      "", "lower --fps"});
  }
  count_ = static_cast<size_t>(count);
}

PathPictures PathPictures::moved_to(const dvec3& center) const {
  PathPictures moved = *this;
  moved.path_ = move_path(path_, center);
  return moved;
}

double PathPictures::time_s(size_t picture) const {
  return fps_ == kStored ? path_.frames[picture].time_s : static_cast<double>(picture) / fps_;
}

double PathPictures::seconds_after(size_t picture) const {
  if (fps_ != kStored) return 1.0 / fps_;
  if (count_ < 2) return 0.0;
  const size_t first = std::min(picture, count_ - 2);
  return time_s(first + 1) - time_s(first);
}

Camera PathPictures::camera_after(size_t picture, double seconds) const {
  return camera_at(path_, time_s(picture) + seconds);
}

Camera PathPictures::camera(size_t picture) const {
  assert(picture < count_);
  if (fps_ == kStored) return path_.frames[picture].camera;
  return camera_at(path_, static_cast<double>(picture) / fps_);
}

}  // namespace promin
