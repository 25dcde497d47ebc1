// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/session.h"

#include <fmt/format.h>

#include <cstdio>

#include "measure/samples.h"
#include "promin/load_scene.h"
#include "reporting/scene_names.h"
#include "view_setup.h"

namespace promin::report {

Session::Session(const ReportOptions& options)
    : options_(options), names_(name_scenes(options.scenes)), device_(gpu::open_device(options.device)) {}

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

std::string Session::name_of(const Scene& scene) const {
  const auto found = std::find(options_.scenes.begin(), options_.scenes.end(), scene.file);
  if (found == options_.scenes.end()) return scene.file.stem().string();
  return names_[static_cast<size_t>(found - options_.scenes.begin())];
}

View view_of(const Scene& scene, const uvec2& size) {
  app::ViewOptions options;
  options.size = size;
  return app::make_view(scene, options, app::Console(app::Verbosity::kQuiet));
}

Json json_of_times(const std::vector<double>& values) {
  const measure::Quartiles quartiles = measure::quartiles_of(values);
  const measure::MedianInterval interval = measure::median_interval_of(values);
  return {{"median", quartiles.median},
          {"lower_quartile", quartiles.lower},
          {"upper_quartile", quartiles.upper},
          {"interval_lower", interval.lower},
          {"interval_upper", interval.upper},
          {"confidence", interval.confidence},
          {"runs", values.size()},
          {"values", values}};
}

Json json_of_few_times(const std::vector<double>& times) {
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  return {{"median", measure::quartiles_of(times).median},
          {"least", *least},
          {"most", *most},
          {"runs", times.size()},
          {"values", times}};
}

Json json_of_gap(const std::string& name, const std::optional<std::string>& failure) {
  return {{"name", name}, {"is_installed", failure.has_value()}, {"reason", failure.value_or("not installed")}};
}

}  // namespace promin::report
