// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "promin/scene.h"
#include "work/pictures/messages.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// Returns the camera of the scene's file that the options name, or otherwise its first camera. Returns null if the
/// scene is framed or the user's own camera is used. Throws UsageError for an unknown camera.
const Camera* find_file_camera(const Scene& scene, const ViewOptions& options);

/// Returns the side from which a camera frames the scene, if it frames the scene.
Framing choose_framing(const Scene& scene, const PoseOptions& pose);

/// Returns whether the camera frames the scene from a side that the user did not choose.
bool is_camera_assumed(const Scene& scene, const ViewOptions& options);

/// Returns the camera if no camera of the scene's file is used: the camera of a path, a camera at the user's eye, or a
/// camera that frames the scene in a picture of this aspect ratio. Throws UsageError for parallel directions.
Camera make_camera(const Scene& scene, const ViewOptions& options, float aspect_ratio);

/// Returns a file's camera, changed by the options, for a picture of this size. The picture shows at least what the
/// camera's author saw. An orthographic camera with a field of view becomes perspective, with a note. Throws UsageError
/// for parallel directions.
Camera pose_camera(const Scene& scene, const Camera& camera, const PoseOptions& pose, const uvec2& size,
                   const Messages& console);

/// Returns the camera of a view after some of the steps that make a whole turn around the scene, to the right. Its
/// distance from the axis does not change. The axis goes through the point at which it looks, or through the middle of
/// the scene that it frames.
Camera turn_around(const Scene& scene, const ViewOptions& options, const Camera& camera, double steps,
                   uint32_t step_count);

/// Returns a sentence if no camera sees anything of the scene in pictures of this size; `options` suggest options that
/// would show the scene. Returns an empty text if a camera may see something.
std::string describe_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size);
/// Returns whether the view is the first camera of the file, without a change by the user.
bool is_file_camera_unchanged(const Scene& scene, const ViewOptions& options);
/// Returns a sentence if the camera is the file's unchanged camera and shows the model small, or if the model is a
/// little too large for the picture; otherwise an empty text.
std::string describe_file_camera(const Scene& scene, const ViewOptions& options, const View& view);
/// Warns with the sentence of describe_empty_pictures(), if there is one.
void warn_of_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size,
                            const Messages& console);

}  // namespace promin::work
