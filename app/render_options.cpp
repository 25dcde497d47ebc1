// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render_options.h"

#include <fmt/ranges.h>

#include <array>

#include "arguments.h"
#include "core/error.h"
#include "render/sampling.h"
#include "scene/load_scene.h"

namespace promin::app {
namespace {

constexpr uint32_t kMaxDepth = 1000;
constexpr uint32_t kMaxRepeats = 10000;
/// The limits 0 and 180 themselves show nothing.
constexpr double kMinFovDeg = 1e-3;
constexpr double kMaxFovDeg = 180.0 - kMinFovDeg;
constexpr std::array<std::string_view, 2> kFeatureChoices = {"scene", "all"};

PixelWindow read_window(const Words& words) {
  const PixelWindow window = {{words.whole(0, 0, kMaxSide), words.whole(1, 0, kMaxSide)},
                              {words.whole(2, 0, kMaxSide), words.whole(3, 0, kMaxSide)}};
  if (window.lo.x >= window.hi.x || window.lo.y >= window.hi.y) {
    words.refuse("--crop is empty: it takes X0 < X1 and Y0 < Y1");
  }
  return window;
}

}  // namespace

Verbosity RenderOptions::verbosity() const {
  if (is_quiet) return Verbosity::kQuiet;
  return is_verbose ? Verbosity::kVerbose : Verbosity::kNormal;
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  ViewOptions& view = options.view;
  PoseOptions& pose = view.pose;
  OptionTable table(command);

  table.add_required("SCENE", "", "Scene file: .gltf, .glb or .obj", [&](const Words& w) { options.scene = w.text(); });
  table.add_required_repeated("-o,--output", "FILE",
                              "Picture to write: .exr (linear float) or .png (sRGB, 8 bit); repeatable",
                              [&](const Words& w) { options.pictures.assign(w.all().begin(), w.all().end()); });
  table.add("-s,--spp", "N", fmt::format("Samples a pixel, 1 to {} [1]", kMaxSamplesPerPixel),
            [&](const Words& w) { view.samples_per_pixel = w.whole(0, 1, kMaxSamplesPerPixel); });
  table.add("--size", "W H", "Picture size in pixels [height 720, width by the camera's aspect ratio]",
            [&](const Words& w) { view.size = uvec2(w.whole(0, 1, kMaxSide), w.whole(1, 1, kMaxSide)); });
  table.add("--max-depth", "N",
            fmt::format("Mirror bounces, 0 to {}; 0 traces no mirror rays [{}]", kMaxDepth, View{}.max_depth),
            [&](const Words& w) { view.max_depth = w.whole(0, 0, kMaxDepth); });
  table.add("--camera", "NAME|INDEX", "Camera of the scene by its name or its number from 0 [0]",
            [&](const Words& w) { view.camera = w.text(); });
  table.add("--crop", "X0 Y0 X1 Y1", "Render only the pixels X0 <= x < X1, Y0 <= y < Y1; row 0 is the top",
            [&](const Words& w) { view.crop = read_window(w); });

  table.add("--eye", "X Y Z", "Place of the eye, instead of the camera's",
            [&](const Words& w) { pose.eye = w.vector(kMaxCoordinate); });
  table.add("--look", "X Y Z", "Direction of view, instead of the camera's",
            [&](const Words& w) { pose.look = w.vector(kMaxCoordinate); });
  table.add("--up", "X Y Z", "Direction that is up in the picture [with --look 0 1 0, else the camera's]",
            [&](const Words& w) { pose.up = w.vector(kMaxCoordinate); });
  table.add("--fov", "DEG", "Vertical field of view in degrees, instead of the camera's",
            [&](const Words& w) { pose.fov_deg = w.real(0, kMinFovDeg, kMaxFovDeg); });
  table.add("--near", "T", "Distance before which nothing is drawn, in scene units, instead of the camera's",
            [&](const Words& w) { pose.near = w.real(0, 0.0, kMaxCoordinate); });

  table.add("--device", "NAME|INDEX", "Vulkan device by a part of its name or its index in `promin devices`",
            [&](const Words& w) { options.device = w.text(); });
  table.add("--builder", "NAME", fmt::format("BVH builder: {} [{}]", fmt::join(builder_names(), ", "), options.builder),
            [&](const Words& w) { options.builder = w.choice(builder_names()); });
  table.add("--features", "scene|all", "Compile in what the scene uses, or all there is, for measuring [scene]",
            [&](const Words& w) { options.has_all_features = w.choice(kFeatureChoices) == "all"; });
  table.add("--repeat", "N", "Trace N times and report the median time [1]",
            [&](const Words& w) { options.repeat_count = w.whole(0, 1, kMaxRepeats); });
  table.add("--stats", "FILE.json", "Write counts and times as JSON",
            [&](const Words& w) { options.stats = w.text(); });
  table.add_flag("--quiet", "Print nothing but errors", options.is_quiet);
  table.add_flag("-v,--verbose", "Say what is done and how long it takes", options.is_verbose);
}

void check_render_options(const RenderOptions& options) {
  if (options.is_quiet && options.is_verbose) {
    throw UsageError({"--quiet and --verbose contradict each other", "on the command line", "leave one out"});
  }
}

}  // namespace promin::app
