// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/scene.h"

namespace promin {

/// Returns a scene with one element of each kind: a mesh with all optional data, each shape, a material of each model,
/// a spot light, a camera.
inline Scene make_valid_scene() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 2}};
  mesh.colors = {vec4(1), vec4(1), vec4(1)};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_materials = {0};
  Scene scene;
  scene.materials.resize(3);
  scene.materials[1].model = MetallicRoughness();
  scene.materials[2].model = Unlit();
  scene.add("mesh", mesh);
  scene.add("sphere", Sphere{});
  scene.add("plane", Plane{});
  scene.add("cylinder", Cylinder{});
  scene.add("cone", Cone{});
  scene.objects.push_back({.name = "hidden"});
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::kSpot;
  scene.cameras.resize(1);
  return scene;
}

}  // namespace promin
