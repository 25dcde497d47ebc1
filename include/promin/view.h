// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "promin/camera.h"
#include "promin/debug_view.h"
#include "promin/display.h"
#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// A window of pixels of the whole picture, half-open: lo.x <= x < hi.x. Row 0 is the top.
struct PixelWindow {
  /// The first column and row that are in it.
  uvec2 lo{0};
  /// The first column and row that are beyond it.
  uvec2 hi{0};
};

/// What of a picture is compiled in: each mode has a pipeline of its own.
struct RenderMode {
  /// What is shown; light by default.
  DebugView debug_view = DebugView::kNone;
  /// Without shadows every light reaches every point that faces it.
  bool has_shadows = true;

  /// Whether both need the same pipeline.
  bool operator==(const RenderMode&) const = default;
};

/// How the light around a pixel's centre is weighed. Samples are drawn by the filter's weight, so that each counts the
/// same and a pixel hangs on its own rays alone (Ernst, Stamminger and Greiner, "Filter Importance Sampling", 2006).
/// kBox, kTent; kGauss, cut off where it is 3 standard deviations from the centre; kBlackmanHarris, near to it and
/// smoothly 0 at its ends.
enum class PixelFilter : uint32_t {
/// @cond
#define PROMIN_PIXEL_FILTER(ENUMERATOR, NAME, WIDTH) ENUMERATOR,
#include "promin/kinds/pixel_filters.def"
  /// @endcond
};

/// Names for people, by the value of the PixelFilter; the first is "box".
PROMIN_EXPORT std::span<const std::string_view> pixel_filter_names();
/// The width that a filter has where none is asked for, in pixels.
PROMIN_EXPORT float default_width(PixelFilter filter);

/// How the AOV `depth` is measured: kRay: from the eye to the hit, with an orthographic camera from the plane through
/// the eye; kPlane: from the plane through the eye across the view, as compositors blur by.
enum class DepthKind : uint32_t { kRay, kPlane };

/// Names for people, by the value of the DepthKind; the first is "ray".
PROMIN_EXPORT std::span<const std::string_view> depth_kind_names();

/// The least and the largest width of a filter in pixels.
inline constexpr float kMinFilterWidth = 0.01F;
/// See kMinFilterWidth.
inline constexpr float kMaxFilterWidth = 32.0F;

/// How exact a picture is to be. Each pixel takes samples until a claim of its error is at most `error`, in each
/// channel of linear light: of `white`, or of the pixel's largest channel where that is more. Of the pixels that take
/// more than `min_samples` the claim holds for at least 95 in 100 in every scene that the tests know (docs/model.md,
/// "Error of a pixel"); it is no proof.
struct ErrorTarget {
  /// kMinTargetError...1.
  float error = 1.0F / 64.0F;
  /// The samples that each pixel takes, a power of two, kMinRefinedSamples...max_samples. What is thinner than a pixel
  /// over this number may lie between all samples.
  uint32_t min_samples = 8;
  /// What is shown as white, positive and finite: 2^-EV where pictures are exposed by EV stops.
  float white = 1.0F;
  /// How the picture is shown, where its error is to be measured as it is shown: each channel exposed, tone mapped and
  /// encoded as sRGB, 0...1. A pixel claims then what is farthest from it of the corners of its claim, and `white` does
  /// not count.
  std::optional<DisplayTransform> display = std::nullopt;
  /// The samples at which a pixel stops, near enough or not, a power of two, at most kMaxRefinedSamples.
  uint32_t max_samples = 256;

  /// Whether both ask for the same.
  bool operator==(const ErrorTarget&) const = default;
};

/// The least error to ask for.
inline constexpr float kMinTargetError = 1.0F / 65536.0F;
/// The least number of samples that tell of an error.
inline constexpr uint32_t kMinRefinedSamples = 4;
/// The most samples that a pixel is refined to.
inline constexpr uint32_t kMaxRefinedSamples = 32768;

/// The longest side of a picture in pixels.
inline constexpr uint32_t kMaxSide = 32768;
/// The largest number of samples a pixel.
inline constexpr uint32_t kMaxSamplesPerPixel = 65535;
/// The largest number of mirror bounces.
inline constexpr uint32_t kMaxDepth = 1000;

/// One picture of a scene. What breaks a range that is given here or in promin/camera.h is refused with UsageError.
struct View {
  /// Where the picture is taken from; see frame_scene (promin/framing.h).
  Camera camera;
  /// Width and height of the whole picture in pixels, 1...kMaxSide. The camera's vertical field of view holds.
  uvec2 size{1280, 720};
  /// Pixels to trace, at least one and within the picture; without a crop all. A crop has the bits of the same pixels
  /// of the whole.
  std::optional<PixelWindow> crop;
  /// Samples a pixel, 1...kMaxSamplesPerPixel, at fixed points of a lattice; 1 samples the centre.
  uint32_t samples_per_pixel = 1;
  /// Samples as the pixels need them instead, at points that hang on the pixel. Light is shown then, no debug view.
  std::optional<ErrorTarget> error_target;
  /// What the AOV `depth` is.
  DepthKind depth_kind = DepthKind::kRay;
  /// The weight of samples by their distance from the pixel's centre.
  PixelFilter filter = PixelFilter::kBox;
  /// From end to end of what the filter weighs, in pixels, kMinFilterWidth...kMaxFilterWidth.
  float filter_width = 1.0F;
  /// Bounces, 0...kMaxDepth; 0 traces neither mirror nor refracted rays. See default_max_depth.
  uint32_t max_depth = 5;
  /// What is shown; another mode than the last one's is compiled first.
  RenderMode mode;
};

/// The bounces that pictures of scenes with glass take unless others are asked for.
inline constexpr uint32_t kMaxDepthOfGlass = 8;

/// Whether two cameras see the same: names and aspect ratios aside.
PROMIN_EXPORT bool shows_same(const Camera& a, const Camera& b);
/// Whether two views show the same but for their samples.
PROMIN_EXPORT bool shows_same(const View& a, const View& b);

}  // namespace promin
