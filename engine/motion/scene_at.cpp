// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "core/rounding.h"
#include "motion/attach.h"
#include "motion/deform.h"
#include "motion/factors.h"
#include "motion/node_state.h"
#include "motion/place_mesh.h"
#include "motion/skin.h"
#include "promin/motion.h"
#include "scene/limits.h"

namespace promin {
namespace {

class ScenePose {
 public:
  ScenePose(Scene scene, const PoseChoice& choice)
      : scene_(std::move(scene)), motion_(*scene_.motion), pose_(pose_of(scene_, choice)) {
    for (const Animation& animation : motion_.animations) {
      for (const AnimationChannel& channel : animation.channels) {
        animated_.emplace(target_of(channel.property), channel.target);
        if (channel.property == AnimatedProperty::kVisibility) hides_.insert(channel.target);
      }
    }
  }

  Scene take() {
    find_free_geometries();
    for (size_t i = 0; i < motion_.objects.size(); ++i) place_object(motion_.objects[i], scene_.objects[i]);
    remove_free_geometries();
    reset_records();
    for (size_t i = 0; i < std::min(motion_.lights.size(), scene_.lights.size()); ++i) place_light(i);
    for (size_t i = 0; i < std::min(motion_.cameras.size(), scene_.cameras.size()); ++i) place_camera(i);
    apply_values(pose_.values, scene_);
    for (std::string& warning : pose_.warnings) scene_.warnings.push_back(std::move(warning));
    return std::move(scene_);
  }

 private:
  // Geometries that an earlier pose has made are free. New ones take their places.

  void find_free_geometries() {
    std::vector<bool> is_kept(scene_.geometries.size(), false);
    const auto keep = [&](uint32_t geometry) {
      if (geometry < is_kept.size()) is_kept[geometry] = true;
    };
    for (const ObjectLink& link : motion_.objects) {
      keep(link.geometry);
      keep(link.fallback);
    }
    for (size_t i = 0; i < scene_.objects.size(); ++i) {
      if (i >= motion_.objects.size() || motion_.objects[i].node == kNoIndex) keep(scene_.objects[i].geometry);
    }
    for (uint32_t i = 0; i < is_kept.size(); ++i) {
      if (!is_kept[i]) free_.insert(i);
    }
  }

  uint32_t add(Mesh mesh) {
    if (free_.empty()) {
      scene_.geometries.emplace_back(std::move(mesh));
      return static_cast<uint32_t>(scene_.geometries.size() - 1);
    }
    const uint32_t place = *free_.begin();
    free_.erase(free_.begin());
    scene_.geometries[place] = std::move(mesh);
    return place;
  }

  void remove_free_geometries() {
    for (const uint32_t place : free_) scene_.geometries[place] = Mesh{};
    while (!scene_.geometries.empty() && free_.contains(static_cast<uint32_t>(scene_.geometries.size() - 1))) {
      scene_.geometries.pop_back();
    }
  }

  const PosedSkin& find_skin(uint32_t skin) {
    const auto [known, is_new] = skins_.try_emplace(skin);
    if (is_new) known->second = pose_skin(motion_.skins[skin], pose_.world_from_node);
    return known->second;
  }

  void place_object(const ObjectLink& link, Object& object) {
    if (link.node == kNoIndex) return;
    object.geometry = Object::kNoGeometry;
    if (!pose_.is_visible[link.node]) return;
    const bool is_skinned = link.skin != kNoIndex;
    const bool is_hidden = is_skinned && find_skin(link.skin).is_hidden;
    dmat4 world = is_skinned ? find_skin(link.skin).world_from_mesh : pose_.world_from_node[link.node];
    if (!is_skinned && link.place != kNoIndex) world = world * motion_.places[link.place];
    if (is_hidden || has_no_area(world)) return;
    check_is_finite(link, world);
    if (link.mesh != kNoIndex) {
      object.geometry = find_deformed(link);
    } else if (link.geometry != kNoIndex) {
      object.geometry = choose_form(link, world);
    }
    if (object.geometry != Object::kNoGeometry) put(link, world, object);
  }

  void check_is_finite(const ObjectLink& link, const dmat4& world) {
    bool is_right = is_finite(world);
    if (link.skin != kNoIndex) {
      is_right = is_right && std::ranges::all_of(find_skin(link.skin).joint_matrices,
                                                 [](const dmat4& matrix) { return is_finite(matrix); });
    }
    if (is_right) return;
    throw InputError({"motion.node.far", "a node's position in the world is too large for floating-point numbers",
                      "motion.nodes[" + std::to_string(link.node) + "]", "use another time or animation"});
  }

  /// Returns the geometry in its own form, or its fallback if the transform distorts it.
  uint32_t choose_form(const ObjectLink& link, const dmat4& world) {
    if (keeps_form(scene_.geometries[link.geometry], world)) return link.geometry;
    std::string sentence =
        "motion.nodes[" + std::to_string(link.node) + "]: its transform distorts an analytic shape; ";
    sentence.append(link.fallback == kNoIndex ? "promin does not draw the shape"
                                              : "promin draws the mesh of the shape");
    pose_.warnings.push_back(std::move(sentence));
    return link.fallback;
  }

