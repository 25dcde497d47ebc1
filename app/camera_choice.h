// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "console.h"
#include "promin/scene.h"
#include "render_options.h"

namespace promin::app {

/// The camera of the scene's file that the options name, or else its first; null where the scene is framed or the
/// user's own camera is taken. Throws UsageError for an unknown camera.
const Camera* find_file_camera(const Scene& scene, const ViewOptions& options);

/// From where the scene is framed, if it is.
Framing choose_framing(const Scene& scene, const PoseOptions& pose);

/// Whether the camera is one that frames the scene, and nobody has said from where.
bool is_camera_assumed(const Scene& scene, const ViewOptions& options);

/// The camera of a scene of whose file none is taken: that of a path, one at the user's eye, or one that frames the
/// scene in a picture of this aspect ratio. Throws UsageError for parallel directions.
Camera make_camera(const Scene& scene, const ViewOptions& options, float aspect_ratio);

/// The camera of a file as the options change it in a picture of this size: what it showed its author stays in the
/// picture. An orthographic camera with a field of view becomes a perspective one; a note says so. Throws UsageError
/// for parallel directions, and where the options frame the scene.
Camera pose_camera(const Scene& scene, const Camera& camera, const PoseOptions& pose, const uvec2& size,
                   const Console& console);

/// Says that none of the cameras sees anything of the scene in pictures of this size, and what shows it. Returns an
/// empty text where one of them may see something.
std::string describe_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size);
/// Warns with that sentence.
void warn_of_empty_pictures(const Scene& scene, std::span<const Camera> cameras, const uvec2& size,
                            const Console& console);

}  // namespace promin::app
