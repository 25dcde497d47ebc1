// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "promin/scene.h"
#include "work/pictures/messages.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// Returns the camera of the scene's file that the options name, else its first; null if the scene is framed or the
/// user's own camera is used. Throws UsageError for an unknown camera.
const Camera* find_file_camera(const Scene& scene, const ViewOptions& options);

/// Returns the side from which the scene is framed, if it is.
Framing choose_framing(const Scene& scene, const PoseOptions& pose);

/// Returns whether the camera frames the scene from a side that the user has not chosen.
bool is_camera_assumed(const Scene& scene, const ViewOptions& options);

/// Returns the camera if none of the scene's file is used: that of a path, one at the user's eye, or one that frames
/// the scene in a picture of this aspect ratio. Throws UsageError for parallel directions.
Camera make_camera(const Scene& scene, const ViewOptions& options, float aspect_ratio);

/// Returns a file's camera as changed by the options for a picture of this size, which shows at least what its author
/// saw. An orthographic camera with a field of view becomes perspective, with a note. Throws UsageError for parallel
/// directions.
Camera pose_camera(const Scene& scene, const Camera& camera, const PoseOptions& pose, const uvec2& size,
                   const Messages& console);

/// Returns a sentence if none of the cameras sees anything of the scene in pictures of this size, with options that
/// show the scene. Returns an empty text if one of them may see something.
std::string describe_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size);
/// Returns a sentence if the camera is the file's, unchanged, and shows the model small; else an empty text.
std::string describe_small_model(const Scene& scene, const ViewOptions& options, const View& view);
/// Warns with that sentence.
void warn_of_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size,
                            const Messages& console);

}  // namespace promin::work
