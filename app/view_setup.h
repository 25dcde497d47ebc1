// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "promin/lighting.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "render_options.h"

namespace promin::app {

/// Of pictures for which neither the user nor the scene says another.
inline constexpr float kDefaultAspectRatio = 16.0F / 9.0F;

/// The size of this camera's pictures where the user names none: what its file asks for, else a height of 720 pixels.
/// Empty where its aspect ratio gives no width that a picture may have.
std::optional<uvec2> default_size(const Camera& camera);

/// The size of this camera's pictures of which these sides are asked, where 0 follows from the camera. Empty as
/// default_size.
std::optional<uvec2> size_for(const uvec2& sides, const Camera& camera);

/// The view that the options ask of this scene (camera_choice.h). A scene without a camera gets one that frames it.
/// Throws UsageError for an unknown camera, parallel directions, a crop outside the picture.
View make_view(const Scene& scene, const ViewOptions& options, const Console& console);

/// Surrounds and lights the scene as the options ask, and gives it the background that they name. Throws as light_scene
/// does.
AssumedLight light_up(Scene& scene, const LookOptions& look, const EnvironmentChoice& surroundings = {});

/// Gives surroundings the background that is asked for.
void show_background(const BackgroundChoice& background, Environment& environment);

/// How pictures of a scene are shown, lit up or not. Debug views are shown as they are.
DisplayTransform choose_display(const Scene& scene, const LookOptions& look, DebugView debug_view);

/// Whether pictures that are shown so, before these surroundings, need Aovs::unlit.
bool shows_unlit_apart(const Scene& scene, const Environment& environment, const LookOptions& look,
                       const DisplayTransform& display);

/// What is assumed where neither the file nor the options say it, a few words each. The light is what light_up has
/// added to the scene; `display` is what the picture is shown with, if it is.
std::vector<std::string> list_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                          const std::optional<DisplayTransform>& display);
/// The same as one sentence, for promin's notes; empty if nothing is assumed.
std::string describe_assumptions(const Scene& scene, const ViewOptions& options, const AssumedLight& light,
                                 const std::optional<DisplayTransform>& display);

/// What an assumption is called, as describe_assumptions and `promin info` have it; empty where there is none.
std::string describe_framing(Framing framing);
std::string describe_light(const AssumedLight& light);

/// Throws UsageError where the scene, with its default lights, has no light of such an index.
void check_lights(const Scene& scene, const std::vector<uint32_t>& indices);

/// Switches lights off by their indices, and all others on.
void switch_lights(std::vector<Light>& lights, const std::vector<uint32_t>& off);

}  // namespace promin::app
