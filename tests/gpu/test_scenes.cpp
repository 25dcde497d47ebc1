// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "gpu/test_scenes.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

namespace promin::test {
namespace {

Material make_material(const vec3& color, float specular, float shininess, float reflection) {
  Material material;
  material.phong().ambient = material.phong().diffuse = color;
  material.phong().specular = vec3(specular);
  material.phong().shininess = shininess;
  material.phong().reflection = vec3(reflection);
  return material;
}

Material make_metallic_roughness(const vec3& color, float metallic, float roughness) {
  MetallicRoughness model;
  model.base_color = color;
  model.metallic = metallic;
  model.roughness = roughness;
  Material material;
  material.model = model;
  return material;
}

/// Returns a coarse octahedron that looks round because of its vertex normals, with a colour for each vertex.
Mesh make_smooth_mesh(const vec3& center, float radius) {
  Mesh mesh;
  for (const vec3& n : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)}) {
    mesh.positions.push_back(center + radius * n);
    mesh.normals.push_back(n);
    mesh.colors.emplace_back(0.5F * n + 0.5F, 1.0F);
  }
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

}  // namespace

world::Scene make_scene_of_everything(uint32_t sphere_count) {
  world::Scene scene;
  scene.file = "everything";
  scene.environment.ambient = vec3(0.1F);
  scene.environment.background = vec3(0.3F, 0.5F, 0.8F);
  scene.materials = {make_material(vec3(0.7F), 0.0F, 0.0F, 0.1F),
                     make_material(vec3(0.2F, 0.4F, 0.6F), 0.5F, 60, 0.6F),
                     make_material(vec3(0.8F, 0.3F, 0.2F), 0.3F, 20, 0.0F),
                     make_material(vec3(0.3F, 0.7F, 0.2F), 0.8F, 200, 0.2F),
                     make_metallic_roughness(vec3(0.8F, 0.2F, 0.1F), 0.0F, 0.5F),
                     make_metallic_roughness(vec3(0.9F, 0.7F, 0.3F), 1.0F, 0.2F),
                     Material()};
  scene.materials[3].emissive = vec3(0.05F, 0.0F, 0.0F);
  scene.materials[6].model = Unlit{vec3(0.2F, 0.5F, 0.3F)};
  scene.objects = {{"floor", world::Plane{}, 0},
                   {"ball", world::Sphere{vec3(0, 1, 0), 1}, 1},
                   {"can", world::Cylinder{vec3(2.2F, 0.8F, 0), glm::normalize(vec3(0.3F, 1, 0.2F)), 0.7F, 0.5F}, 5},
                   {"cone", world::Cone{vec3(-2.2F, 0.8F, 0), vec3(0, 1, 0), 0.8F, 0.7F, 0.0F}, 3},
                   {"frustum", world::Cone{vec3(-0.8F, 0.4F, 2), vec3(0, 1, 0), 0.4F, 0.6F, 0.3F}, 2},
                   {"gem", make_smooth_mesh(vec3(1.2F, 0.6F, 1.8F), 0.6F), 4}};
  std::mt19937 generator(1);
  // std::uniform_real_distribution may differ between libraries; the generator's own numbers do not.
  const auto uniform = [&] { return static_cast<float>(generator() >> 8) * 0x1p-23F - 1.0F; };
  for (uint32_t i = 0; i < sphere_count; ++i) {
    const float x = 5.0F * uniform();
    const float y = 3.0F + 0.8F * uniform();
    scene.objects.push_back({"", world::Sphere{vec3(x, y, 3.0F * uniform()), 0.08F}, i % 7});
  }
  Light point;
  point.position = vec3(3, 6, 5);
  point.diffuse = point.specular = vec3(0.6F);
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction = glm::normalize(vec3(1, -1.5F, -0.7F));
  sun.diffuse = sun.specular = vec3(0.3F, 0.3F, 0.25F);
  Light spot;
  spot.kind = LightKind::kSpot;
  spot.position = vec3(-3, 5, 3);
  spot.direction = glm::normalize(vec3(0.5F, -1, -0.4F));
  spot.inner_cone_angle = 0.2F;
  spot.outer_cone_angle = 0.4F;
  spot.attenuation = Attenuation::kInverseSquare;
  spot.range = 20.0F;
  spot.diffuse = spot.specular = vec3(15.0F, 10.0F, 5.0F);
  scene.lights = {point, sun, spot};
  return scene;
}

