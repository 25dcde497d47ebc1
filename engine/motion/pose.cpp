// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "motion/check_motion.h"
#include "motion/node_state.h"
#include "motion/sampler.h"
#include "promin/motion.h"

namespace promin {
namespace {

struct PropertyRow {
  AnimatedTarget target;
  uint32_t component_count;
  std::string_view name;
};

constexpr PropertyRow kProperties[] = {
#define PROMIN_ANIMATED(ENUMERATOR, TARGET, COMPONENTS, NAME) {AnimatedTarget::TARGET, COMPONENTS, NAME},
#include "promin/kinds/animated.def"
};

std::string title_of(const char* kind, size_t index, const std::string& name) {
  std::string title = std::string(kind).append(" ");
  if (name.empty()) return title.append(std::to_string(index));
  return title.append("\"").append(name).append("\"");
}

/// Returns the time at which an animation is shown.
double time_in(const Animation& animation, const PoseChoice& choice) {
  if (!choice.loops) return choice.time_s;
  if (!(animation.duration_s > 0.0)) return 0.0;
  const double time = std::fmod(choice.time_s, animation.duration_s);
  return time < 0.0 ? time + animation.duration_s : time;
}

/// Changes the state of nodes by animations.
class Evaluation {
 public:
  Evaluation(const Scene& scene, const PoseChoice& choice)
      : scene_(scene), motion_(*scene.motion), choice_(choice), nodes_(motion_.nodes) {}

  Pose evaluate() {
    std::vector<uint32_t> animations = choice_.animations;
    std::ranges::sort(animations);
    animations.erase(std::unique(animations.begin(), animations.end()), animations.end());
    for (const uint32_t animation : animations) apply(animation);
    for (Node& node : nodes_) copy_state(node);
    pose_.world_from_node = place_nodes(nodes_, scene_.center);
    pose_.is_visible.resize(nodes_.size());
    for (const uint32_t i : order_nodes(nodes_)) {
      const Node& node = nodes_[i];
      pose_.is_visible[i] = node.is_visible && (node.parent == kNoIndex || pose_.is_visible[node.parent]);
    }
    pose_.nodes = std::move(nodes_);
    return std::move(pose_);
  }

 private:
  void apply(uint32_t index) {
    const Animation& animation = motion_.animations[index];
    const double time_s = time_in(animation, choice_);
    for (const AnimationChannel& channel : animation.channels) {
      const auto [first, is_new] = owners_.try_emplace({channel.property, channel.target, channel.element}, index);
      if (is_new) {
        apply(animation.samplers[channel.sampler], channel, time_s);
      } else if (first->second != index) {
        warn_of_conflict(first->second, index);
      }
    }
  }

  void warn_of_conflict(uint32_t first, uint32_t second) {
    std::string sentence = title_of("animation", second, motion_.animations[second].name);
    sentence.append(" changes what ").append(title_of("animation", first, motion_.animations[first].name));
    sentence.append(" changes too; the latter counts there");
    if (std::ranges::find(pose_.warnings, sentence) == pose_.warnings.end()) {
      pose_.warnings.push_back(std::move(sentence));
    }
  }

  void apply(const AnimationSampler& sampler, const AnimationChannel& channel, double time_s) {
    if (channel.property == AnimatedProperty::kWeights) {
      const size_t numbers = sampler.times.size() * numbers_per_component(sampler.interpolation);
      std::vector<double>& weights = nodes_[channel.target].weights;
      weights.resize(sampler.values.size() / numbers);
      return sample(sampler, time_s, false, weights);
    }
    std::array<double, 4> numbers{};
    sample(sampler, time_s, channel.property == AnimatedProperty::kRotation,
           std::span(numbers).first(components_of(channel.property)));
    put({numbers[0], numbers[1], numbers[2], numbers[3]}, channel);
  }

  void put(const dvec4& value, const AnimationChannel& channel) {
    if (target_of(channel.property) != AnimatedTarget::kNode) {
      return pose_.values.push_back({channel.property, channel.target, value, channel.element});
    }
    Node& node = nodes_[channel.target];
    switch (channel.property) {
      case AnimatedProperty::kTranslation:
        node.trs.translation = dvec3(value);
        break;
      case AnimatedProperty::kRotation:
        node.trs.rotation = value;
        break;
      case AnimatedProperty::kScale:
        node.trs.scale = dvec3(value);
        break;
      case AnimatedProperty::kVisibility:
        node.is_visible = value.x != 0.0;
        break;
      default:
        if (channel.element < node.weights.size()) node.weights[channel.element] = value.x;
    }
  }

  void copy_state(Node& node) const {
    if (node.same_as == kNoIndex) return;
    const Node& original = nodes_[node.same_as];
    node.trs = original.trs;
    node.matrix = original.matrix;
    node.is_visible = original.is_visible;
    node.weights = original.weights;
  }

  const Scene& scene_;
  const Motion& motion_;
  const PoseChoice& choice_;
  std::vector<Node> nodes_;
  /// For each property, the animation that changes it.
  std::map<std::tuple<AnimatedProperty, uint32_t, uint32_t>, uint32_t> owners_;
  Pose pose_;
};

void check_choice(const Scene& scene, const PoseChoice& choice) {
  if (scene.motion == nullptr) {
    throw InputError({"motion.scene.none", "the scene has no nodes, so it has no poses", scene.file.string(),
                      "load it from a glTF file"});
  }
  if (const std::vector<Problem> problems = check_motion(scene); !problems.empty()) throw InputError(problems);
  if (!std::isfinite(choice.time_s)) {
    throw InputError({"motion.time.range", "the time of a pose is not finite", "", "give a number of seconds"});
  }
  const std::vector<Animation>& animations = scene.motion->animations;
  for (const uint32_t index : choice.animations) {
    if (index >= animations.size()) {
      throw InputError({"motion.animation.missing", "the scene has no animation " + std::to_string(index),
                        scene.file.string(), "use one of its " + std::to_string(animations.size()) + " animations"});
    }
    if (!animations[index].problems.empty()) throw InputError(animations[index].problems);
  }
}

}  // namespace

Pose pose_of(const Scene& scene, const PoseChoice& choice) {
  check_choice(scene, choice);
  return Evaluation(scene, choice).evaluate();
}

AnimatedTarget target_of(AnimatedProperty property) {
  return kProperties[static_cast<size_t>(property)].target;
}

uint32_t components_of(AnimatedProperty property) {
  return kProperties[static_cast<size_t>(property)].component_count;
}

std::string_view name_of(AnimatedProperty property) {
  return kProperties[static_cast<size_t>(property)].name;
}

}  // namespace promin
