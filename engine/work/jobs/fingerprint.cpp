// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/fingerprint.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "jobs/sha256.h"
#include "promin/caster.h"
#include "promin/device_info.h"
#include "promin/renderer.h"
#include "promin/scene.h"

namespace promin::work {
namespace {

constexpr size_t kRays = 4096;
constexpr uvec2 kSize{48, 32};

/// Returns the number with this index in a fixed sequence: a number in -1...1 with 24 bits, computed exactly so that
/// all processors agree.
float number_at(uint32_t place) {
  uint32_t bits = place * 0x9E3779B9U;
  bits = (bits ^ (bits >> 16)) * 0x85EBCA6BU;
  bits ^= bits >> 13;
  return static_cast<float>(static_cast<int32_t>(bits >> 8) - (1 << 23)) * 0x1p-23F;
}

Scene make_scene() {
  Scene scene;
  Phong mirror{.specular = vec3(0.5F), .shininess = 20.0F, .reflection = vec3(0.5F)};
  Phong glass{
      .diffuse = vec3(0.1F), .reflection = vec3(1.0F), .transmission = vec3(0.9F), .ior = 1.5F, .fresnel = true};
  MetallicRoughness metal{.base_color = vec3(0.9F, 0.6F, 0.3F), .roughness = 0.375F};
  scene.materials.resize(4);
  scene.materials[1].model = mirror;
  scene.materials[2].model = glass;
  scene.materials[3].model = metal;
  Mesh floor;
  floor.positions = {{-4, -1, -4}, {4, -1.125F, -4}, {4.25F, -1, 4}, {-4, -0.875F, 4}};
  floor.triangles = {{0, 2, 1}, {0, 3, 2}};
  scene.add("floor", floor);
  scene.add("plane", Plane{{0, 0, -5}, {0, 0, 1}});
  scene.add("sphere", Sphere{{-1.25, 0.25, 0}, 0.75});
  scene.add("ball", Sphere{{0.375, -0.25, 1.5}, 0.5}, 1);
  scene.add("cylinder", Cylinder{{1.5, 0, 0.25}, {0, 1, 0}, 0.75, 0.375});
  scene.add("cone", Cone{{0, 0.5, -1}, {0, 1, 0}, 0.75, 0.5, 0.125}, 1);
  scene.add("box", Box{{-2.5, -0.5, 1}, {0.375, 0.5, 0.25}});
  scene.add("capsule", Capsule{{2.5, 0, -1}, {0, 1, 0}, 0.5, 0.375, 0.25});
  Light light;
  light.position = {3, 5, 4};
  scene.lights.push_back(light);
  scene.environment.ambient = vec3(0.125F);
  return scene;
}

/// Returns rays that start around the scene and run into it.
std::vector<Ray> make_rays() {
  std::vector<Ray> rays(kRays);
  for (uint32_t i = 0; i < kRays; ++i) {
    const auto point_at = [&](uint32_t place) {
      return vec3(number_at(6 * i + place), number_at(6 * i + place + 1), number_at(6 * i + place + 2));
    };
    rays[i].origin = 4.0F * point_at(0);
    rays[i].direction = 2.0F * point_at(3) - rays[i].origin;
  }
  return rays;
}

}  // namespace

std::string driver_of(const gpu::DeviceInfo& device) {
  return fmt::format("{}, {}", device.name, device.driver);
}

std::string fingerprint_of(const gpu::Device& device) {
  const gpu::DeviceInfo& info = gpu::info_of(device);
  const Scene scene = make_scene();
  const std::vector<Ray> rays = make_rays();
  std::vector<Hit> hits(rays.size());
  Caster(device, scene).cast(rays, hits);
  View view;
  view.size = kSize;
  view.camera.eye = {0, 0, 6};
  RendererOptions options;
  options.expected_samples = uint64_t{kSize.x} * kSize.y;
  const RenderResult picture = Renderer(device, scene, options).render(view);
  return jobs::Sha256()
      .add(info.name + "\n" + info.driver + "\n")
      .add(std::as_bytes(std::span(hits)))
      .add(std::as_bytes(std::span(picture.image.pixels)))
      .finish();
}

}  // namespace promin::work