world::Scene make_scene_of_alpha() {
  world::Scene scene = make_scene_of_everything(40);
  const auto add = [&](const world::Shape& shape, Material material) {
    scene.objects.push_back({"", shape, static_cast<uint32_t>(scene.materials.size())});
    scene.materials.push_back(std::move(material));
  };
  const auto make_pane = [](const vec3& center, float turn) {
    const vec3 along(std::cos(turn), 0, std::sin(turn));
    const vec3 up(0.0F, 1.0F, 0.0F);
    Mesh mesh;
    mesh.positions = {center - along - up, center + along - up, center + along + up, center - along + up};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  };
  const auto blending = [](Material material, float alpha) {
    material.alpha_mode = AlphaMode::kBlend;
    material.alpha = alpha;
    return material;
  };
  for (uint32_t i = 0; i < 6; ++i) {
    const float x = -1.5F + 0.6F * static_cast<float>(i);
    const vec3 center(x, 1.3F, 3.0F + 0.2F * static_cast<float>(i));
    add(make_pane(center, 0.3F * static_cast<float>(i)),
        blending(scene.materials[i], 0.15F + 0.1F * static_cast<float>(i)));
    // This pane coincides with the previous one.
    if (i == 2) add(make_pane(center, 0.6F), blending(scene.materials[4], 0.5F));
  }
  add(world::Sphere{vec3(0.6F, 1.4F, 2.6F), 0.5F}, blending(scene.materials[4], 0.3F));
  add(world::Cylinder{vec3(-1.4F, 0.6F, 2.9F), vec3(0, 1, 0), 0.5F, 0.3F}, blending(scene.materials[1], 0.6F));
  Material one_sided = scene.materials[2];
  one_sided.is_double_sided = false;
  add(make_pane(vec3(2.2F, 1.4F, 2.5F), 0.4F), one_sided);
  add(make_pane(vec3(-2.4F, 1.4F, 2.5F), 2.9F), one_sided);
  Material absent = scene.materials[0];
  absent.alpha_mode = AlphaMode::kMask;
  absent.alpha = 0.4F;
  add(make_pane(vec3(0, 2, 5), 0.1F), absent);
  return scene;
}

world::Scene make_scene_of_glass() {
  world::Scene scene = make_scene_of_everything(60);
  const auto add = [&](const world::Shape& shape, const Material& material) {
    scene.objects.push_back({"", shape, static_cast<uint32_t>(scene.materials.size())});
    scene.materials.push_back(material);
  };
  const auto make_phong = [](float ior, const vec3& transmission, float reflection, bool is_fresnel) {
    Phong phong;
    phong.ambient = phong.diffuse = vec3(0.02F);
    phong.specular = vec3(0.4F);
    phong.shininess = 80.0F;
    phong.reflection = vec3(reflection);
    phong.transmission = transmission;
    phong.ior = ior;
    phong.fresnel = is_fresnel;
    Material material;
    material.model = phong;
    return material;
  };
  const auto make_clear = [](float ior, float transmission, float thickness, float roughness, float distance) {
    MetallicRoughness model;
    model.base_color = vec3(0.9F, 0.95F, 0.7F);
    model.metallic = 0.0F;
    model.roughness = roughness;
    model.ior = ior;
    model.transmission = transmission;
    model.thickness = thickness;
    model.attenuation_color = vec3(0.3F, 0.6F, 0.9F);
    model.attenuation_distance = distance;
    Material material;
    material.model = model;
    return material;
  };
  // One ball is inside another, and has a bubble in it.
  add(world::Sphere{vec3(-0.9F, 1.5F, 3.2F), 0.7F}, make_phong(1.5F, vec3(0.9F, 0.85F, 0.8F), 0.1F, false));
  add(world::Sphere{vec3(-0.8F, 1.6F, 3.2F), 0.4F}, make_phong(1.2F, vec3(0.9F), 0.05F, true));
  add(world::Sphere{vec3(-0.7F, 1.6F, 3.3F), 0.15F}, make_phong(1.0F, vec3(1.0F), 0.0F, false));
  // These two solids overlap.
  Material flint = make_clear(1.5F, 0.9F, 1.0F, 0.0F, 0.5F);
  std::get<MetallicRoughness>(flint.model).dispersion = 0.6F;
  add(world::Sphere{vec3(0.7F, 1.5F, 3.0F), 0.5F}, flint);
  add(world::Sphere{vec3(1.2F, 1.6F, 3.1F), 0.45F}, make_clear(1.33F, 1.0F, 1.0F, 0.05F, 2.0F));
  add(world::Cylinder{vec3(1.9F, 0.7F, 3.0F), vec3(0, 1, 0), 0.6F, 0.3F}, make_phong(1.8F, vec3(0.8F), 1.0F, true));
  add(world::Cone{vec3(-2.0F, 0.7F, 3.0F), vec3(0, 1, 0), 0.6F, 0.5F, 0.1F}, make_clear(2.4F, 0.7F, 0.1F, 0.2F, 0.3F));
  // The material has one side, which volumes ignore.
  Material gem = make_clear(1.5F, 1.0F, 1.0F, 0.0F, 1.0F);
  gem.is_double_sided = false;
  std::get<MetallicRoughness>(gem.model).dispersion = 2.0F;
  add(make_smooth_mesh(vec3(0.1F, 0.6F, 3.9F), 0.4F), gem);
  // This surface blends within glass that absorbs.
  Mesh leaf;
  leaf.positions = {vec3(0.5F, 1.4F, 3.1F), vec3(0.75F, 1.35F, 3.2F), vec3(0.65F, 1.75F, 3.0F)};
  leaf.triangles = {{0, 1, 2}};
  Material blending = scene.materials[0];
  blending.alpha_mode = AlphaMode::kBlend;
  blending.alpha = 0.5F;
  add(leaf, blending);
  // This pane is thin.
  Mesh pane;
  pane.positions = {vec3(-0.4F, 2.0F, 3.4F), vec3(1.6F, 2.1F, 3.5F), vec3(1.6F, 2.9F, 3.1F), vec3(-0.4F, 2.8F, 3.0F)};
  pane.triangles = {{0, 1, 2}, {0, 2, 3}};
  add(pane, make_clear(1.5F, 0.8F, 0.0F, 0.3F, 1.0F));
  // This mirror depends on the angle, and transmits no light.
  add(world::Sphere{vec3(-2.3F, 2.0F, 2.0F), 0.4F}, make_phong(1.6F, vec3(0.0F), 1.0F, true));
  return scene;
}

