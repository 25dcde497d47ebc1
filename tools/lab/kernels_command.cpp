// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>

#include "lab/commands.h"
#include "lab/session.h"
#include "measure/meshes.h"
#include "options/tracing_options.h"
#include "trace/render/make_renderer.h"

namespace promin::lab {
namespace {

/// A use of a scene that needs kernels of its own.
struct Use {
  const char* name;
  RendererOptions options;
};

void print_times(const LabOptions& options) {
  constexpr uint32_t kSide = 16;
  const Use uses[] = {{"light", {}},
                      {"AOVs", {.with_aovs = true}},
                      {"normals", {.mode = {.debug_view = DebugView::kNormals}}},
                      {"target error", {.has_error_target = true}}};
  world::Scene scene = measure::open_scene(options.scenes.front());
  add_default_lights(scene);
  const Session session(options);
  Json rows = Json::array();
  for (const Use& use : uses) {
    RendererOptions chosen = use.options;
    chosen.expected_samples = uint64_t{kSide} * kSide;
    Renderer renderer = make_renderer(session.device(), scene, chosen);
    View view = view_of(scene, uvec2(kSide));
    view.mode = chosen.mode;
    if (chosen.has_error_target) view.error_target = ErrorTarget();
    static_cast<void>(renderer.render(view));
    rows.push_back({{"use", use.name}, {"compile_ms", renderer.setup_stats().pipeline_ms}});
  }
  fmt::print("{}\n", rows.dump());
}

}  // namespace

app::Command add_kernels_command(CLI::App& program) {
  CLI::App& command = app::add_command(
      program, "kernels",
      "Prints as JSON how long the kernels of a scene take to compile, if one process uses the scene for a picture, "
      "for AOVs, for a debug view and for a target error, one after the other");
  const auto options = std::make_shared<LabOptions>();
  app::OptionTable table(command);
  table.add_required("SCENE", "", "Scene file",
                     [=](const app::OptionValues& words) { options->scenes = {std::string(words.text())}; });
  app::add_device_option(table, options->device);
  return {&command, [options] { print_times(*options); }};
}

}  // namespace promin::lab
