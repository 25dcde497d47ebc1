// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "camera_path.h"
#include "render_options.h"

namespace promin::app {

/// One of the pictures that a command renders.
struct PlannedFrame {
  /// The camera of a camera path; nullopt where the scene's cameras or the user's pose are meant.
  std::optional<uint32_t> number;
  std::optional<Camera> camera;
  std::vector<std::filesystem::path> pictures;
  /// The camera path that they are of, shared by all.
  std::shared_ptr<const PathPictures> path = nullptr;
};

/// The frames that the options ask for: one, or those of the path. Throws InputError for a bad path, UsageError for
/// frames that it does not have, and where several frames would go to one file.
std::vector<PlannedFrame> plan_frames(const RenderOptions& options);

/// Gives frames of a camera path their cameras in a scene of this center (Scene::center).
void move_frames(std::vector<PlannedFrame>& frames, const dvec3& center);

/// A file's name with the last run of # replaced by the number, in as many digits or more; unchanged without a #.
std::filesystem::path number_file(const std::filesystem::path& file, uint32_t number);

}  // namespace promin::app
