// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/session.h"

#include <fmt/format.h>

#include <cstdio>

#include "measure/samples.h"
#include "scene/load_scene.h"
#include "view_setup.h"

namespace promin::report {

Session::Session(const ReportOptions& options) : options_(options), device_(gpu::open_device(options.device)) {}

void Session::say(const std::string& text) const {
  std::fputs(fmt::format("promin-report: {}\n", text).c_str(), stderr);
}

std::vector<Scene> Session::load_scenes(const std::vector<std::string>& own) const {
  std::vector<std::filesystem::path> files = options_.scenes;
  if (files.empty()) {
    for (const std::string& name : own) files.push_back(std::filesystem::path(PROMIN_SCENES_DIR) / name);
  }
  std::vector<Scene> scenes;
  for (const std::filesystem::path& file : files) {
    scenes.push_back(load_scene(file));
    app::light_up(scenes.back(), app::Console(app::Verbosity::kQuiet));
  }
  return scenes;
}

std::string name_of(const Scene& scene) {
  return scene.file.stem().string();
}

View view_of(const Scene& scene, const uvec2& size) {
  app::ViewOptions options;
  options.size = size;
  return app::make_view(scene, options, app::Console(app::Verbosity::kQuiet));
}

Json json_of_times(const std::vector<double>& times, double scale) {
  const measure::Quartiles q = measure::quartiles_of(times);
  return {{"median", scale * q.median},
          {"lower_quartile", scale * q.lower},
          {"upper_quartile", scale * q.upper},
          {"runs", times.size()}};
}

}  // namespace promin::report
