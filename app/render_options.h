// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bvh/builder.h"
#include "console.h"
#include "core/math.h"
#include "render/renderer.h"

namespace CLI {
class App;
}

namespace promin::app {

/// Longest side of a picture, in pixels.
inline constexpr uint32_t kMaxSide = 32768;

/// What replaces parts of the chosen camera. Directions need not be unit vectors.
struct PoseOptions {
  std::optional<dvec3> eye;
  std::optional<dvec3> look;
  std::optional<dvec3> up;
  /// Vertical, degrees in (0, 180).
  std::optional<double> fov_deg;
  std::optional<double> near;
};

/// What of the scene is shown, as the user asked for it; make_view (view_setup.h) makes a View of it.
struct ViewOptions {
  std::optional<uvec2> size;
  std::optional<PixelWindow> crop;
  uint32_t samples_per_pixel = View{}.samples_per_pixel;
  uint32_t max_depth = View{}.max_depth;
  /// Name or number of a camera.
  std::optional<std::string> camera;
  PoseOptions pose;
};

struct RenderOptions {
  std::filesystem::path scene;
  std::vector<std::filesystem::path> pictures;
  std::optional<std::filesystem::path> stats;
  ViewOptions view;
  /// Name or index of a device.
  std::optional<std::string> device;
  std::string builder = RendererOptions{}.builder;
  bool has_all_features = false;
  uint32_t repeat_count = 1;
  bool is_quiet = false;
  bool is_verbose = false;

  Verbosity verbosity() const;
};

/// Adds a row for each option to the command. `options` must outlive the parsing.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Throws UsageError for what no single option shows: two that contradict each other.
void check_render_options(const RenderOptions& options);

}  // namespace promin::app
