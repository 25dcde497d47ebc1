// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene_loader.h"

#include <chrono>
#include <utility>

#include "console.h"
#include "scene/load_scene.h"
#include "view_setup.h"

namespace promin::app {

LoadedScene load_chosen_scene(const std::filesystem::path& file, const SceneChoice& choice) {
  const auto scene = std::make_shared<Scene>(load_scene(file));
  light_up(*scene, Console(Verbosity::kQuiet));
  return pack_chosen_scene(scene, choice);
}

LoadedScene pack_chosen_scene(std::shared_ptr<const Scene> scene, const SceneChoice& choice) {
  LoadedScene loaded;
  loaded.choice = choice;
  std::vector<uint32_t>& lights_off = loaded.choice.lights_off;
  std::erase_if(lights_off, [&](uint32_t light) { return light >= scene->lights.size(); });
  std::shared_ptr<const Scene> chosen = scene;
  if (!lights_off.empty()) {
    const auto lit = std::make_shared<Scene>(*scene);
    leave_out_lights(*lit, lights_off);
    chosen = lit;
  }
  loaded.packed = choice.bvh ? pack_scene_with(*choice.bvh, *chosen) : pack_scene(*chosen, choice.builder);
  loaded.features = features_of(*chosen);
  loaded.scene = std::move(scene);
  return loaded;
}

SceneLoader::SceneLoader(std::filesystem::path file) : file_(std::move(file)), loaded_(read_stamp()), last_(loaded_) {}

bool SceneLoader::has_file_changed() {
  const std::optional<Stamp> stamp = read_stamp();
  const bool is_left_alone = stamp == std::exchange(last_, stamp);
  if (!stamp || stamp == loaded_ || !is_left_alone) return false;
  loaded_ = stamp;
  return true;
}

void SceneLoader::load(const SceneChoice& choice) {
  result_ = std::async(std::launch::async, load_chosen_scene, file_, choice);
}

void SceneLoader::pack(std::shared_ptr<const Scene> scene, const SceneChoice& choice) {
  result_ = std::async(std::launch::async, pack_chosen_scene, std::move(scene), choice);
}

std::optional<LoadedScene> SceneLoader::take() {
  if (!is_busy() || result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return result_.get();
}

std::optional<SceneLoader::Stamp> SceneLoader::read_stamp() const {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file_, error);
  if (error) return std::nullopt;
  const uintmax_t size = std::filesystem::file_size(file_, error);
  return error ? std::nullopt : std::optional(Stamp{time, size});
}

}  // namespace promin::app
