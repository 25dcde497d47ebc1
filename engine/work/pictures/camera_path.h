// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// A camera's pose and projection at a time in seconds.
struct TimedCamera {
  double time_s = 0.0;
  Camera camera;
  /// Difference between the camera's position in the world and its fp32 eye.
  dvec3 rest{0.0};

  dvec3 eye() const { return rest + dvec3(camera.eye); }
};

/// A flight of the camera over time.
struct CameraPath {
  /// The stored frames; at least one. Times are finite, not negative and strictly increasing.
  std::vector<TimedCamera> frames;
  /// The number of pictures per second at which the flight is to be played. With nullopt each frame is a picture.
  std::optional<double> fps;
};

/// Reads a file in the format of docs/camera_path.md. Throws InputError with all problems.
CameraPath read_camera_path(const std::filesystem::path& file);

/// Writes such a file atomically. Reading the file gives poses, projections and times with the same bits. Names and
/// aspect ratios of cameras are not stored. Throws RunError.
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

/// Returns the camera at a time. At the time of a stored frame it has the frame's bits; before the first and after the
/// last frame it has the bits of that frame. Between frames, rotations follow the shortest great arc, and everything
/// else is interpolated linearly. The projection changes at the frame that has it.
Camera camera_at(const CameraPath& path, double time_s);

/// The pictures of a path, for rendering and for playing in a window. Both get cameras with the same bits.
class PathPictures {
 public:
  /// Makes `fps` pictures per second until the last frame's time; picture i has the time i / fps. With kStored it makes
  /// a picture for each stored frame. With nullopt the path decides. Throws UsageError if there are more pictures than
  /// kMaxCount.
  explicit PathPictures(CameraPath path, std::optional<double> fps = std::nullopt);

  /// Returns the same pictures for a scene with this center (Scene::center).
  PathPictures moved_to(const dvec3& center) const;
  /// Returns the number of pictures, at least one.
  size_t count() const { return count_; }
  Camera camera(size_t picture) const;
  /// Returns the time of a picture in seconds.
  double time_s(size_t picture) const;
  /// Returns the seconds from a picture to the next one. After the last stored frame, it is the time between the last
  /// two.
  double seconds_after(size_t picture) const;
  /// Returns the camera some seconds after a picture.
  Camera camera_after(size_t picture, double seconds) const;
  /// Returns the seconds from picture to picture; 0 if the pictures are the stored frames.
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
