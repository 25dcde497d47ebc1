// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "promin/lighting.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "work/pictures/messages.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// The aspect ratio of pictures if neither the user nor the scene specifies one.
inline constexpr float kDefaultAspectRatio = 16.0F / 9.0F;

/// Returns the default size of this camera's pictures: the size that its file requests, or otherwise a height of 720
/// pixels. Empty if the camera's aspect ratio gives no valid width.
std::optional<uvec2> default_size(const Camera& camera);

/// Returns the size of this camera's pictures for these requested sides. A side of 0 is computed from the camera. Empty
/// in the same cases as default_size().
std::optional<uvec2> size_for(const uvec2& sides, const Camera& camera);

/// Returns the view of this scene for the options (camera_choice.h). If the scene has no camera, the view has a camera
/// that frames the scene. Throws UsageError for an unknown camera, for parallel directions, and for a crop outside the
/// picture.
View make_view(const Scene& scene, const ViewOptions& options, const Messages& console);

/// Returns the mode of the options' pictures of this scene.
RenderMode mode_of(const Scene& scene, const ViewOptions& options);

/// Gives a camera the lens of the options.
void put_lens(const ViewOptions& options, Camera& camera);

/// Returns the upward direction of the scene, a unit vector, if the options give it (PoseOptions::up) for a camera that
/// frames the scene. Otherwise it is empty, because `up` then belongs to the picture. Throws UsageError if the
/// direction is zero or not finite.
std::optional<vec3> upward_direction(const Scene& scene, const ViewOptions& options);

/// Sets the scene's environment, lights and background from the options. EnvironmentChoice::replace_sky() and
/// settle_light() have chosen the sky and `look` before. If `up` is given, the light and the ground
/// stand on it. Throws the same errors as light_scene().
AssumedLight light_up(Scene& scene, const LookOptions& look, const EnvironmentChoice& surroundings = {},
                      const std::optional<vec3>& up = {});

/// Sets the background of an environment to the requested one.
void show_background(const BackgroundChoice& background, Environment& environment);

/// Returns the display transform for pictures of a scene, before or after its lights were added. Debug views are
/// displayed unchanged.
DisplayTransform choose_display(const Scene& scene, const LookOptions& look, DebugView debug_view);

/// Returns whether pictures with this display and environment need Aovs::unlit.
bool shows_unlit_apart(const Scene& scene, const Environment& environment, const LookOptions& look,
                       const DisplayTransform& display);

/// Returns the assumptions that neither the file nor the options specify, with a few words each. `light` is what
/// light_up() has added to the scene. `integrator` is that of the pictures. `display` is the display transform if the
/// picture is displayed.
std::vector<std::string> list_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                          Integrator integrator, const std::optional<DisplayTransform>& display);
/// Returns the assumptions as one sentence for promin's notes; empty if there are none.
std::string describe_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                 Integrator integrator, const std::optional<DisplayTransform>& display);

/// Returns a text for the camera that frames a scene without a camera, for describe_assumptions() and `promin info`.
std::string describe_framing(const Scene& scene, const PoseOptions& pose);
std::string describe_light(const AssumedLight& light);

/// Throws UsageError if the scene, including its default lights, has no light with one of these indices.
void check_lights(const Scene& scene, const std::vector<uint32_t>& indices);

/// Switches the lights with these indices off. Other lights stay as they are: a pose may hide them.
void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off);

}  // namespace promin::work
