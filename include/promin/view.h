// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/math.h"
#include "promin/scene.h"
#include "render/shading.h"

namespace promin {

/// A window of pixels, half-open: x0 <= x < x1.
struct PixelWindow {
  uvec2 lo{0};
  uvec2 hi{0};
};

/// One picture of the loaded scene.
struct View {
  Camera camera;
  uvec2 size{1280, 720};
  /// Pixels to trace; the whole picture where empty. A crop has the bits of the same pixels of the whole.
  std::optional<PixelWindow> crop;
  /// Samples a pixel, at fixed well-distributed points; 1 is the centre. 1...kMaxSamplesPerPixel (trace/sampling.h).
  uint32_t samples_per_pixel = 1;
  /// Mirror bounces; 0 traces no mirror rays. 0...1000.
  uint32_t max_depth = 5;
  /// Each has a pipeline of its own.
  Shading shading = Shading::kFull;
};

}  // namespace promin
