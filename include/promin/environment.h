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
/// horizon, with four soft lamps in it, made to show form and gloss. The studio stands by the viewer, in the
/// direction `front`. A separate light casts its shadows: make_studio_light (promin/lighting.h).
struct Studio {
  /// The azimuth from which the scene is looked at, radians about +Y from +Z towards +X: where its front is. Finite.
  float front = 0.0F;

  /// Whether both look the same.
  bool operator==(const Studio&) const = default;
};

/// A gradient of colours, linear RGB, finite and not negative, over the elevation (OMI_environment_sky): from `horizon`
/// up to `top` and down to `bottom`. The way there is 1 - (1 - e)^(1 / curve), where e is the part of the right angle
/// between horizon and top or bottom: a curve of 1 is linear, with a smaller one the horizon is narrower.
struct GradientSky {
  /// The colour at +Y.
  vec3 top{0.3F, 0.5F, 1.0F};
  /// The colour of all that is level.
  vec3 horizon{0.8F, 0.8F, 0.9F};
  /// The colour at -Y.
  vec3 bottom{0.2F, 0.2F, 0.2F};
  /// The curve from horizon to top, > 0 and finite.
  float top_curve = 0.15F;
  /// The curve from horizon to bottom, > 0 and finite.
  float bottom_curve = 0.02F;

  /// Whether both look the same.
  bool operator==(const GradientSky&) const = default;
};

/// A picture of all directions: the top row is at +Y, the middle of a row at -Z, a quarter to the right of it is +X,
/// and equal steps in it are equal angles (equirectangular). Linear RGB, finite and not negative.
struct Panorama {
  /// The most pixels of a row.
  static constexpr uint32_t kMaxWidth = 16384;
  /// The most rows.
  static constexpr uint32_t kMaxHeight = 8192;

  /// Shared, because skies are copied; not null, and not empty.
  std::shared_ptr<const Image> image;

  /// Whether both show the same picture; one of the same pixels is another.
  bool operator==(const Panorama&) const = default;
};

/// What the camera sees behind all: an even gradient over the height of the picture, which is shown as it is, without
/// exposure and tone mapping (docs/model.md, "Backdrop").
struct Backdrop {
  /// The colour at the picture's upper edge, linear RGB, finite and not negative; 1 is the display's white.
  vec3 top{1.0F};
  /// The colour at its lower edge, likewise.
  vec3 bottom{1.0F};
  /// The factor by which mirrors and glass see it as light, finite and not negative.
  float radiance = 1.0F;

  /// Whether both look the same.
  bool operator==(const Backdrop&) const = default;
};

/// What there is beside objects and lights.
struct Environment {
  /// Linear RGB, finite and not negative. Where there is no sky it is the radiance of all directions, as materials see
  /// it; rays that leave the scene see the background.
  vec3 ambient{0.0F};
  /// Linear RGB, finite and not negative: what a ray brings that leaves the scene. Black by default.
  vec3 background{0.0F};
  /// What surrounds the scene instead of ambient light; rays from the camera see the background all the same, unless
  /// `shows_sky`.
  std::variant<std::monostate, Studio, GradientSky, Panorama> sky{};
  /// Whether rays from the camera see the sky after all, where there is one.
  bool shows_sky = false;
  /// How far the sky is turned about +Y, radians, from +Z towards +X; finite.
  float rotation = 0.0F;
  /// A factor of the sky's radiance, finite and not negative.
  float intensity = 1.0F;
  /// Takes the background's place in pictures without Aovs::alpha.
  std::optional<Backdrop> backdrop{};

  /// Whether a sky surrounds the scene.
  bool has_sky() const { return !std::holds_alternative<std::monostate>(sky); }
  /// Whether the backdrop is what the camera sees.
  bool shows_backdrop() const { return backdrop && !(shows_sky && has_sky()); }
};
}  // namespace promin
