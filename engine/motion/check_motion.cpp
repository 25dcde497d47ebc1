// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/check_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "motion/sampler.h"

namespace promin {
namespace {

class MotionCheck {
 public:
  explicit MotionCheck(const Scene& scene) : scene_(scene), motion_(*scene.motion) {}

  std::vector<Problem> find() {
    check_nodes();
    check_skins();
    for (size_t i = 0; i < motion_.meshes.size(); ++i) check_mesh(i);
    for (size_t i = 0; i < motion_.animations.size(); ++i) check_animation(i);
    for (size_t i = 0; i < motion_.objects.size(); ++i) check_object(i);
    check_links();
    return std::move(problems_);
  }

 private:
  using Place = std::string;

  static Place at(const char* array, size_t index) {
    return std::string("motion.") + array + "[" + std::to_string(index) + "]";
  }

  void refuse(ProblemCode code, const char* what, const Place& place, const char* cure) {
    problems_.push_back({code, what, place, cure});
  }

  void check_index(uint32_t index, size_t count, const Place& place, bool may_be_missing = true) {
    if (index < count || (may_be_missing && index == kNoIndex)) return;
    refuse("motion.reference.range", "an index is out of range", place, "use one that exists");
  }

  void check_count(bool is_right, const Place& place) {
    if (is_right) return;
    refuse("motion.count.wrong", "a list does not have the number of elements that it needs", place,
           "give one element for each key, joint or vertex");
  }

  void check_nodes() {
    const std::vector<Node>& nodes = motion_.nodes;
    for (size_t i = 0; i < nodes.size(); ++i) {
      check_index(nodes[i].parent, nodes.size(), at("nodes", i) + ".parent");
      check_index(nodes[i].same_as, nodes.size(), at("nodes", i) + ".same_as");
      const bool is_copy_of_copy = nodes[i].same_as < nodes.size() && nodes[nodes[i].same_as].same_as != kNoIndex;
      if (is_copy_of_copy) {
        refuse("motion.reference.range", "a node has the state of a node that has no state of its own",
               at("nodes", i) + ".same_as", "refer to the other node directly");
      }
    }
    if (problems_.empty()) check_cycles();
  }

  /// Follows the parents of each node. A node is finished if no cycle lies above it.
  void check_cycles() {
    const std::vector<Node>& nodes = motion_.nodes;
    enum class State : uint8_t { kNew, kFollowed, kFinished };
    std::vector<State> states(nodes.size(), State::kNew);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
      uint32_t node = i;
      while (node != kNoIndex && states[node] == State::kNew) {
        states[node] = State::kFollowed;
        node = nodes[node].parent;
      }
      if (node != kNoIndex && states[node] == State::kFollowed) {
        return refuse("motion.node.cycle", "a node is its own ancestor", at("nodes", node) + ".parent",
                      "remove the link that closes the cycle");
      }
      for (node = i; node != kNoIndex && states[node] == State::kFollowed; node = nodes[node].parent) {
        states[node] = State::kFinished;
      }
    }
  }

  void check_skins() {
    for (size_t i = 0; i < motion_.skins.size(); ++i) {
      const Skin& skin = motion_.skins[i];
      for (const uint32_t joint : skin.joints) check_index(joint, motion_.nodes.size(), at("skins", i), false);
      check_count(skin.inverse_bind.empty() || skin.inverse_bind.size() == skin.joints.size(), at("skins", i));
    }
  }

  void check_mesh(size_t index) {
    const Place place = at("meshes", index);
    if (motion_.meshes[index] == nullptr) {
      return refuse("motion.reference.range", "a mesh is missing", place, "use one that exists");
    }
    const DeformingMesh& mesh = *motion_.meshes[index];
    const size_t vertex_count = mesh.base.positions.size();
    const auto fits = [&](const auto& list) { return list.empty() || list.size() == vertex_count; };
    check_count(fits(mesh.base.normals) && fits(mesh.base.tangents) && fits(mesh.base.uvs) && fits(mesh.base.colors),
                place);
    for (const MorphTarget& target : mesh.targets) {
      check_count(fits(target.positions) && fits(target.normals) && fits(target.tangents) && fits(target.uvs) &&
                      fits(target.colors),
                  place);
    }
    const SkinInfluences& influences = mesh.influences;
    const size_t influence_count = influences.per_vertex * vertex_count;
    check_count(influences.joints.size() == influence_count && influences.weights.size() == influence_count, place);
  }

