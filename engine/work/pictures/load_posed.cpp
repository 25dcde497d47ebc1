// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/load_posed.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "core/parse_number.h"
#include "formats/load_report.h"
#include "promin/error.h"

namespace promin::work {
namespace {

std::string list_animations(const std::vector<Animation>& animations) {
  std::string text;
  for (size_t i = 0; i < animations.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", i);
    if (!animations[i].name.empty()) text += fmt::format(" ({})", animations[i].name);
  }
  return text;
}

/// Finds an animation by name or number. The name is tried first, because an animation may be called "2".
uint32_t find_animation(const Scene& scene, const std::string& selection) {
  const std::vector<Animation>& animations = scene.motion->animations;
  for (uint32_t i = 0; i < animations.size(); ++i) {
    if (animations[i].name == selection) return i;
  }
  const std::optional<uint32_t> index = to_number<uint32_t>(selection);
  if (index && *index < animations.size()) return *index;
  throw UsageError({"animation.unknown", "the scene has no animation \"" + selection + "\"", scene.file.string(),
                    "choose one of: " + list_animations(animations)});
}

/// Adds or removes the warning of a scene that shows nothing, which depends on the pose.
void renew_warning(Scene& scene) {
  std::erase(scene.warnings, kNothingToDraw);
  const auto is_drawn = [](const Object& object) { return object.geometry != Object::kNoGeometry; };
  if (std::ranges::none_of(scene.objects, is_drawn)) scene.warnings.emplace_back(kNothingToDraw);
}

}  // namespace

PoseChoice choose_pose(const Scene& scene, const MotionOptions& options) {
  PoseChoice choice{.animations = {}, .time_s = options.time_s.value_or(0.0), .loops = options.loops};
  if (!options.any() || options.chooses_none()) return choice;
  const bool has_animations = scene.motion != nullptr && !scene.motion->animations.empty();
  if (options.animations.empty() || options.chooses_all()) {
    const size_t count = !has_animations ? 0 : options.chooses_all() ? scene.motion->animations.size() : 1;
    choice.animations.resize(count);
    std::iota(choice.animations.begin(), choice.animations.end(), 0U);
    return choice;
  }
  if (!has_animations) {
    throw UsageError({"animation.missing", "the scene has no animations", scene.file.string(), "remove --animation"});
  }
  for (const std::string& selection : options.animations) choice.animations.push_back(find_animation(scene, selection));
  return choice;
}

Scene load_posed(const std::filesystem::path& file, const LoadOptions& load, const MotionOptions& motion,
                 std::vector<SourceFile>& sources) {
  Scene scene = load_scene(file, load, sources);
  const PoseChoice choice = choose_pose(scene, motion);
  if (!choice.animations.empty()) {
    scene = scene_at(std::move(scene), choice);
    renew_warning(scene);
    return scene;
  }
  if (motion.any() && !motion.chooses_none()) {
    scene.warnings.emplace_back("the scene has no animations, so its pose does not depend on the time");
  }
  return scene;
}

}  // namespace promin::work
