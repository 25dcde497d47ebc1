// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "promin/camera.h"
#include "promin/debug_view.h"
#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// A window of pixels, half-open: lo.x <= x < hi.x.
struct PixelWindow {
  uvec2 lo{0};
  uvec2 hi{0};
};

/// What of a picture is compiled in: each mode has a pipeline of its own.
struct RenderMode {
  DebugView debug_view = DebugView::kNone;
  /// Without shadows nothing is between a point and a light.
  bool has_shadows = true;

  bool operator==(const RenderMode&) const = default;
};

/// The largest number of samples a pixel.
inline constexpr uint32_t kMaxSamplesPerPixel = 65535;
/// The largest number of mirror bounces.
inline constexpr uint32_t kMaxDepth = 1000;

/// One picture of a scene.
struct View {
  Camera camera;
  uvec2 size{1280, 720};
  /// Pixels to trace; the whole picture where empty. A crop has the bits of the same pixels of the whole.
  std::optional<PixelWindow> crop;
  /// Samples a pixel, at fixed well-distributed points; 1 is the centre. 1...kMaxSamplesPerPixel.
  uint32_t samples_per_pixel = 1;
  /// Mirror bounces; 0 traces no mirror rays. 0...kMaxDepth.
  uint32_t max_depth = 5;
  RenderMode mode;
};

/// Whether two cameras see the same: names and aspect ratios aside.
PROMIN_EXPORT bool shows_same(const Camera& a, const Camera& b);
/// Whether two views show the same but for their samples.
PROMIN_EXPORT bool shows_same(const View& a, const View& b);

}  // namespace promin
