// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "measure/random.h"
#include "scene/world_scene.h"

namespace promin::test {

/// Returns the same scene with every mesh as an instance. Each has another turn and scale, and every second one is
/// mirrored.
inline world::Scene with_instances(world::Scene scene) {
  measure::Random random(3);
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.objects[i].shape);
    if (mesh == nullptr || mesh->triangles.empty()) continue;
    Bounds box;
    for (const vec3& p : mesh->positions) box.extend(p);
    dmat4 map = glm::mat4_cast(glm::angleAxis(random.uniform(-3.0, 3.0), random.direction()));
    for (int axis = 0; axis < 3; ++axis) map[axis] *= random.uniform(0.5, 3.0);
    if (i % 2 == 0) map[1] *= -1.0;
    map[3] = dvec4(dvec3(box.center()), 1.0);
    scene.meshes.push_back(world::place(*mesh, glm::inverse(map)));
    scene.instances.push_back({i, static_cast<uint32_t>(scene.meshes.size() - 1), world::map_of(map)});
    scene.objects[i].shape = world::NotDrawn{};
  }
  return scene;
}

}  // namespace promin::test
