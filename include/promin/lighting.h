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

// Default light for files without light, and the default display of their pictures (docs/model.md, "Showing a
// picture"). Classic scenes (Scene::is_classic) keep the conventions of Whitted's and Phong's time.

/// The light that light_scene() adds to a scene without lights or without a sky.
enum class LightChoice : uint32_t {
  /// Acts like kHeadlight for classic scenes and like kStudio for all others.
  kAuto,
  /// Adds the studio if there is no sky, and its directional light if there are no lights. In a scene with lights the
  /// studio is weaker: after the exposure its radiance is multiplied by 0.3.
  kStudio,
  /// Adds a headlight and ambient light if there are no lights, as add_default_lights does.
  kHeadlight,
  /// Adds nothing.
  kNone,
  /// Acts like kStudio, with a directional light that is kSoftSunAngle wide. The programs also use
  /// Integrator::kDirect, and add a ground that shows the shadow of the scene.
  kSoft,
  /// Adds the weaker studio of scenes with lights, and no light. The programs choose it for kAuto if the surfaces of a
  /// file light it strongly, and if the integrator lets them.
  kFill,
};

/// Returns the names to display, indexed by LightChoice. The first name is "auto".
PROMIN_EXPORT std::span<const std::string_view> light_choice_names();

/// The lights and surroundings that light_scene() has added to a scene.
struct AssumedLight {
  /// True if the studio surrounds the scene.
  bool has_studio = false;
  /// True if the studio's directional light was added.
  bool has_studio_light = false;
  /// True if a headlight was added.
  bool has_headlight = false;
  /// True if ambient light was added.
  bool has_ambient = false;
  /// True if a grey backdrop has replaced a black background.
  bool has_background = false;
};

/// Adds the chosen light to a scene that has no sky (neither a sky of Environment nor ambient light) or no lights. A
/// scene without a sky also gets the studio's backdrop, unless it is classic or has a background. After the exposure,
/// the backdrop is as bright behind glass, in mirrors and with Aovs::alpha as elsewhere. In the studio, Phong materials
/// without ambient factors use their diffuse factors. The studio and its light stand on Environment::up. The
/// backdrop and the weaker studio are divided by 2^E, with the exposure E for `surface_lux` (exposure_of()). Throws
/// InputError as bounds_of() does.
PROMIN_EXPORT AssumedLight light_scene(Scene& scene, LightChoice choice = LightChoice::kAuto, double surface_lux = 0.0);

/// Grey at the top of the studio's backdrop, in linear light. The backdrop is a gradient for scenes without a
/// background.
inline constexpr float kStudioBackdropTop = 0.85F;
inline constexpr float kStudioBackdropBottom = 0.55F;
/// The illuminance that the studio's directional light causes on a surface that faces it, in lux.
inline constexpr float kStudioLightPower = 1.35F;
/// The angle of the directional light of LightChoice::kSoft in radians: 10 degrees.
inline constexpr float kSoftSunAngle = 0.174532925F;
/// The studio's intensity in a scene with lights, before it is divided by the exposure.
inline constexpr float kStudioFill = 0.3F;

/// Returns the azimuth from which the first camera views a scene, about Environment::up, for Studio::front; 0 without a
/// camera.
PROMIN_EXPORT float front_of(const Scene& scene);

/// Returns the directional light of a studio with this front (radians, as Studio::front). +Y is up. The light
/// comes from 35 degrees to the left of the viewer and 40 degrees above. `power` is its diffuse and its specular power.
PROMIN_EXPORT Light make_studio_light(float front, float power = kStudioLightPower);

/// Returns the exposure that suits a scene's lights, in stops (DisplayTransform::exposure_ev), a multiple of 1/2. The
/// exposure is 0 if the illuminance E in the middle of the scene is 0 or within pi / 4 ... 4 pi lux. Otherwise the
/// exposure changes E to about pi. E is the sum of the luminance of the diffuse power of all lights, including lights
/// that are off. For lights with attenuation, the power is divided by the square of the distance, which is at least
/// half the scene's radius. If there are Phong materials and no metallic-roughness materials, the power is multiplied
/// by pi, because a power of 1 in the Phong model corresponds to a power of pi in the other model. `surface_lux` is
/// the illuminance from emissive surfaces, which adds to E. Throws InputError as bounds_of() does.
PROMIN_EXPORT float exposure_of(const Scene& scene, double surface_lux = 0.0);

/// Returns the display transform for a scene: exposure_of() and Khronos PBR Neutral. The transform changes nothing for
/// classic scenes, for scenes with only unlit objects, and for scenes of Phong materials if the headlight is chosen.
/// Throws as exposure_of() does.
PROMIN_EXPORT DisplayTransform display_of(const Scene& scene, LightChoice choice = LightChoice::kAuto,
                                          double surface_lux = 0.0);

/// Returns whether a scene has unlit materials or a backdrop in addition to lit materials. In pictures with Aovs::unlit
/// (promin/aovs.h), exposure and tone mapping do not change the colours of the unlit materials and the backdrop.
PROMIN_EXPORT bool mixes_unlit(const Scene& scene);
/// Returns the same for the scene with `environment` in place of its own environment.
PROMIN_EXPORT bool mixes_unlit(const Scene& scene, const Environment& environment);

}  // namespace promin
