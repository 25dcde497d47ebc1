// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/envelope.h"

#include <algorithm>
#include <set>
#include <utility>

#include "scene/placed_bounds.h"

namespace promin {
namespace {

/// Adds a box to a mesh.
void add_box(const Bounds& box, Mesh& mesh) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (int corner = 0; corner < 8; ++corner) {
    mesh.positions.emplace_back((corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                                (corner & 4) != 0 ? box.hi.z : box.lo.z);
  }
  constexpr uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.emplace_back(first + face[0], first + face[1], first + face[2]);
    mesh.triangles.emplace_back(first + face[0], first + face[2], first + face[3]);
  }
}

/// Returns whether an object has the same place and form in two poses of a scene.
bool is_same(const Scene& first, const Scene& other, size_t object) {
  const Object& a = first.objects[object];
  const Object& b = other.objects[object];
  const bool is_deformed = object < first.motion->objects.size() && first.motion->objects[object].mesh != kNoIndex;
  return !is_deformed && a.geometry == b.geometry && a.world_from_object == b.world_from_object;
}

}  // namespace

double duration_of(const Motion& motion, const std::vector<uint32_t>& animations) {
  double duration_s = 0.0;
  for (const uint32_t animation : animations)
    duration_s = std::max(duration_s, motion.animations[animation].duration_s);
  return duration_s;
}

std::vector<double> sample_times(const Motion& motion, const std::vector<uint32_t>& animations, size_t most) {
  const double duration_s = duration_of(motion, animations);
  std::set<double> keys = {0.0, duration_s};
  for (const uint32_t animation : animations) {
    for (const AnimationSampler& sampler : motion.animations[animation].samplers) {
      keys.insert(sampler.times.begin(), sampler.times.end());
    }
  }
  if (keys.size() <= most) return {keys.begin(), keys.end()};
  std::vector<double> times;
  for (size_t i = 0; i < most; ++i) {
    times.push_back(duration_s * static_cast<double>(i) / static_cast<double>(most - 1));
  }
  return times;
}

Scene envelope_of(const Scene& scene, const std::vector<uint32_t>& animations, const std::vector<double>& times) {
  Scene envelope = scene_at(scene, {.animations = animations, .time_s = times.front()});
  std::vector<Mesh> boxes(envelope.objects.size());
  std::vector<bool> is_moved(envelope.objects.size(), false);
  for (const double time_s : times) {
    const Scene posed = scene_at(scene, {.animations = animations, .time_s = time_s});
    const std::vector<Bounds> bounds = bounds_of_objects(posed);
    for (size_t i = 0; i < posed.objects.size(); ++i) {
      if (!is_same(envelope, posed, i)) is_moved[i] = true;
      if (!bounds[i].is_empty()) add_box(bounds[i], boxes[i]);
    }
  }
  for (size_t i = 0; i < boxes.size(); ++i) {
    if (!is_moved[i] || boxes[i].triangles.empty()) continue;
    envelope.objects[i].geometry = static_cast<uint32_t>(envelope.geometries.size());
    envelope.objects[i].world_from_object = dmat4(1.0);
    envelope.geometries.emplace_back(std::move(boxes[i]));
  }
  // The envelope has no poses of its own.
  envelope.motion = nullptr;
  return envelope;
}

}  // namespace promin
