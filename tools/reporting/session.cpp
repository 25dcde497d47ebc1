// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/session.h"

#include <fmt/format.h>

#include <cstdio>

#include "device/device.h"
#include "measure/meshes.h"
#include "reporting/scene_names.h"
#include "view_setup.h"

namespace promin::report {

namespace {

/// With double where the device has it, as one of the methods computes in it; without, that method is left out.
gpu::DeviceHandle open_device(const std::optional<std::string>& selection) {
  return gpu::open_device(gpu::DeviceOptions{
      .selection = selection, .features = {{.feature = gpu::OptionalFeature::kFloat64, .is_needed = false}}});
}

}  // namespace

Session::Session(const ReportOptions& options)
    : options_(options), names_(name_scenes(options.scenes)), device_(open_device(options.device)) {}

void Session::say(const std::string& text) const {
  std::fputs(fmt::format("promin-report: {}\n", text).c_str(), stderr);
}

std::vector<world::Scene> Session::open_scenes(const std::vector<std::string>& own) const {
  std::vector<world::Scene> scenes;
  for (const std::filesystem::path& file : options_.scenes) scenes.push_back(measure::open_scene(file.string()));
  if (!scenes.empty()) return scenes;
  for (const std::string& word : own) {
    const bool is_generated = word.find(':') != std::string::npos;
    scenes.push_back(measure::open_scene(is_generated ? word : fmt::format("{}/{}", PROMIN_SCENES_DIR, word)));
  }
  return scenes;
}

std::vector<world::Scene> Session::load_scenes(const std::vector<std::string>& own) const {
  std::vector<world::Scene> scenes = open_scenes(own);
  for (world::Scene& scene : scenes) add_default_lights(scene);
  return scenes;
}

std::string Session::name_of(const world::Scene& scene) const {
  const auto found = std::find(options_.scenes.begin(), options_.scenes.end(), scene.file);
  if (found == options_.scenes.end()) return scene.file.stem().string();
  return names_[static_cast<size_t>(found - options_.scenes.begin())];
}

View view_of(const world::Scene& scene, const uvec2& size) {
  View view;
  view.size = size;
  view.camera = scene.cameras.empty() ? look_from_front(scene, static_cast<float>(size.x) / static_cast<float>(size.y))
                                      : scene.cameras.front();
  return view;
}

Json json_of_few(const std::vector<double>& times) {
  return {{"few", times}};
}

Json json_of_gap(const std::string& name, const std::optional<std::string>& failure) {
  return {{"name", name}, {"is_installed", failure.has_value()}, {"reason", failure.value_or("not installed")}};
}

}  // namespace promin::report
