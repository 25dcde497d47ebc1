// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "work/pictures/camera_path.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// One of the pictures that a command renders.
struct PlannedFrame {
  /// Index of the picture on a camera path or in a film; nullopt for a single picture.
  std::optional<uint32_t> number;
  std::optional<Camera> camera;
  /// The files of this frame only; a film that holds all frames is not among them.
  std::vector<std::filesystem::path> pictures;
  /// The time of the scene in seconds; empty if all frames have the same pose.
  std::optional<double> time_s = std::nullopt;
  /// The camera path, shared by all frames.
  std::shared_ptr<const PathPictures> path = nullptr;
};

/// Returns the frames that the options request: one frame, frames of the path or of the turntable, or frames of a film.
/// The frames of a turntable get their cameras later (turn_frames). Returns no frames
/// for a film without a range of frames, because its length is known only after the scene is read (plan_film). Throws
/// InputError for an invalid path. Throws UsageError if the path or the turntable does not have a frame, or if several
/// frames would be written to one file.
std::vector<PlannedFrame> plan_frames(const RenderSpec& options);

/// Returns all frames of a film of a scene whose animations last this long. Frame i has the time i / fps. Throws
/// UsageError if there are too many, or if several frames would be written to one file.
std::vector<PlannedFrame> plan_film(const RenderSpec& options, double duration_s);

/// Returns the number of frames per second of a film of these options. `path` has the pictures of the camera path; it
/// is null without a path. Throws UsageError if the path has no rate.
double frame_rate_of(const RenderSpec& options, const PathPictures* path);

/// Sets the cameras of a path's frames for a scene with this center (Scene::center).
void move_frames(std::vector<PlannedFrame>& frames, const dvec3& center);

/// Returns a file's name with the last run of # replaced by the number, padded to the same number of digits; unchanged
/// without a #.
std::filesystem::path number_file(const std::filesystem::path& file, uint32_t number);

}  // namespace promin::work