  size_t count_of(AnimatedTarget target) const {
    if (target == AnimatedTarget::kNode) return motion_.nodes.size();
    // Numbers of definitions of lights and cameras need not be consecutive.
    return target == AnimatedTarget::kMaterial ? scene_.materials.size() : kNoIndex;
  }

  void check_animation(size_t index) {
    const Animation& animation = motion_.animations[index];
    const Place place = at("animations", index);
    for (const AnimationSampler& sampler : animation.samplers) check_keys(sampler, place);
    for (const AnimationChannel& channel : animation.channels) {
      check_index(channel.sampler, animation.samplers.size(), place + ".channels", false);
      check_index(channel.target, count_of(target_of(channel.property)), place + ".channels", false);
      if (channel.sampler >= animation.samplers.size()) continue;
      const AnimationSampler& sampler = animation.samplers[channel.sampler];
      const size_t numbers = sampler.times.size() * numbers_per_component(sampler.interpolation);
      const size_t components = components_of(channel.property);
      check_count(components > 0 ? sampler.values.size() == components * numbers
                                 : numbers > 0 && sampler.values.size() % numbers == 0,
                  place + ".channels");
    }
  }

  void check_keys(const AnimationSampler& sampler, const Place& place) {
    const auto is_wrong = [](double before, double after) { return !(before < after); };
    const bool is_finite = std::ranges::all_of(sampler.times, [](double time) { return std::isfinite(time); });
    const bool is_ascending = std::ranges::adjacent_find(sampler.times, is_wrong) == sampler.times.end();
    if (!sampler.times.empty() && is_finite && is_ascending) return;
    refuse("motion.keys.order", "the times of keys are missing, not finite or not ascending", place + ".samplers",
           "give at least one key, and each key a later time than the key before it");
  }

  void check_object(size_t index) {
    const ObjectLink& link = motion_.objects[index];
    const Place place = at("objects", index);
    check_index(link.node, motion_.nodes.size(), place + ".node");
    check_index(link.geometry, scene_.geometries.size(), place + ".geometry");
    check_index(link.fallback, scene_.geometries.size(), place + ".fallback");
    check_index(link.mesh, motion_.meshes.size(), place + ".mesh");
    check_index(link.skin, motion_.skins.size(), place + ".skin");
    check_index(link.place, motion_.places.size(), place + ".place");
    const bool is_skinned = link.skin < motion_.skins.size() && link.mesh < motion_.meshes.size();
    if (is_skinned && problems_.empty()) check_joints(link, place);
  }

  void check_joints(const ObjectLink& link, const Place& place) {
    const SkinInfluences& influences = motion_.meshes[link.mesh]->influences;
    const size_t joint_count = motion_.skins[link.skin].joints.size();
    for (size_t i = 0; i < influences.joints.size(); ++i) {
      if (influences.weights[i] == 0.0F || influences.joints[i] < joint_count) continue;
      return refuse("motion.reference.range", "a vertex has a joint that its skin does not have", place + ".skin",
                    "use one that exists");
    }
  }

  void check_links() {
    check_count(motion_.objects.size() <= scene_.objects.size(), "motion.objects");
    for (size_t i = 0; i < motion_.lights.size(); ++i) {
      check_index(motion_.lights[i].node, motion_.nodes.size(), at("lights", i) + ".node");
    }
    for (size_t i = 0; i < motion_.materials.size(); ++i) {
      check_index(motion_.materials[i].material, scene_.materials.size(), at("materials", i), false);
    }
    for (size_t i = 0; i < motion_.cameras.size(); ++i) {
      check_index(motion_.cameras[i].node, motion_.nodes.size(), at("cameras", i) + ".node");
    }
  }

  const Scene& scene_;
  const Motion& motion_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> check_motion(const Scene& scene) {
  return MotionCheck(scene).find();
}

}  // namespace promin
