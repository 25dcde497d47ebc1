// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "promin/camera.h"
#include "promin/export.h"
#include "promin/math.h"
#include "promin/scene.h"

namespace promin {

// Cameras that frame a scene (docs/model.md, "Showing a picture"). What is framed is everything finite, but for stray
// geometry: where 99 percent of the surface lie in a box of less than 1/64 of the size of everything, it is that part.

/// From where frame_scene looks. The front is towards +Z where +Y is up, and left and right are those of a viewer in
/// front of the scene.
enum class Framing : uint32_t {
  /// From 30 degrees to the right of the front and 17 degrees above. A scene whose depth is less than a quarter of its
  /// width or height, a board, is seen from the front, at its own height. One that lies flat, with a height of less
  /// than 1/16 of width or depth and no more than its depth, is seen from 45 degrees above.
  kThreeQuarter,
  kFront,
  kBack,
  /// From -X where +Y is up and the front is +Z.
  kLeft,
  kRight,
  /// With the front at the lower edge of the picture.
  kTop,
  /// With the front at the upper edge of the picture.
  kBottom,
  /// From within, as one stands in a room: at the middle height, a third of the longer horizontal side away from its
  /// end at the front or, where the scene is wider than deep, at the right. The camera looks at the other end with a
  /// vertical field of view of 60 degrees.
  kInside,
};

/// Names for people, by the value of the Framing; the first is "three-quarter".
PROMIN_EXPORT std::span<const std::string_view> framing_names();

/// The share of the picture that a framed scene covers.
inline constexpr float kDefaultFit = 0.85F;
/// The least share to ask for.
inline constexpr float kMinFit = 0.05F;

/// How frame_scene frames a scene.
struct FrameOptions {
  /// framing_of(scene) where it is not given.
  std::optional<Framing> from = std::nullopt;
  /// kMinFit...1: see fit_camera.
  float fit = kDefaultFit;
  /// The direction that is up in the scene, of any length but 0. The shortest turn from +Y to it takes the front along,
  /// so that where +Z is up the front is -Y; where -Y is up it stays +Z.
  vec3 up{0.0F, 1.0F, 0.0F};
};

/// From where to frame a scene. A room that one stands in is seen through its open side (front, back, right or left
/// where +Y is up) or, where it has none, from within; all else from three quarters. One stands in a scene whose
/// outermost surfaces are seen from their backs from most of outside, while there is something in it that turns its
/// fronts outwards (docs/model.md). Throws InputError as bounds_of() does.
PROMIN_EXPORT Framing framing_of(const Scene& scene);

/// A perspective camera that frames the scene. `aspect_ratio` is width over height of the picture. Throws UsageError
/// where that is not a positive finite number, the fit is out of range or `up` is 0 or not finite, and InputError as
/// bounds_of() does.
PROMIN_EXPORT Camera frame_scene(const Scene& scene, float aspect_ratio, const FrameOptions& options = {});

/// Moves a camera such that the scene, as it is projected, lies in the middle of the picture and the longer of its
/// sides, each measured in the picture's side, covers the share `fit` of it. It covers less where the scene points at
/// the eye, as a needle: the eye keeps 1/256 of the distance at which the shorter side of its cross-section would cover
/// as much. Directions and a perspective camera's field of view stay; an orthographic one gets another height. Throws
/// as frame_scene does.
PROMIN_EXPORT Camera fit_camera(const Scene& scene, const Camera& camera, float aspect_ratio, float fit = kDefaultFit);

/// Turns of a camera around a point, in degrees.
struct Orbit {
  /// Takes the camera to the right around `up`.
  double azimuth_deg = 0.0;
  /// Then lifts it.
  double elevation_deg = 0.0;
  /// Then turns its picture clockwise.
  double roll_deg = 0.0;

  /// Whether both are the same.
  bool operator==(const Orbit&) const = default;
};

/// Takes a camera around the point `target` of the scene. `up`, of any length but 0, is the axis of the azimuth. Where
/// nothing turns, the camera keeps its bits.
PROMIN_EXPORT Camera orbit_camera(const Camera& camera, const dvec3& target, const Orbit& orbit,
                                  const vec3& up = vec3(0.0F, 1.0F, 0.0F));

/// The point to turn a camera around: that of its axis which is nearest to the middle of the scene; that middle where
/// it does not lie before the camera. Throws InputError as bounds_of() does.
PROMIN_EXPORT dvec3 orbit_target(const Scene& scene, const Camera& camera);

/// A camera whose pictures of this size show at least what those of its own aspect ratio show: where they are narrower,
/// it sees more above and below. Where the camera says no aspect ratio, it keeps its bits.
PROMIN_EXPORT Camera widen_camera(const Camera& camera, const uvec2& size);

/// Whether anything of a valid scene may lie in the camera's picture. False is certain; true is not where surfaces come
/// near to the picture's corners, are seen from a back that they do not show, or are transparent.
PROMIN_EXPORT bool may_see(const Scene& scene, const Camera& camera, float aspect_ratio);

}  // namespace promin
