// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"

// The only code that checks specifications. Messages name members like the programs' options. picture_run.h checks
// conditions that depend on the scene's content.
namespace promin::work {

/// Throws UsageError for the first contradiction of two members, in a fixed order. Ranges of single members are checked
/// where they are read.
void check_render_spec(const RenderSpec& spec);
/// Checks a specification of rays in the same way. It also throws UsageError for a missing member, and for outputs that
/// are not .npy files.
void check_cast_spec(const CastSpec& spec);

// Parts of these checks, for commands that have only some of the options.

/// Checks the choice of a pose. `has_frames` is true if frames have different times. Throws UsageError.
void check_motion_options(const MotionOptions& motion, bool has_frames = false);

void check_tracing_options(const TracingOptions& options, bool has_frames = false);
/// Throws UsageError if two options contradict each other, or if an option contradicts the choice of a camera by name.
void check_pose_options(const PoseOptions& pose, bool names_camera);
/// Throws UsageError if only one of the two numbers of a lens is given.
void check_lens(const ViewOptions& view);
/// Throws UsageError if a camera is given in addition to the option `name`, which has its own cameras.
void check_no_camera(const ViewOptions& options, std::string_view name);
/// Throws UsageError if the smallest number of samples exceeds the largest.
void check_error_target(const ErrorTarget& target);
/// Throws UsageError for a picture with an extension that write_image() does not support.
void check_pictures(const std::vector<std::filesystem::path>& pictures);
/// Throws UsageError for a file that is neither such a picture nor a film (film_file.h).
void check_frame_files(const std::vector<std::filesystem::path>& files);
/// Throws UsageError for a file with an extension other than .npy.
void check_arrays(const std::vector<std::filesystem::path>& files);

}  // namespace promin::work
