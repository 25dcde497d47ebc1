// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/renderer.h"
#include "scene/world_scene.h"

/// Scenes and views that tests of sampled light share.
namespace promin::test {

inline Material make_clay(const vec3& color) {
  Phong phong;
  phong.ambient = phong.diffuse = color;
  return {.name = "", .model = phong};
}

inline Material make_physical(const vec3& color, float metallic, float roughness) {
  MetallicRoughness model;
  model.base_color = color;
  model.metallic = metallic;
  model.roughness = roughness;
  return {.name = "", .model = model};
}

/// A floor with balls of several materials: clay, a mirror, rough metal, and a coat. The floor is a rough dielectric.
inline world::Scene make_lit_balls() {
  world::Scene scene;
  Material mirror = make_clay(vec3(0.1F));
  std::get<Phong>(mirror.model).reflection = vec3(0.7F);
  Material coated = make_physical(vec3(0.2F, 0.3F, 0.7F), 0.0F, 0.8F);
  auto& coat = std::get<MetallicRoughness>(coated.model);
  coat.clearcoat = 1.0F;
  coat.clearcoat_roughness = 0.25F;
  Material cloth = make_physical(vec3(0.4F, 0.1F, 0.1F), 0.0F, 0.9F);
  auto& sheen = std::get<MetallicRoughness>(cloth.model);
  sheen.sheen_color = vec3(0.6F, 0.5F, 0.9F);
  sheen.sheen_roughness = 0.4F;
  Material leaf = make_physical(vec3(0.3F, 0.6F, 0.2F), 0.0F, 0.6F);
  auto& through = std::get<MetallicRoughness>(leaf.model);
  through.diffuse_transmission = 0.5F;
  through.diffuse_transmission_color = vec3(0.5F, 0.9F, 0.2F);
  scene.materials = {make_physical(vec3(0.8F, 0.7F, 0.6F), 0.0F, 0.5F),
                     make_clay(vec3(0.3F, 0.5F, 0.8F)),
                     mirror,
                     make_physical(vec3(0.9F, 0.7F, 0.4F), 1.0F, 0.3F),
                     coated,
                     cloth,
                     leaf};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  for (uint32_t i = 0; i < 6; ++i) {
    const vec3 center(-1.4F + 1.4F * static_cast<float>(i % 3), 0.4F, i < 3 ? 0.3F : -0.9F);
    scene.objects.push_back({"ball", world::Sphere{center, 0.4F + 0.03F * static_cast<float>(i)}, i + 1});
  }
  return scene;
}

inline View make_direct_view(uvec2 size = uvec2(32, 24)) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0.0F, 2.2F, 4.0F);
  view.camera.look = glm::normalize(vec3(0.0F, -0.48F, -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.max_depth = 2;
  view.mode.integrator = Integrator::kDirect;
  return view;
}

/// Returns a view that sees one point of the plane y = 0.
inline View make_point_view(const vec3& point, float height = 0.2F) {
  View view = make_direct_view(uvec2(8));
  view.camera.eye = point + vec3(0.0F, height, 0.0F);
  view.camera.look = vec3(0, -1, 0);
  view.camera.up = vec3(0, 0, -1);
  view.camera.yfov = 0.002F;
  view.samples_per_pixel = 256;
  return view;
}

inline world::Scene make_open_floor(const vec3& albedo = vec3(1.0F)) {
  world::Scene scene;
  scene.materials = {make_clay(albedo)};
  scene.objects = {{"floor", world::Plane{vec3(0.0F), vec3(0, 1, 0)}, 0}};
  return scene;
}

}  // namespace promin::test
