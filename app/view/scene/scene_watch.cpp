// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene/scene_watch.h"

#include <utility>

namespace promin::app {

void SceneWatch::follow(std::vector<SourceFile> sources) {
  sources_ = std::move(sources);
  last_.clear();
}

bool SceneWatch::has_changed() {
  Stamps stamps;
  bool is_changed = false;
  for (const SourceFile& source : sources_) {
    stamps.push_back(stamp_of(source.file));
    // Editors replace files, so a file that does not exist for a moment is no change.
    is_changed = is_changed || (stamps.back() && stamps.back() != source.stamp);
  }
  const bool are_left_alone = stamps == std::exchange(last_, stamps);
  if (!is_changed || !are_left_alone) return false;
  for (size_t i = 0; i < sources_.size(); ++i) sources_[i].stamp = stamps[i];
  return true;
}

}  // namespace promin::app
