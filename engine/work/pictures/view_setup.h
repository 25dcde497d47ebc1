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

/// Returns the default size of this camera's pictures: the size that its file requests, else a height of 720 pixels.
/// Empty if its aspect ratio gives no valid width.
std::optional<uvec2> default_size(const Camera& camera);

/// Returns the size of this camera's pictures for these requested sides; a side of 0 follows from the camera. Empty as
/// for default_size.
std::optional<uvec2> size_for(const uvec2& sides, const Camera& camera);

/// Returns the view of this scene for the options (camera_choice.h). A scene without a camera gets one that frames it.
/// Throws UsageError for an unknown camera, parallel directions, and a crop outside the picture.
View make_view(const Scene& scene, const ViewOptions& options, const Messages& console);

/// Sets the scene's environment, lights and background from the options. Throws as light_scene does.
AssumedLight light_up(Scene& scene, const LookOptions& look, const EnvironmentChoice& surroundings = {});

/// Sets the requested background of an environment.
void show_background(const BackgroundChoice& background, Environment& environment);

/// Returns the display transform for pictures of a scene, whether it is lit already or not. Debug views are displayed
/// unchanged.
DisplayTransform choose_display(const Scene& scene, const LookOptions& look, DebugView debug_view);

/// Returns whether pictures with this display and environment need Aovs::unlit.
bool shows_unlit_apart(const Scene& scene, const Environment& environment, const LookOptions& look,
                       const DisplayTransform& display);

/// Returns the assumptions that neither the file nor the options specify, a few words each. The light is that which
/// light_up has added to the scene; `display` is the picture's display transform, if it is displayed.
std::vector<std::string> list_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                          const std::optional<DisplayTransform>& display);
/// Returns the same as one sentence, for promin's notes; empty if nothing is assumed.
std::string describe_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                 const std::optional<DisplayTransform>& display);

/// Returns the text of an assumption for describe_assumptions and `promin info`; empty if there is none.
std::string describe_framing(Framing framing);
std::string describe_light(const AssumedLight& light);

/// Throws UsageError if the scene, including its default lights, has no light of such an index.
void check_lights(const Scene& scene, const std::vector<uint32_t>& indices);

/// Switches lights off by their indices, and all others on.
void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off);

}  // namespace promin::work
