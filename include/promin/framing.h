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

// Cameras that frame a scene (docs/model.md, "Showing a picture"). Framing includes all finite geometry except stray
// geometry: if 99 percent of the surface area lies in a box smaller than 1/64 of the whole scene's size, only this box
// is framed.

/// The side from which frame_scene looks. If +Y is up, the front is the +Z side. Left and right are as a viewer in
/// front of the scene sees them.
enum class Framing : uint32_t {
  /// The camera looks from 30 degrees to the right of the front and 17 degrees above. It looks at a board from the
  /// front at the board's height; a board's depth is less than a quarter of its width or height. It looks at a flat
  /// scene from 45 degrees above; a flat scene's height is less than 1/16 of its width or depth and at most its depth.
  kThreeQuarter,
  kFront,
  kBack,
  /// The camera looks from -X if +Y is up and the front is +Z.
  kLeft,
  kRight,
  /// The camera looks from above. The front is at the lower edge of the picture.
  kTop,
  /// The camera looks from below. The front is at the upper edge of the picture.
  kBottom,
  /// The camera looks from inside, like a person in a room. The eye is at half the height. Its distance from the front
  /// end of the longer horizontal side is a third of that side; if the scene is wider than deep, it is the distance
  /// from the right end. The camera looks at the other end with a vertical field of view of 60 degrees.
  kInside,
};

/// Returns the names to display, indexed by Framing. The first name is "three-quarter".
PROMIN_EXPORT std::span<const std::string_view> framing_names();

/// The default fraction of the picture that a framed scene covers.
inline constexpr float kDefaultFit = 0.85F;
/// The smallest fraction that a caller may request.
inline constexpr float kMinFit = 0.05F;

/// Options of frame_scene.
struct FrameOptions {
  /// The side from which the camera looks. If empty, it is framing_of(scene).
  std::optional<Framing> from = std::nullopt;
  /// The fraction of the picture to cover, kMinFit...1; see fit_camera.
  float fit = kDefaultFit;
  /// The up direction of the scene, of any length except 0. The shortest rotation from +Y to `up` also rotates the
  /// front: if +Z is up, the front is -Y; if -Y is up, the front stays +Z.
  vec3 up{0.0F, 1.0F, 0.0F};
};

/// Returns the side from which to frame a scene. The camera sees a room through its open side (front, back, right or
/// left if +Y is up), or from inside if no side is open. It sees every other scene from three quarters. A scene is a
/// room if its outermost surfaces show their backs to most viewpoints outside and a surface inside shows its front to
/// the outside (docs/model.md). Throws InputError as bounds_of() does.
PROMIN_EXPORT Framing framing_of(const Scene& scene);

/// Returns a perspective camera that frames the scene. `aspect_ratio` is the picture's width divided by its height.
/// Throws UsageError if the ratio is not a positive finite number, if the fit is out of range, or if `up` is 0 or not
/// finite; throws InputError as bounds_of() does.
PROMIN_EXPORT Camera frame_scene(const Scene& scene, float aspect_ratio, const FrameOptions& options = {});

/// Returns the camera moved so that the projected scene lies in the middle of the picture, and so that it covers the
/// fraction `fit` of the picture's width or height, whichever fraction is larger. A scene that points at the eye like a
/// needle covers less: the distance of the eye is at least 1/256 of the distance at which the shorter side of the
/// scene's cross-section covers that fraction. The camera's directions and a perspective camera's field of view do not
/// change; an orthographic camera gets another height. Throws as frame_scene does.
PROMIN_EXPORT Camera fit_camera(const Scene& scene, const Camera& camera, float aspect_ratio, float fit = kDefaultFit);

/// Rotations of a camera around a point, in degrees.
struct Orbit {
  /// Angle by which the camera moves to the right around `up`; applied first.
  double azimuth_deg = 0.0;
  /// Angle by which the camera moves upwards; applied second.
  double elevation_deg = 0.0;
  /// Angle by which the camera's picture rotates clockwise; applied last.
  double roll_deg = 0.0;

  /// Returns whether both are equal.
  bool operator==(const Orbit&) const = default;
};

/// Returns the camera moved around the point `target` of the scene. `up`, of any length except 0, is the axis of the
/// azimuth. If all angles are 0, the camera does not change.
PROMIN_EXPORT Camera orbit_camera(const Camera& camera, const dvec3& target, const Orbit& orbit,
                                  const vec3& up = vec3(0.0F, 1.0F, 0.0F));

/// Returns the point to orbit. It is the point on the camera's axis that is nearest to the middle of the scene. If this
/// point does not lie in front of the camera, it is the middle of the scene. Throws InputError as bounds_of() does.
PROMIN_EXPORT dvec3 orbit_target(const Scene& scene, const Camera& camera);

/// Returns a camera for pictures of this size that shows at least what the camera shows in its own aspect ratio. A
/// narrower picture shows more above and below. A camera without an aspect ratio does not change.
PROMIN_EXPORT Camera widen_camera(const Camera& camera, const uvec2& size);

/// Returns whether a camera may see anything of a valid scene. The answer false is certain. The answer true may be
/// wrong if surfaces lie near the picture's corners, show only a back side that is not drawn, or are transparent.
PROMIN_EXPORT bool may_see(const Scene& scene, const Camera& camera, float aspect_ratio);

}  // namespace promin