View make_view(uvec2 size) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0, 2.5F, 8);
  view.camera.look = glm::normalize(vec3(0, -0.2F, -1));
  view.camera.up = glm::normalize(vec3(0, 1, -0.2F));
  view.camera.yfov = 0.7F;
  return view;
}

std::vector<Ray> make_rays(size_t count) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    const vec3 eye(8.0F * std::cos(x), 3.0F + 2.0F * std::sin(7.0F * x), 8.0F * std::sin(x));
    const vec3 target(3.0F * std::sin(11.0F * x), 1.5F + 1.5F * std::cos(5.0F * x), 2.0F * std::sin(3.0F * x));
    rays.push_back({eye, 0.0F, target - eye, std::numeric_limits<float>::infinity()});
  }
  return rays;
}

Mesh make_board(float z, const vec2& lo, const vec2& hi) {
  Mesh mesh;
  mesh.positions = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const vec2& uv : {lo, vec2(hi.x, lo.y), hi, vec2(lo.x, hi.y)}) mesh.uvs.emplace_back(uv, -uv);
  return mesh;
}

View make_board_view(const uvec2& size, uint32_t samples) {
  View view;
  view.camera.eye = vec3(0, 0, 2);
  view.camera.projection = Projection::kOrthographic;
  view.camera.ymag = 1.0F;
  view.size = size;
  view.samples_per_pixel = samples;
  return view;
}

Material make_unlit(const vec3& color, AlphaMode mode, float alpha) {
  Material material;
  material.model = Unlit{color, {}};
  material.alpha_mode = mode;
  material.alpha = alpha;
  return material;
}

Light make_sun(const vec3& direction, float power) {
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction = glm::normalize(direction);
  sun.diffuse = sun.specular = vec3(power);
  return sun;
}

uint32_t add_texture(Scene& scene, const uvec2& size, const std::vector<uint32_t>& texels, ImageUse use) {
  scene.images.push_back(std::make_shared<TextureImage>(TextureImage{"", size, texels, use}));
  Texture texture{.image = static_cast<uint32_t>(scene.images.size() - 1)};
  texture.is_magnified_linearly = texture.has_levels = false;
  scene.textures.push_back(texture);
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

bool has_same_bits(const Image& a, const Image& b) {
  return a.size == b.size && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(a.pixels[0])) == 0;
}

}  // namespace promin::test
