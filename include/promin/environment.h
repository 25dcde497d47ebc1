// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <variant>

#include "promin/image.h"
#include "promin/math.h"

namespace promin {

/// The built-in surroundings for scenes without light (docs/model.md, "Studio"): a grey gradient with three soft lamps
/// of its own, made to show form and gloss. It stands by the viewer whom `front` says.
struct Studio {
  /// The azimuth from which the scene is looked at, radians about +Y from +Z towards +X: where its front is.
  float front = 0.0F;
};

/// A gradient of colours, linear RGB, by elevation (OMI_environment_sky): from `horizon` up to `top` and down to
/// `bottom`. A curve is the exponent of the way there, > 0: 1 - (1 - |sin elevation|)^(1 / curve) of it.
struct GradientSky {
  vec3 top{0.3F, 0.5F, 1.0F};
  vec3 horizon{0.8F, 0.8F, 0.9F};
  vec3 bottom{0.2F, 0.2F, 0.2F};
  float top_curve = 0.15F;
  float bottom_curve = 0.02F;
};

/// A picture of all directions, linear RGB, row 0 at +Y, the middle of a row at -Z and a quarter to the right of it +X.
struct Panorama {
  /// Shared, because skies are copied; not null.
  std::shared_ptr<const Image> image;
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
  std::variant<std::monostate, Studio, GradientSky, Panorama> sky;
  /// Whether rays from the camera see the sky after all, where there is one.
  bool shows_sky = false;
  /// How far the sky is turned about +Y, radians.
  float rotation = 0.0F;
  /// A factor of the sky's radiance, finite and not negative.
  float intensity = 1.0F;
};

}  // namespace promin
