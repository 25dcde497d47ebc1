// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/display.h"
#include "promin/export.h"
#include "promin/scene.h"

namespace promin {

// What stands in where a file says nothing of light, and how its pictures are shown (docs/model.md, "Showing a
// picture"). Classic scenes (Scene::is_classic) keep what Whitted's and Phong's time had.

/// What stands in for light that a scene lacks.
enum class LightChoice : uint32_t {
  /// kHeadlight for classic scenes, kStudio for all others.
  kAuto,
  /// Studio in place of a sky, and its directional light in place of lights. A scene with lights of its own gets the
  /// studio weaker, such that after the exposure it has 0.3 of its radiance.
  kStudio,
  /// A headlight and ambient light in place of lights, as add_default_lights gives them.
  kHeadlight,
  /// Nothing.
  kNone,
};

/// Names for people, by the value of the LightChoice; the first is "auto".
PROMIN_EXPORT std::span<const std::string_view> light_choice_names();

/// What light_scene has added to a scene.
struct AssumedLight {
  /// Whether the studio surrounds the scene.
  bool has_studio = false;
  /// Whether the studio's directional light was added.
  bool has_studio_light = false;
  /// Whether a headlight was added.
  bool has_headlight = false;
  /// Whether ambient light was added.
  bool has_ambient = false;
  /// Whether the background was black and is a grey backdrop now.
  bool has_background = false;
};

/// Adds what the choice says where the scene has no sky (a sky of Environment or ambient light) or no lights. The
/// background of a scene without a sky, unless it is classic or has a background, becomes the studio's backdrop; behind
/// glass, in mirrors and with Aovs::alpha it is as bright after the exposure. In the studio Phong materials without
/// ambient factors take their diffuse ones. Throws InputError as bounds_of() does.
PROMIN_EXPORT AssumedLight light_scene(Scene& scene, LightChoice choice = LightChoice::kAuto);

/// The backdrop of scenes without a background: a grey gradient, linear.
inline constexpr float kStudioBackdropTop = 0.85F;
inline constexpr float kStudioBackdropBottom = 0.55F;
/// The illuminance of the studio's directional light on a surface that faces it, lux.
inline constexpr float kStudioLightPower = 1.35F;
/// The studio's intensity in a scene with lights, before the exposure is taken out of it.
inline constexpr float kStudioFill = 0.3F;

/// The azimuth from which a scene is looked at, as Studio::front has it: that of its first camera, or 0.
PROMIN_EXPORT float front_of(const Scene& scene);

/// The directional light of a studio with its front at that azimuth (radians, as Studio::front): it comes from 35
/// degrees left of the viewer and 40 degrees above, with this power in both terms.
PROMIN_EXPORT Light make_studio_light(float front, float power = kStudioLightPower);

/// The exposure that suits a scene's lights, in stops (DisplayTransform::exposure_ev), a multiple of 1/2. It is 0 where
/// the illuminance E in the middle of the scene is 0 or within pi / 4 ... 4 pi lux, else it brings E to about pi. E is
/// the sum over all lights, those that are off too, of the luminance of their diffuse power, which those that fall off
/// have over the square of their distance, at least half the scene's radius. Where materials are Phong's and none
/// metallic-roughness, power counts pi times, because Phong's take 1 as the others take pi. Throws InputError as
/// bounds_of() does.
PROMIN_EXPORT float exposure_of(const Scene& scene);

/// How pictures of a scene are shown: with exposure_of() and Khronos PBR Neutral. Classic scenes are shown as they are,
/// and so are those all of whose objects are unlit, and any of Phong's materials where the headlight is chosen. Throws
/// as exposure_of() does.
PROMIN_EXPORT DisplayTransform display_of(const Scene& scene, LightChoice choice = LightChoice::kAuto);

/// Whether a scene has unlit materials or a backdrop beside others. Exposure and tone mapping leave their colours alone
/// in pictures with Aovs::unlit (promin/aovs.h).
PROMIN_EXPORT bool mixes_unlit(const Scene& scene);
/// The same of the scene in other surroundings.
PROMIN_EXPORT bool mixes_unlit(const Scene& scene, const Environment& environment);

}  // namespace promin
