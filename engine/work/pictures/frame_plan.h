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
  /// Index of the picture on a camera path; nullopt for the scene's cameras or the user's pose.
  std::optional<uint32_t> number;
  std::optional<Camera> camera;
  std::vector<std::filesystem::path> pictures;
  /// The camera path, shared by all frames.
  std::shared_ptr<const PathPictures> path = nullptr;
};

/// Returns the frames that the options request: one frame, or frames of the path. Throws InputError for an invalid
/// path. Throws UsageError if the path does not have a frame, or if several frames would be written to one file.
std::vector<PlannedFrame> plan_frames(const RenderSpec& options);

/// Sets the cameras of a path's frames for a scene with this center (Scene::center).
void move_frames(std::vector<PlannedFrame>& frames, const dvec3& center);

/// Returns a file's name with the last run of # replaced by the number, padded to the same number of digits; unchanged
/// without a #.
std::filesystem::path number_file(const std::filesystem::path& file, uint32_t number);

}  // namespace promin::work
