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
  /// The azimuth from which the viewer looks at the scene, in radians about +Y from +Z towards +X. Finite.
  float front = 0.0F;

  /// Returns whether both look the same.
  bool operator==(const Studio&) const = default;
};

/// A gradient of colours, linear RGB, finite and not negative, over the elevation (OMI_environment_sky): from `horizon`
/// up to `top` and down to `bottom`. The weight of top or bottom is 1 - (1 - e)^(1 / curve), where e is the elevation
/// as a part of the right angle. A curve of 1 is linear; a smaller one makes the horizon narrower.
struct GradientSky {
  /// The colour at +Y.
  vec3 top{0.3F, 0.5F, 1.0F};
  /// The colour at the horizon.
  vec3 horizon{0.8F, 0.8F, 0.9F};
  /// The colour at -Y.
  vec3 bottom{0.2F, 0.2F, 0.2F};
  /// The curve from horizon to top, > 0 and finite.
  float top_curve = 0.15F;
  /// The curve from horizon to bottom, > 0 and finite.
  float bottom_curve = 0.02F;

  /// Returns whether both look the same.
  bool operator==(const GradientSky&) const = default;
};

/// An equirectangular picture of all directions: equal steps are equal angles. The top row lies at +Y, the middle of a
/// row at -Z, and a quarter of the width to its right lies +X. Linear RGB, finite and not negative.
struct Panorama {
  /// The largest width in pixels.
  static constexpr uint32_t kMaxWidth = 16384;
  /// The largest height in pixels.
  static constexpr uint32_t kMaxHeight = 8192;

  /// Neither null nor empty. Shared, because skies are copied.
  std::shared_ptr<const Image> image;

  /// Returns whether both refer to the same image object; equal pixels are not enough.
  bool operator==(const Panorama&) const = default;
};

/// The background that the camera sees: a linear gradient over the height of the picture, displayed without exposure
/// and tone mapping (docs/model.md, "Backdrop").
struct Backdrop {
  /// The colour at the picture's upper edge, linear RGB, finite and not negative; 1 is the display's white.
  vec3 top{1.0F};
  /// The same at the lower edge.
  vec3 bottom{1.0F};
  /// Factor that turns its colours into radiance in mirrors and behind glass, finite and not negative.
  float radiance = 1.0F;

  /// Returns whether both look the same.
  bool operator==(const Backdrop&) const = default;
};

/// The surroundings of the scene: everything except objects and lights.
struct Environment {
  /// Ambient light, linear RGB, finite and not negative. Without a sky it is the radiance that materials receive from
  /// all directions; rays that leave the scene return the background.
  vec3 ambient{0.0F};
  /// Radiance of rays that leave the scene, linear RGB, finite and not negative. Black by default.
  vec3 background{0.0F};
  /// The sky, which replaces ambient light. Camera rays still see the background unless `shows_sky` is set.
  std::variant<std::monostate, Studio, GradientSky, Panorama> sky{};
  /// Whether camera rays see the sky, if there is one.
  bool shows_sky = false;
  /// Rotation of the sky about +Y from +Z towards +X, in radians, finite.
  float rotation = 0.0F;
  /// Factor of the sky's radiance, finite and not negative.
  float intensity = 1.0F;
  /// Replaces the background in pictures without Aovs::alpha.
  std::optional<Backdrop> backdrop{};

  /// Returns whether there is a sky.
  bool has_sky() const { return !std::holds_alternative<std::monostate>(sky); }
  /// Returns whether the camera sees the backdrop.
  bool shows_backdrop() const { return backdrop && !(shows_sky && has_sky()); }
};
}  // namespace promin
