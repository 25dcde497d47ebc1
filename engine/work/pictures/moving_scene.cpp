// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/moving_scene.h"

#include <utility>
#include <variant>

#include "motion/envelope.h"
#include "scene/features.h"
#include "scene/world_scene.h"
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
  // The last object may be a ground (ground.h), which no pose moves.
  if (lit_.objects.size() > envelope_.objects.size()) {
    ground_ = std::get<Plane>(lit_.geometries[lit_.objects.back().geometry]);
  }
  // Only its lights, materials and environment are used.
  lit_.geometries.clear();
  lit_.objects.clear();
  lights_off_ = lights_off;
  for (const double time_s : times_) features_ |= find_features(at(time_s));
}

Scene MovingScene::at(double time_s) const {
  PoseChoice choice = clip_;
  choice.time_s = time_s;
  Scene posed = scene_at(scene_, choice);
  for (size_t i = posed.lights.size(); i < lit_.lights.size(); ++i) posed.lights.push_back(lit_.lights[i]);
  switch_lights(posed.lights, lights_off_);
  posed.environment = lit_.environment;
  for (size_t i = 0; i < posed.materials.size(); ++i) {
    auto* phong = std::get_if<Phong>(&posed.materials[i].model);
    const auto* lit = std::get_if<Phong>(&lit_.materials[i].model);
    if (phong != nullptr && lit != nullptr) phong->ambient = lit->ambient;
  }
  if (ground_) {
    posed.materials.push_back(lit_.materials.back());
    posed.add(lit_.materials.back().name, *ground_, static_cast<uint32_t>(posed.materials.size() - 1));
  }
  return posed;
}

}  // namespace promin::work
