// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// A camera's pose and projection at a time, in seconds.
struct TimedCamera {
  double time_s = 0.0;
  Camera camera;
  /// What the camera's eye, which is fp32, lacks of its place in the world.
  dvec3 rest{0.0};

  dvec3 eye() const { return rest + dvec3(camera.eye); }
};

/// A flight of the camera over time.
struct CameraPath {
  /// At least one, times finite, not negative and strictly increasing.
  std::vector<TimedCamera> frames;
  /// The number of pictures a second that the flight is meant to be played with; nullopt: each frame is a picture.
  std::optional<double> fps;
};

/// Reads a file of docs/camera_path.md. Throws InputError with all that is wrong with it.
CameraPath read_camera_path(const std::filesystem::path& file);

/// Writes such a file atomically; reading it gives the same bits of poses, projections and times. Names and aspect
/// ratios of cameras are left out. Throws RunError.
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

/// The camera at a time. At a stored frame's time it is that frame's to the bit, and beyond the ends that of the first
/// or last frame. In between, rotations follow the shortest great arc and all else straight lines; a change of
/// projection waits for its frame.
Camera camera_at(const CameraPath& path, double time_s);

/// The pictures that a path is played as, for whoever renders or shows it: both get the same cameras, to the bit.
class PathPictures {
 public:
  /// Takes `fps` pictures a second, picture i at the time i / fps, until the last frame's time; with kStored the frames
  /// as they are stored; with nullopt what the path says. Throws UsageError for more pictures than kMaxCount.
  explicit PathPictures(CameraPath path, std::optional<double> fps = std::nullopt);

  /// The same pictures in a scene of this center (Scene::center).
  PathPictures moved_to(const dvec3& center) const;
  /// The number of pictures, at least one.
  size_t count() const { return count_; }
  Camera camera(size_t picture) const;
  /// The seconds from picture to picture; 0 where the pictures are the stored frames.
  double interval_s() const { return fps_ == kStored ? 0.0 : 1.0 / fps_; }

  static constexpr double kStored = 0.0;
  static constexpr double kMinFps = 0.001;
  static constexpr double kMaxFps = 1000.0;
  static constexpr size_t kMaxCount = 10'000'000;

 private:
  CameraPath path_;
  double fps_;
  size_t count_;
};

}  // namespace promin
