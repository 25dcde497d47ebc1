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

// Cameras that frame a scene (docs/model.md, "Showing a picture"). They frame everything finite except stray geometry:
// if 99 percent of the surface lie in a box of less than 1/64 of the size of the whole, only that part is framed.

/// The side from which frame_scene looks. If +Y is up, the front is the +Z side. Left and right are those of a viewer
/// in front of the scene.
enum class Framing : uint32_t {
  /// From 30 degrees to the right of the front and 17 degrees above. A board, whose depth is less than a quarter of its
  /// width or height, is seen from the front at its own height. A flat scene, whose height is less than 1/16 of its
  /// width or depth and at most its depth, is seen from 45 degrees above.
  kThreeQuarter,
  kFront,
  kBack,
  /// From -X if +Y is up and the front is +Z.
  kLeft,
  kRight,
  /// With the front at the lower edge of the picture.
  kTop,
  /// With the front at the upper edge of the picture.
  kBottom,
  /// From inside, as if standing in a room. The eye is at the middle height, a third of the longer horizontal side away
  /// from its front end or, in a scene that is wider than deep, its right end. The camera looks at the other end with a
  /// vertical field of view of 60 degrees.
  kInside,
};

/// Returns display names, indexed by Framing; the first is "three-quarter".
PROMIN_EXPORT std::span<const std::string_view> framing_names();

/// The default for the part of the picture that a framed scene covers.
inline constexpr float kDefaultFit = 0.85F;
/// The smallest part that may be requested.
inline constexpr float kMinFit = 0.05F;

/// Options of frame_scene.
struct FrameOptions {
  /// The side to look from; framing_of(scene) if empty.
  std::optional<Framing> from = std::nullopt;
  /// The part of the picture to cover, kMinFit...1; see fit_camera.
  float fit = kDefaultFit;
  /// The up direction of the scene, of any length except 0. The shortest rotation from +Y to it also turns the front:
  /// if +Z is up, the front is -Y; if -Y is up, it stays +Z.
  vec3 up{0.0F, 1.0F, 0.0F};
};

/// Returns the side from which to frame a scene. A room is seen through its open side (front, back, right or left if +Y
/// is up), or from inside if it has none. Everything else is seen from three quarters. A scene is a room if its
/// outermost surfaces show their backs to most of the outside while something inside it turns its front outwards
/// (docs/model.md). Throws InputError as bounds_of() does.
PROMIN_EXPORT Framing framing_of(const Scene& scene);

/// Returns a perspective camera that frames the scene. `aspect_ratio` is width over height of the picture. Throws
/// UsageError if it is not a positive finite number, if the fit is out of range, or if `up` is 0 or not finite; throws
/// InputError as bounds_of() does.
PROMIN_EXPORT Camera frame_scene(const Scene& scene, float aspect_ratio, const FrameOptions& options = {});

/// Returns the camera moved so that the projected scene lies in the middle of the picture, and so that the larger of
/// its width and height, each relative to the picture's, is `fit`. A scene that points at the eye like a needle covers
/// less: the eye keeps at least 1/256 of the distance at which the shorter side of its cross-section would cover that
/// part. The directions and a perspective camera's field of view stay; an orthographic camera gets another height.
/// Throws as frame_scene does.
PROMIN_EXPORT Camera fit_camera(const Scene& scene, const Camera& camera, float aspect_ratio, float fit = kDefaultFit);

/// Rotations of a camera around a point, in degrees.
struct Orbit {
  /// Moves the camera to the right around `up`.
  double azimuth_deg = 0.0;
  /// Then moves it upwards.
  double elevation_deg = 0.0;
  /// Then rotates its picture clockwise.
  double roll_deg = 0.0;

  /// Returns whether both are equal.
  bool operator==(const Orbit&) const = default;
};

/// Returns the camera moved around the point `target` of the scene. `up`, of any length except 0, is the axis of the
/// azimuth. If all angles are 0, the camera keeps its bits.
PROMIN_EXPORT Camera orbit_camera(const Camera& camera, const dvec3& target, const Orbit& orbit,
                                  const vec3& up = vec3(0.0F, 1.0F, 0.0F));

/// Returns the point to orbit: the point on the camera's axis that is nearest to the middle of the scene, or that
/// middle itself if it does not lie in front of the camera. Throws InputError as bounds_of() does.
PROMIN_EXPORT dvec3 orbit_target(const Scene& scene, const Camera& camera);

/// Returns a camera whose pictures of this size show at least what pictures of the camera's own aspect ratio show:
/// narrower pictures show more above and below. A camera without an aspect ratio keeps its bits.
PROMIN_EXPORT Camera widen_camera(const Camera& camera, const uvec2& size);

/// Returns whether a camera may see anything of a valid scene. False is certain. True may be wrong if surfaces lie near
/// the picture's corners, show only a back that is not drawn, or are transparent.
PROMIN_EXPORT bool may_see(const Scene& scene, const Camera& camera, float aspect_ratio);

}  // namespace promin
