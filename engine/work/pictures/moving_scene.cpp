// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/moving_scene.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "motion/envelope.h"
#include "scene/features.h"
#include "scene/glow.h"
#include "scene/layers.h"
#include "scene/world_scene.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"

namespace promin::work {
namespace {

/// Returns a mesh that has the same features as another, but only two triangles.
Mesh make_sample(const Mesh& mesh) {
  Mesh sample;
  sample.positions.resize(4);
  sample.positions[1].x = sample.positions[2].y = sample.positions[3].z = 1.0F;
  if (!mesh.normals.empty()) sample.normals.assign(4, vec3(0.0F, 0.0F, 1.0F));
  if (!mesh.colors.empty()) sample.colors.resize(4);
  if (!mesh.uvs.empty()) sample.uvs.resize(4);
  if (!mesh.triangles.empty()) sample.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (!mesh.triangle_materials.empty()) sample.triangle_materials = {mesh.triangle_materials[0], 0};
  return sample;
}

/// Returns the features of pictures of a scene, without the cost of its triangles.
FeatureMask find_features(Scene scene) {
  for (Geometry& geometry : scene.geometries) {
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
      // A mesh with several materials is kept, because any of them may be visible.
      if (mesh->triangle_materials.empty()) geometry = make_sample(*mesh);
    }
  }
  return features_of(world::flatten(scene, world::Purpose::kHits));
}

}  // namespace

MovingScene::MovingScene(Scene scene, PoseChoice clip)
    : scene_(std::move(scene)),
      clip_(std::move(clip)),
      duration_s_(duration_of(*scene_.motion, clip_.animations)),
      times_(sample_times(*scene_.motion, clip_.animations, kMostSampledPoses)),
      envelope_(envelope_of(scene_, clip_.animations, times_)) {}

void MovingScene::take_light(const Scene& lit_envelope, const std::vector<uint32_t>& lights_off) {
  lit_ = lit_envelope;
  ground_ = find_ground(lit_, envelope_.objects.size());
  // Only its lights, materials and environment are used.
  lit_.geometries.clear();
  lit_.objects.clear();
  lights_off_ = lights_off;
  for (const double time_s : times_) features_ |= find_features(at(time_s));
}

bool MovingScene::may_emit() const {
  const auto moves_emission = [](const AnimationChannel& channel) {
    return channel.property == AnimatedProperty::kEmissive || channel.property == AnimatedProperty::kEmissiveStrength;
  };
  return std::ranges::any_of(scene_.materials, emits_light) ||
         std::ranges::any_of(clip_.animations, [&](uint32_t animation) {
           return std::ranges::any_of(scene_.motion->animations[animation].channels, moves_emission);
         });
}

Scene MovingScene::pose(double time_s) const {
  return scene_at(scene_, {.animations = clip_.animations, .time_s = time_s});
}

bool MovingScene::lights_itself() const {
  return may_emit() && std::ranges::any_of(times_, [&](double time_s) { return work::lights_itself(pose(time_s)); });
}

Scene MovingScene::brightest() const {
  Scene best = pose(times_.front());
  if (!may_emit()) return best;
  double largest = 0.0;
  for (const double time_s : times_) {
    Scene posed = pose(time_s);
    const std::optional<Glow> glow = find_glow(posed);
    if (!glow || glow->flux <= largest) continue;
    largest = glow->flux;
    best = std::move(posed);
  }
  return best;
}

Scene MovingScene::at(double time_s) const {
  PoseChoice choice = clip_;
  choice.time_s = time_s;
  Scene posed = with_light_of(scene_at(scene_, choice), lit_, ground_);
  switch_lights(posed.lights, lights_off_);
  return posed;
}

std::optional<Plane> find_ground(const Scene& lit, size_t own_objects) {
  if (lit.objects.size() <= own_objects) return std::nullopt;
  // No pose moves it.
  return std::get<Plane>(lit.geometries[lit.objects.back().geometry]);
}

Scene with_light_of(Scene posed, const Scene& lit, const std::optional<Plane>& ground) {
  for (size_t i = posed.lights.size(); i < lit.lights.size(); ++i) posed.lights.push_back(lit.lights[i]);
  posed.environment = lit.environment;
  for (size_t i = 0; i < posed.materials.size(); ++i) {
    auto* phong = std::get_if<Phong>(&posed.materials[i].model);
    const auto* phong_lit = std::get_if<Phong>(&lit.materials[i].model);
    if (phong != nullptr && phong_lit != nullptr) phong->ambient = phong_lit->ambient;
  }
  if (ground) {
    posed.materials.push_back(lit.materials.back());
    posed.add(lit.materials.back().name, *ground, static_cast<uint32_t>(posed.materials.size() - 1));
  }
  return posed;
}

}  // namespace promin::work
