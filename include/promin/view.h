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

/// A window of pixels of the whole picture. `lo` is inside and `hi` outside: lo.x <= x < hi.x. Row 0 is at the top.
struct PixelWindow {
  /// The first column and row inside the window.
  uvec2 lo{0};
  /// The first column and row beyond the window.
  uvec2 hi{0};
};

/// The method that computes the light of a picture. kWhitted is Whitted's: lights cast shadows, and the light of the
/// environment reaches every point. With kDirect objects also block the light of the environment (docs/model.md, "Skies
/// with shadows"). With kPath surfaces also scatter light to other surfaces, up to View::max_depth times
/// (docs/model.md, "Scattered light").
enum class Integrator : uint32_t { kWhitted, kDirect, kPath };

/// Returns the names to display, indexed by Integrator. The first name is "whitted".
PROMIN_EXPORT std::span<const std::string_view> integrator_names();

/// The settings of a picture that are compiled into a pipeline. Each mode has its own pipeline.
struct RenderMode {
  /// The property that the picture shows; light by default.
  DebugView debug_view = DebugView::kNone;
  /// True if lights cast shadows. Without shadows every light reaches every point that faces it.
  bool has_shadows = true;
  /// The method that computes light.
  Integrator integrator = Integrator::kWhitted;

  /// Returns whether both modes need the same pipeline.
  bool operator==(const RenderMode&) const = default;
};

/// The filter that weights light around a pixel's centre. Samples are drawn in proportion to the filter's weight, so
/// all samples count the same and a pixel depends only on its own rays (Ernst, Stamminger and Greiner, "Filter
/// Importance Sampling", 2006). The filters are kBox, kTent, kGauss, which is cut off at 3 standard deviations, and
/// kBlackmanHarris, which is similar to kGauss but falls smoothly to 0 at its ends.
enum class PixelFilter : uint32_t {
/// @cond
#define PROMIN_PIXEL_FILTER(ENUMERATOR, NAME, WIDTH) ENUMERATOR,
#include "promin/kinds/pixel_filters.def"
  /// @endcond
};

/// Returns the names to display, indexed by PixelFilter. The first name is "box".
PROMIN_EXPORT std::span<const std::string_view> pixel_filter_names();
/// Returns the default width of a filter in pixels.
PROMIN_EXPORT float default_width(PixelFilter filter);

/// The definition of the AOV `depth`. kRay is the distance from the eye to the hit; for an orthographic camera it is
/// the distance from the plane through the eye. kPlane is the distance of the hit from the plane through the eye that
/// is perpendicular to the direction of view. Compositing programs use it for blur.
enum class DepthKind : uint32_t { kRay, kPlane };

/// Returns the names to display, indexed by DepthKind. The first name is "ray".
PROMIN_EXPORT std::span<const std::string_view> depth_kind_names();

/// The smallest width of a filter in pixels.
inline constexpr float kMinFilterWidth = 0.01F;
/// The largest width of a filter in pixels.
inline constexpr float kMaxFilterWidth = 32.0F;

/// The accuracy that a picture should have. Each pixel takes samples until its claim is small enough. The claim is the
/// error that promin states for each channel of linear light. It must be at most `error` times `white`, or `error`
/// times the pixel's largest channel if that is larger. In every scene of the tests, at least 95 percent of the pixels
/// with more than `min_samples` samples have an error within their claim (docs/model.md, "Error of a pixel"); this is
/// no proof for other scenes.
struct ErrorTarget {
  /// The target error, kMinTargetError...1.
  float error = 1.0F / 64.0F;
  /// The smallest number of samples of a pixel, a power of two, kMinRefinedSamples...max_samples. All samples of a
  /// pixel may miss a detail that is thinner than the pixel's width divided by this number.
  uint32_t min_samples = 8;
  /// The radiance that is displayed as white, positive and finite: 2^-EV for an exposure of EV stops.
  float white = 1.0F;
  /// The display transform. If it is set, the error is measured as displayed: each channel is exposed, tone mapped and
  /// encoded as sRGB, 0...1. The claim is then the distance to the farthest displayed corner of the linear claim, and
  /// `white` is not used.
  std::optional<DisplayTransform> display = std::nullopt;
  /// The largest number of samples of a pixel, even if the target is not reached; a power of two, at most
  /// kMaxRefinedSamples.
  uint32_t max_samples = 256;

  /// Returns whether both are equal.
  bool operator==(const ErrorTarget&) const = default;
};

/// The smallest target error.
inline constexpr float kMinTargetError = 1.0F / 65536.0F;
/// The smallest number of samples from which an error can be estimated.
inline constexpr uint32_t kMinRefinedSamples = 4;
/// The largest number of samples of a refined pixel.
inline constexpr uint32_t kMaxRefinedSamples = 32768;

/// The largest side of a picture in pixels.
inline constexpr uint32_t kMaxSide = 32768;
/// The largest number of samples per pixel.
inline constexpr uint32_t kMaxSamplesPerPixel = 65535;
/// The largest number of mirror bounces.
inline constexpr uint32_t kMaxDepth = 1000;

/// The description of one picture of a scene. Values outside the ranges given here and in promin/camera.h cause
/// UsageError.
struct View {
  /// The camera; see frame_scene (promin/framing.h).
  Camera camera;
  /// Width and height of the whole picture in pixels, 1...kMaxSide. The camera's vertical field of view applies to the
  /// height.
  uvec2 size{1280, 720};
  /// Pixels to trace, at least one and inside the picture; empty for all pixels. The pixels of a crop have the same
  /// bits as in the whole picture.
  std::optional<PixelWindow> crop;
  /// Samples per pixel, 1...kMaxSamplesPerPixel, at fixed points of a lattice; a single sample is at the centre.
  uint32_t samples_per_pixel = 1;
  /// If set, each pixel takes as many samples as it needs, at points that depend on the pixel. Requires full shading
  /// and no debug view.
  std::optional<ErrorTarget> error_target;
  /// The definition of the AOV `depth`.
  DepthKind depth_kind = DepthKind::kRay;
  /// The filter that weights samples by their distance from the pixel's centre.
  PixelFilter filter = PixelFilter::kBox;
  /// Full width of the filter in pixels, kMinFilterWidth...kMaxFilterWidth.
  float filter_width = 1.0F;
  /// Largest number of bounces, 0...kMaxDepth; 0 traces neither mirror nor refracted rays. See default_max_depth.
  uint32_t max_depth = 5;
  /// The seed of the sample points that depend on the pixel: of lights with a size, and of pictures with an error
  /// target. Each seed gives other noise.
  uint32_t seed = 0;
  /// The largest distance at which surfaces occlude others in DebugView::kOcclusion and Aovs::ambient_occlusion, 0 to
  /// 1e15; 0 for any distance.
  float occlusion_distance = 0.0F;
  /// The mode. If it differs from the mode of the previous picture, promin first compiles the pipeline of this mode.
  RenderMode mode;
};

/// The default of `max_depth` for scenes with glass.
inline constexpr uint32_t kMaxDepthOfGlass = 8;

/// Returns whether two cameras see the same picture. Names and aspect ratios do not matter.
PROMIN_EXPORT bool shows_same(const Camera& a, const Camera& b);
/// Returns whether two views are equal except for their numbers of samples and error targets.
PROMIN_EXPORT bool shows_same(const View& a, const View& b);

}  // namespace promin
