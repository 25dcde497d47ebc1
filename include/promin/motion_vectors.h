// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/aovs.h"
#include "promin/camera.h"
#include "promin/export.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin {

/// Computes Aovs::motion of a picture: the movement of the visible surface until the next frame, in pixels.
///
/// `scene` and `view` are the scene and the view of the picture. `next_scene` is the scene of the next frame, for
/// example another result of scene_at() (promin/motion.h); both scenes number objects and primitives equally. Further
/// objects of `scene` rest.
/// `next_camera` is the camera of the next frame, which has the size of the same view. `aovs` has the AOVs `position`,
/// `object` and `primitive` of the picture, which RenderResult::aovs has if `motion` was selected.
///
/// The point of the object at the hit is placed in both poses in double: by the corners of its triangle if the mesh
/// changes its form, otherwise by the object's transforms. Both cameras project it in double, without their lenses.
/// The movement is (0, 0) for a point that lies behind the eye in one of the frames, and the object's own movement is 0
/// if the next frame does not show the object. Where no surface is visible, the movement is that of a sky that the
/// picture shows, which follows from the rotation of a perspective camera; otherwise it is (0, 0). All numbers are
/// finite.
///
/// Throws UsageError if these AOVs do not have a value for each pixel of the view, and InputError if an object or a
/// primitive does not exist in both scenes.
PROMIN_EXPORT void add_motion(const Scene& scene, const View& view, const Scene& next_scene, const Camera& next_camera,
                              Aovs& aovs);

}  // namespace promin
