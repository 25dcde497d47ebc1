// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "promin/image.h"
#include "promin/math.h"

namespace promin {

/// The built-in surroundings for scenes without light (docs/model.md, "Studio"): a grey gradient, dark below the
/// horizon, with four soft lamps that show form and gloss. The studio is oriented to the viewer by `front`. A separate
/// light casts the shadows: make_studio_light (promin/lighting.h).
struct Studio {
  /// The azimuth from which the viewer looks at the scene, in radians about +Y of the sky from +Z towards
  /// +X. Finite.
  float front = 0.0F;

  /// Returns whether both environments look the same.
  bool operator==(const Studio&) const = default;
};

/// A gradient of colours, linear RGB, finite and not negative, over the elevation angle (OMI_environment_sky): from
/// `horizon` up to `top` and down to `bottom`. The weight of top or bottom is 1 - (1 - e)^(1 / curve), where e is the
/// absolute elevation divided by 90 degrees. A curve of 1 is linear; a smaller curve makes the horizon narrower.
struct GradientSky {
  /// The colour at +Y.
  vec3 top{0.3F, 0.5F, 1.0F};
  /// The colour at the horizon.
  vec3 horizon{0.8F, 0.8F, 0.9F};
  /// The colour at -Y.
  vec3 bottom{0.2F, 0.2F, 0.2F};
  /// Curve of the gradient from horizon to top, > 0 and finite.
  float top_curve = 0.15F;
  /// Curve of the gradient from horizon to bottom, > 0 and finite.
  float bottom_curve = 0.02F;

  /// Returns whether both look the same.
  bool operator==(const GradientSky&) const = default;
};

/// An equirectangular picture of all directions: equal steps in the picture are equal angles. The top row lies at +Y
/// and the middle of a row at -Z. The direction +X lies a quarter of the width to the right of the middle. The pixels
/// are linear RGB, finite and not negative.
struct Panorama {
  /// The largest width in pixels.
  static constexpr uint32_t kMaxWidth = 16384;
  /// The largest height in pixels.
  static constexpr uint32_t kMaxHeight = 8192;

  /// The picture; neither null nor empty. Several skies may share one picture, so a copy of a sky is cheap.
  std::shared_ptr<const Image> image;

  /// Returns whether both refer to the same image object; equal pixels are not enough.
  bool operator==(const Panorama&) const = default;
};

/// The background that the camera sees: a linear gradient over the height of the picture, displayed without exposure
/// and tone mapping (docs/model.md, "Backdrop").
struct Backdrop {
  /// The colour at the picture's upper edge, linear RGB, finite and not negative; the value 1 is the display's white.
  vec3 top{1.0F};
  /// The colour at the picture's lower edge, in the same units.
  vec3 bottom{1.0F};
  /// Factor from the backdrop's colours to radiance in mirrors and behind glass, finite and not negative.
  float radiance = 1.0F;

  /// Returns whether both look the same.
  bool operator==(const Backdrop&) const = default;
};

/// The surroundings of the scene: everything except objects and lights.
struct Environment {
  /// Ambient light, linear RGB, finite and not negative. Without a sky this is the radiance that materials receive from
  /// all directions; rays that leave the scene return the background.
  vec3 ambient{0.0F};
  /// Radiance that rays return if they leave the scene, linear RGB, finite and not negative. Black by default.
  vec3 background{0.0F};
  /// The sky, which replaces ambient light. Camera rays still see the background unless `shows_sky` is set.
  std::variant<std::monostate, Studio, GradientSky, Panorama> sky{};
  /// True if camera rays see the sky. It has no effect in a scene without a sky.
  bool shows_sky = false;
  /// The direction of the world that the sky's +Y has, a unit vector. The shortest rotation from +Y to `up` turns the
  /// whole sky: if +Z is up, the sky's +Z is -Y of the world.
  vec3 up{0.0F, 1.0F, 0.0F};
  /// Rotation of the sky about its +Y from +Z towards +X, in radians, finite.
  float rotation = 0.0F;
  /// Factor by which the sky's radiance is multiplied, finite and not negative.
  float intensity = 1.0F;
  /// The backdrop, which replaces the background in pictures without Aovs::alpha.
  std::optional<Backdrop> backdrop{};

  /// Returns whether the environment has a sky.
  bool has_sky() const { return !std::holds_alternative<std::monostate>(sky); }
  /// Returns whether the camera sees the backdrop.
  bool shows_backdrop() const { return backdrop && !(shows_sky && has_sky()); }
};
}  // namespace promin
