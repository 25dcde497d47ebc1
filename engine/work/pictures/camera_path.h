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
  /// Difference of the camera's position in the world and its fp32 eye.
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

/// Reads a file in the format of docs/camera_path.md. Throws InputError with all its problems.
CameraPath read_camera_path(const std::filesystem::path& file);

/// Writes such a file atomically. Reading it gives poses, projections and times with the same bits. Names and aspect
/// ratios of cameras are not stored. Throws RunError.
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

/// Returns the camera at a time. At a stored frame's time it has that frame's bits, and beyond the ends those of the
/// first or last frame. In between, rotations follow the shortest great arc and everything else straight lines; the
/// projection changes at its frame.
Camera camera_at(const CameraPath& path, double time_s);

/// The pictures of a path, for rendering and for playing in a window; both get the same cameras, bit for bit.
class PathPictures {
 public:
  /// Makes `fps` pictures per second, picture i at the time i / fps, until the last frame's time; with kStored one for
  /// each stored frame; with nullopt as the path says. Throws UsageError for more pictures than kMaxCount.
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
