// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene_loader.h"

#include <utility>

#include "view_setup.h"

namespace promin::app {

PackedChoice pack_choice(const Scene& scene, const SceneChoice& choice, const ProgressCallback& progress) {
  PackedChoice result{choice, {}, 0};
  std::vector<uint32_t>& lights_off = result.choice.lights_off;
  std::erase_if(lights_off, [&](uint32_t light) { return light >= scene.lights.size(); });
  std::optional<Scene> lit;
  if (!lights_off.empty()) leave_out_lights(lit.emplace(scene), lights_off);
  const Scene& chosen = lit ? *lit : scene;
  result.packed =
      choice.bvh ? pack_scene_with(*choice.bvh, chosen) : pack_scene(chosen, choice.builder, {.progress = progress});
  result.features = features_of(chosen);
  return result;
}

void SceneWatch::follow(std::vector<SourceFile> sources) {
  sources_ = std::move(sources);
  last_.clear();
}

bool SceneWatch::has_changed() {
  Stamps stamps;
  bool is_changed = false;
  for (const SourceFile& source : sources_) {
    stamps.push_back(stamp_of(source.file));
    // Editors replace files: one that is gone for now is no change.
    is_changed = is_changed || (stamps.back() && stamps.back() != source.stamp);
  }
  const bool are_left_alone = stamps == std::exchange(last_, stamps);
  if (!is_changed || !are_left_alone) return false;
  for (size_t i = 0; i < sources_.size(); ++i) sources_[i].stamp = stamps[i];
  return true;
}

}  // namespace promin::app