  uint32_t find_deformed(const ObjectLink& link) {
    const std::vector<double>& weights = pose_.nodes[link.node].weights;
    const auto [known, is_new] = deformed_.try_emplace({link.mesh, link.skin, weights}, Object::kNoGeometry);
    if (!is_new) return known->second;
    const std::span<const dmat4> joints =
        link.skin == kNoIndex ? std::span<const dmat4>{} : std::span(find_skin(link.skin).joint_matrices);
    Mesh mesh = deform(*motion_.meshes[link.mesh], weights, joints);
    if (!std::ranges::all_of(mesh.positions, [](const vec3& p) { return is_in_range(dvec3(p)); }))
      refuse_far_vertex(link);
    drop_vanished_normals(mesh);
    return known->second = add(std::move(mesh));
  }

  [[noreturn]] static void refuse_far_vertex(const ObjectLink& link) {
    throw InputError({"motion.position.far", "a vertex lies beyond 1e15 in the world",
                      "motion.nodes[" + std::to_string(link.node) + "]", "use another time or animation"});
  }

  void put(const ObjectLink& link, const dmat4& world, Object& object) {
    object.world_from_object = world;
    const auto* mesh = std::get_if<Mesh>(&scene_.geometries[object.geometry]);
    if (mesh == nullptr) return;
    const auto [box, is_new] = boxes_.try_emplace(object.geometry);
    if (is_new) box->second = bounds_of_positions(*mesh);
    if (!is_mesh_in_range(*mesh, box->second, world)) refuse_far_vertex(link);
    if (!is_singular(world)) return;
    bool has_lost_normals = false;
    Mesh flat = apply_transform(*mesh, world, has_lost_normals);
    object.geometry = add(std::move(flat));
    object.world_from_object = dmat4(1.0);
  }

  bool is_animated(AnimatedTarget target, uint32_t index) const { return animated_.contains({target, index}); }

  /// Undoes the changes that an earlier pose has made to records.
  void reset_records() {
    for (const MaterialLink& link : motion_.materials) {
      if (is_animated(AnimatedTarget::kMaterial, link.material)) scene_.materials[link.material] = link.rest;
    }
    for (size_t i = 0; i < std::min(motion_.lights.size(), scene_.lights.size()); ++i) {
      const LightLink& link = motion_.lights[i];
      if (is_animated(AnimatedTarget::kLight, link.definition)) scene_.lights[i] = link.rest;
      if (may_be_hidden(link.node)) scene_.lights[i].is_on = pose_.is_visible[link.node];
    }
    for (size_t i = 0; i < std::min(motion_.cameras.size(), scene_.cameras.size()); ++i) {
      const CameraLink& link = motion_.cameras[i];
      if (is_animated(AnimatedTarget::kCamera, link.definition)) scene_.cameras[i] = link.rest;
    }
  }

  bool may_be_hidden(uint32_t node) const {
    for (; node != kNoIndex; node = motion_.nodes[node].parent) {
      const uint32_t original = motion_.nodes[node].same_as;
      if (hides_.contains(original == kNoIndex ? node : original)) return true;
    }
    return false;
  }

  template <class Record>
  void place_record(uint32_t node, Record& record, const char* what) {
    if (node == kNoIndex) return;
    const Attached result = attach(pose_.world_from_node[node], rotation_of(pose_.nodes, node), record);
    if (result == Attached::kDone) return;
    pose_.warnings.push_back("motion.nodes[" + std::to_string(node) + "]: " + what +
                             (result == Attached::kFar ? " lies beyond 1e15 in the world" : " has no direction") +
                             "; it stays where it was");
  }

  void place_light(size_t i) { place_record(motion_.lights[i].node, scene_.lights[i], "a light"); }
  void place_camera(size_t i) { place_record(motion_.cameras[i].node, scene_.cameras[i], "a camera"); }

  Scene scene_;
  /// The scene's motion, which its shared pointer keeps.
  const Motion& motion_;
  Pose pose_;
  /// The targets that an animation of the scene changes.
  std::set<std::pair<AnimatedTarget, uint32_t>> animated_;
  /// The nodes whose visibility an animation changes.
  std::set<uint32_t> hides_;
  std::set<uint32_t> free_;
  std::map<uint32_t, PosedSkin> skins_;
  /// The bounds of the positions of each geometry that an object shows.
  std::map<uint32_t, Bounds> boxes_;
  /// Geometries by mesh, skin and weights.
  std::map<std::tuple<uint32_t, uint32_t, std::vector<double>>, uint32_t> deformed_;
};

}  // namespace

Scene scene_at(Scene scene, const PoseChoice& choice) {
  if (scene.motion == nullptr && choice.animations.empty()) return scene;
  return ScenePose(std::move(scene), choice).take();
}

}  // namespace promin
