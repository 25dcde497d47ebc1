// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"

namespace promin {

/// A camera's pose and projection at a time, in seconds.
struct TimedCamera {
  double time_s = 0.0;
  Camera camera;
};

/// A flight: at least one frame, times finite, not negative and strictly increasing.
using CameraPath = std::vector<TimedCamera>;

/// Reads a file of docs/camera_path.md. Throws InputError with all that is wrong with it.
CameraPath read_camera_path(const std::filesystem::path& file);

/// Writes such a file atomically; reading it gives the same bits of poses, projections and times. Names and aspect
/// ratios of cameras are left out. Throws RunError.
void write_camera_path(const std::filesystem::path& file, const CameraPath& path);

/// The camera at a time: a stored frame's at its time, to the bit, and the first and the last beyond the ends. Between,
/// rotations follow the shortest great arc, all else straight lines; a change of projection waits for its frame.
Camera camera_at(const CameraPath& path, double time_s);

}  // namespace promin
