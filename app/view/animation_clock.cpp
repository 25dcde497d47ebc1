// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/animation_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "promin/error.h"
#include "promin/motion.h"
#include "work/pictures/load_posed.h"

namespace promin::app {
namespace {

constexpr double kStepsPerSecond = 24.0;

/// Returns the word of --animation that chooses an animation: its name if no earlier animation has it.
std::string word_of_animation(const std::vector<Animation>& animations, size_t index) {
  const std::string& name = animations[index].name;
  const auto first = std::ranges::find(animations, name, &Animation::name);
  const bool is_first = first == animations.begin() + static_cast<std::ptrdiff_t>(index);
  const bool is_usable = !name.empty() && name != MotionOptions::kAll && name != MotionOptions::kNone;
  return is_first && is_usable ? name : std::to_string(index);
}

std::vector<AnimationClock::Clip> list_clips(const Scene& scene) {
  std::vector<AnimationClock::Clip> clips;
  if (scene.motion == nullptr) return clips;
  const std::vector<Animation>& animations = scene.motion->animations;
  double longest_s = 0.0;
  for (size_t i = 0; i < animations.size(); ++i) {
    const std::string& name = animations[i].name;
    clips.push_back({name.empty() ? fmt::format("animation {}", i) : name, word_of_animation(animations, i),
                     animations[i].duration_s});
    longest_s = std::max(longest_s, animations[i].duration_s);
  }
  if (clips.size() > 1) clips.push_back({"all together", MotionOptions::kAll, longest_s});
  return clips;
}

/// Returns the clip that shows these animations; -1 if no clip does.
int find_clip(const std::vector<AnimationClock::Clip>& clips, const std::vector<uint32_t>& animations) {
  if (animations.size() == 1) return static_cast<int>(animations[0]);
  const bool is_all = animations.size() > 1 && animations.size() + 1 == clips.size();
  return is_all ? static_cast<int>(clips.size()) - 1 : -1;
}

}  // namespace

AnimationClock::AnimationClock(const Scene& scene, const MotionOptions& opened)
    : clips_(list_clips(scene)), pose_(opened) {
  const PoseChoice choice = choose_pose(scene, opened);
  clip_ = find_clip(clips_, choice.animations);
  time_s_ = choice.time_s;
  if (clip_ >= 0 && opened.loops) seek(time_s_);
}

void AnimationClock::advance(double now_s) {
  const double passed_s = std::exchange(is_starting_, false) ? 0.0 : std::max(now_s - last_s_, 0.0);
  last_s_ = now_s;
  if (is_playing_) seek(time_s_ + speed_ * passed_s);
}

void AnimationClock::toggle() {
  if (clips_.empty()) return;
  begin();
  is_playing_ = !is_playing_;
  is_starting_ = is_playing_;
}

void AnimationClock::step(int frames) {
  if (clips_.empty()) return;
  stop();
  begin();
  // The nearest frame comes first, so that steps have short times.
  seek((std::round(time_s_ * kStepsPerSecond) + frames) / kStepsPerSecond);
}

void AnimationClock::seek(double time_s) {
  const double duration = duration_s();
  if (!(duration > 0.0)) {
    time_s_ = 0.0;
  } else if (time_s < 0.0 || time_s > duration) {
    time_s_ = time_s - duration * std::floor(time_s / duration);
  } else {
    time_s_ = time_s;
  }
  put_pose();
}

void AnimationClock::choose(int clip) {
  clip_ = clip < static_cast<int>(clips_.size()) ? clip : -1;
  if (clip_ < 0) stop();
  time_s_ = 0.0;
  put_pose();
}

void AnimationClock::choose_next() {
  if (!clips_.empty()) choose((clip_ + 1) % static_cast<int>(clips_.size()));
}

void AnimationClock::set_speed(double speed) {
  speed_ = std::clamp(speed, kMinSpeed, kMaxSpeed);
}

void AnimationClock::begin() {
  if (clip_ < 0) choose(0);
}

void AnimationClock::put_pose() {
  pose_ = {};
  if (clip_ < 0) return;
  pose_.animations = {clips_[static_cast<size_t>(clip_)].word};
  pose_.time_s = time_s_;
}

}  // namespace promin::app
