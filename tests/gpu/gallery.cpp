// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "gpu/gallery.h"

#include <cmath>
#include <numbers>
#include <random>

#include "gpu/test_scenes.h"

namespace promin::test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Material make_phong(const vec3& diffuse, const vec3& specular, float shininess, float reflection) {
  Material material;
  Phong& phong = material.phong();
  phong.ambient = phong.diffuse = diffuse;
  phong.specular = specular;
  phong.shininess = shininess;
  phong.reflection = vec3(reflection);
  return material;
}

}  // namespace

Material make_metallic(float metallic, float roughness, const vec3& color) {
  Material material;
  material.model = MetallicRoughness{.base_color = color, .metallic = metallic, .roughness = roughness};
  return material;
}

Gallery::Gallery() {
  scene.environment.ambient = vec3(0.3F, 0.35F, 0.4F);
  scene.environment.background = vec3(0.2F, 0.3F, 0.5F);
  scene.lights = {make_sun(vec3(0.4F, -1, -0.8F), 1.2F)};
  Light lamp;
  lamp.position = vec3(2, 4, 4);
  lamp.diffuse = lamp.specular = vec3(0.8F, 0.7F, 0.6F);
  scene.lights.push_back(lamp);
  Material floor = make_metallic(0, 0.6F);
  auto& model = std::get<MetallicRoughness>(floor.model);
  model.base_color_texture.texture = add_noise({32, 32}, ImageUse::kColor);
  Mesh mesh;
  mesh.positions = {{-6, 0, 5}, {6, 0, 5}, {6, 0, -7}, {-6, 0, -7}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const vec2& uv : {vec2(0, 0), vec2(6, 0), vec2(6, 6), vec2(0, 6)}) mesh.uvs.emplace_back(uv, uv);
  scene.materials.push_back(floor);
  scene.objects.push_back({"floor", mesh, 0});
  scene.materials.push_back(make_phong(vec3(0.05F), vec3(0.0F), 0, 0.7F));
  scene.objects.push_back({"wall", world::Box{.center = vec3(0, 2, -3), .half_size = vec3(4, 2, 0.1F)}, 1});
}

uint32_t Gallery::add_noise(const uvec2& size, ImageUse use, uint32_t low) {
  std::mt19937 generator(static_cast<uint32_t>(scene.images.size() + 1));
  TextureImage image{.name = "", .size = size, .texels = {}, .use = use};
  for (uint32_t i = 0; i < size.x * size.y; ++i) {
    uint32_t texel = 0;
    for (int channel = 0; channel < 4; ++channel) {
      texel |= (low + static_cast<uint32_t>(generator() >> 8) % (256 - low)) << 8 * channel;
    }
    // Normals are tilted by up to about 45 degrees.
    if (use == ImageUse::kNormal) texel = ((texel >> 1 & 0x7F7F7F7FU) + 0x00404040U) | 0x00E00000U;
    image.texels.push_back(texel);
  }
  scene.images.push_back(std::make_shared<TextureImage>(image));
  scene.textures.push_back({.image = static_cast<uint32_t>(scene.images.size() - 1)});
  return static_cast<uint32_t>(scene.textures.size() - 1);
}

Mesh& Gallery::add_board(const Material& material, float turn) {
  const float x = -2.1F + 1.4F * static_cast<float>(board_count % 4);
  const float y = 0.7F + 1.3F * static_cast<float>(board_count / 4);
  ++board_count;
  const vec3 center(x, y, 0.3F * x);
  const vec3 along = 0.55F * vec3(std::cos(turn), 0, std::sin(turn));
  const vec3 up(0, 0.55F, 0);
  Mesh mesh;
  mesh.positions = {center - along - up, center + along - up, center + along + up, center - along + up};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const vec2 set_0[] = {{-0.4F, 1.6F}, {1.6F, 1.6F}, {1.6F, -0.4F}, {-0.4F, -0.4F}};
  const vec2 set_1[] = {{0.1F, 0.7F}, {0.8F, 0.9F}, {0.9F, 0.2F}, {0.2F, 0.0F}};
  for (int i = 0; i < 4; ++i) mesh.uvs.emplace_back(set_0[i], set_1[i]);
  scene.materials.push_back(material);
  scene.objects.push_back({"board", mesh, static_cast<uint32_t>(scene.materials.size() - 1)});
  return std::get<Mesh>(scene.objects.back().shape);
}

Mesh& Gallery::add_ball(const vec3& center, float radius, const Material& material) {
  constexpr uint32_t kColumns = 12;
  constexpr uint32_t kRows = 6;
  Mesh mesh;
  for (uint32_t row = 0; row <= kRows; ++row) {
    for (uint32_t column = 0; column <= kColumns; ++column) {
      const float azimuth = 2 * kPi * static_cast<float>(column) / kColumns;
      const float elevation = kPi * (0.5F - static_cast<float>(row) / kRows);
      const vec3 n(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                   std::cos(elevation) * std::cos(azimuth));
      mesh.positions.push_back(center + radius * n);
      mesh.normals.push_back(n);
      mesh.uvs.emplace_back(2.0F * static_cast<float>(column) / kColumns, static_cast<float>(row) / kRows, 0, 0);
      mesh.tangents.emplace_back(std::cos(azimuth), 0, -std::sin(azimuth), 1);
      if (row == kRows || column == kColumns) continue;
      const uint32_t corner = row * (kColumns + 1) + column;
      const uint32_t below = corner + kColumns + 1;
      if (row > 0) mesh.triangles.emplace_back(corner, below, corner + 1);
      if (row + 1 < kRows) mesh.triangles.emplace_back(corner + 1, below, below + 1);
    }
  }
  scene.materials.push_back(material);
  scene.objects.push_back({"ball", mesh, static_cast<uint32_t>(scene.materials.size() - 1)});
  return std::get<Mesh>(scene.objects.back().shape);
}

world::Scene make_gallery_of_metallic_roughness() {
  Gallery gallery;
  const uint32_t color = gallery.add_noise({16, 16}, ImageUse::kColor);
  const uint32_t odd_color = gallery.add_noise({13, 7}, ImageUse::kColor);
  const uint32_t numbers = gallery.add_noise({8, 8}, ImageUse::kData, 64);
  const uint32_t normals = gallery.add_noise({8, 8}, ImageUse::kNormal);
  const auto add = [&](float metallic, float roughness, float turn, auto change) {
    Material material = make_metallic(metallic, roughness, vec3(0.9F, 0.8F, 0.7F));
    change(material, std::get<MetallicRoughness>(material.model));
    return &gallery.add_board(material, turn);
  };
  add(0.5F, 0.6F, 0.2F, [&](Material&, MetallicRoughness& model) { model.base_color_texture.texture = color; });
  add(1.0F, 0.9F, -0.3F,
      [&](Material&, MetallicRoughness& model) { model.metallic_roughness_texture.texture = numbers; });
  // These boards have tangents: one along the board, and one that is mirrored.
  add(0.0F, 0.5F, 0.0F, [&](Material&, MetallicRoughness& model) {
    model.normal_texture.texture = normals;
    model.normal_scale = 0.7F;
    model.specular_color = vec3(8.0F, 6.0F, 3.0F);
    model.specular_texture.texture = numbers;
    model.specular_color_texture.texture = color;
  })->tangents.assign(4, vec4(1, 0, 0, 1));
  add(0.0F, 0.7F, 0.4F, [&](Material& material, MetallicRoughness& model) {
    model.occlusion_texture = {.texture = numbers, .uv_set = 1};
    model.occlusion_strength = 0.8F;
    model.sheen_color = vec3(0.9F, 0.7F, 0.5F);
    model.sheen_roughness = 0.9F;
    model.sheen_color_texture.texture = color;
    model.sheen_roughness_texture.texture = numbers;
    material.emissive = vec3(0.4F, 0.3F, 0.2F);
    material.emissive_texture = {.texture = odd_color, .to_u = {1.2F, 0.5F, 0.1F}, .to_v = {-0.6F, 0.9F, 0.3F}};
  });
  // The back of this board is seen.
  add(0.3F, 0.5F, kPi - 0.3F, [&](Material&, MetallicRoughness& model) {
    model.base_color_texture.texture = odd_color;
    model.normal_texture.texture = normals;
  });
  add(0.2F, 0.6F, 0.3F, [&](Material&, MetallicRoughness& model) {
    model.base_color_texture.texture = color;
    model.clearcoat = 0.9F;
    model.clearcoat_roughness = 0.8F;
    model.clearcoat_texture.texture = numbers;
    model.clearcoat_roughness_texture.texture = numbers;
  });
  add(0.2F, 0.6F, -0.2F, [&](Material&, MetallicRoughness& model) {
    model.clearcoat = 1.0F;
    model.clearcoat_roughness = 0.4F;
    model.clearcoat_normal_texture.texture = normals;
    model.clearcoat_normal_scale = 0.5F;
  });
  // This board is a mirror with a texture of normals.
  add(1.0F, 0.15F, 0.1F, [&](Material&, MetallicRoughness& model) {
    model.normal_texture = {.texture = normals, .to_u = {0.3F, 0, 0}, .to_v = {0, 0.3F, 0}};
    model.normal_scale = 0.05F;
  })->tangents.assign(4, vec4(std::cos(0.1F), 0, std::sin(0.1F), 1));
  Material ball = make_metallic(1.0F, 0.1F, vec3(0.8F));
  gallery.add_ball(vec3(2.0F, 0.45F, 3.2F), 0.4F, ball);
  std::get<MetallicRoughness>(ball.model) = {.metallic = 0.0F, .roughness = 0.5F};
  std::get<MetallicRoughness>(ball.model).base_color_texture.texture = color;
  gallery.add_ball(vec3(-1.5F, 0.45F, 3.2F), 0.4F, ball);
  return gallery.scene;
}

world::Scene make_gallery_of_phong() {
  Gallery gallery;
  const uint32_t color = gallery.add_noise({16, 16}, ImageUse::kColor);
  const uint32_t normals = gallery.add_noise({8, 8}, ImageUse::kNormal);
  const auto with = [&](uint32_t texture, auto change) {
    Texture other = gallery.scene.textures[texture];
    change(other);
    gallery.scene.textures.push_back(other);
    return static_cast<uint32_t>(gallery.scene.textures.size() - 1);
  };
  const auto add = [&](float turn, auto change) {
    Material material = make_phong(vec3(0.8F, 0.7F, 0.6F), vec3(0.5F), 20, 0.0F);
    change(material, material.phong());
    gallery.add_board(material, turn);
  };
  const auto add_unlit = [&](float turn, uint32_t texture) {
    Material material;
    material.model = Unlit{vec3(0.9F), {.texture = texture}};
    gallery.add_board(material, turn);
  };
  add(0.3F, [&](Material& material, Phong& phong) {
    phong.diffuse_texture.texture = color;
    material.emissive = vec3(0.2F, 0.1F, 0.3F);
    material.emissive_texture = {.texture = color, .uv_set = 1};
  });
  add(-0.2F, [&](Material&, Phong& phong) {
    phong.specular_texture.texture = color;
    phong.reflection = vec3(0.4F);
  });
  add(0.1F, [&](Material&, Phong& phong) { phong.normal_texture.texture = normals; });
  add_unlit(0.2F, with(color, [](Texture& texture) { texture.are_levels_linear = false; }));
  add_unlit(-0.3F, with(color, [](Texture& texture) {
    texture.wrap_u = TextureWrap::kMirroredRepeat;
    texture.wrap_v = TextureWrap::kClampToEdge;
  }));
  add_unlit(0.1F, with(color, [](Texture& texture) {
              texture.wrap_u = TextureWrap::kClampToEdge;
              texture.wrap_v = TextureWrap::kMirroredRepeat;
              texture.is_minified_linearly = false;
            }));
  const uint32_t large = gallery.add_noise({6, 5}, ImageUse::kColor);
  add_unlit(0.0F, with(large, [](Texture& texture) {
              texture.is_magnified_linearly = texture.is_minified_linearly = texture.has_levels = false;
              texture.wrap_u = TextureWrap::kMirroredRepeat;
            }));
  add_unlit(-0.1F, with(color, [](Texture& texture) { texture.has_levels = false; }));
  gallery.add_ball(vec3(2.0F, 0.45F, 3.2F), 0.4F, make_phong(vec3(0.1F), vec3(0.4F), 50, 0.7F));
  return gallery.scene;
}

world::Scene make_gallery_of_alpha() {
  Gallery gallery;
  const uint32_t soft = gallery.add_noise({8, 8}, ImageUse::kColor);
  const uint32_t hard = gallery.add_noise({6, 6}, ImageUse::kColor);
  gallery.scene.textures[hard].has_levels = false;
  for (int i = 0; i < 8; ++i) {
    Material material = i % 3 == 0 ? make_phong(vec3(0.7F), vec3(0.3F), 20, 0.0F) : make_metallic(0.3F, 0.5F);
    material.alpha_mode = i % 2 == 0 ? AlphaMode::kBlend : AlphaMode::kMask;
    material.alpha = 0.9F;
    material.alpha_cutoff = 0.4F;
    TextureSlot slot{.texture = i % 2 == 0 ? soft : hard};
    if (i >= 4) slot.to_u = slot.to_v = vec3(0.5F, 0.4F, 0.1F);
    if (i >= 4) slot.to_v.y = -0.5F;
    if (i % 3 == 0) {
      material.phong().diffuse_texture = slot;
    } else {
      std::get<MetallicRoughness>(material.model).base_color_texture = slot;
    }
    Mesh& mesh = gallery.add_board(material, 0.1F * static_cast<float>(i));
    if (i % 4 >= 2) mesh.colors = {{1, 0.8F, 1, 1}, {0.7F, 1, 1, 0.8F}, {1, 1, 0.6F, 0.9F}, {1, 1, 1, 0.7F}};
  }
  return gallery.scene;
}

Environment make_gradient() {
  Environment environment;
  environment.sky = GradientSky{.top = {0.3F, 0.5F, 1.0F},
                                .horizon = {1.0F, 0.9F, 0.7F},
                                .bottom = {0.3F, 0.25F, 0.2F},
                                .top_curve = 0.7F,
                                .bottom_curve = 0.5F};
  return environment;
}

Environment make_studio() {
  Environment environment;
  environment.sky = Studio{0.3F};
  environment.rotation = 0.4F;
  environment.intensity = 0.8F;
  return environment;
}

Environment make_panorama() {
  constexpr uvec2 kSize(256, 128);
  auto image = std::make_shared<Image>();
  image->size = kSize;
  for (uint32_t y = 0; y < kSize.y; ++y) {
    const float elevation = kPi * (0.5F - (static_cast<float>(y) + 0.5F) / static_cast<float>(kSize.y));
    for (uint32_t x = 0; x < kSize.x; ++x) {
      const float azimuth = 2 * kPi * (static_cast<float>(x) + 0.5F) / static_cast<float>(kSize.x) - kPi;
      const vec3 d(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                   -std::cos(elevation) * std::cos(azimuth));
      const float red = std::exp(8 * (glm::dot(d, glm::normalize(vec3(1, 1, 0.5F))) - 1));
      const float blue = std::exp(5 * (glm::dot(d, glm::normalize(vec3(-1, 0.2F, 1))) - 1));
      image->pixels.emplace_back(vec3(0.3F + 0.2F * d.y) + red * vec3(1.5F, 0.8F, 0.4F) + blue * vec3(0.2F, 0.5F, 1));
    }
  }
  Environment environment;
  environment.sky = Panorama{image};
  environment.rotation = -0.7F;
  return environment;
}

world::Scene make_row_of_metals(const Environment& environment, std::span<const float> roughnesses) {
  world::Scene scene;
  scene.environment = environment;
  for (size_t i = 0; i < roughnesses.size(); ++i) {
    scene.materials.push_back(make_metallic(1.0F, roughnesses[i]));
    scene.objects.push_back({"", world::Sphere{vec3(static_cast<float>(i), 0, 0), 0.5F}, static_cast<uint32_t>(i)});
  }
  return scene;
}

View make_view_of_row(size_t count, uint32_t side) {
  View view;
  view.camera.projection = Projection::kOrthographic;
  view.camera.ymag = 0.5F;
  view.camera.eye = vec3(0.5F * static_cast<float>(count - 1), 0, 2);
  view.size = side * uvec2(count, 1);
  view.max_depth = 0;
  return view;
}

world::Scene make_scene_under_sky(const Environment& environment) {
  world::Scene scene;
  scene.environment = environment;
  scene.environment.shows_sky = true;
  scene.lights = {make_sun(vec3(0.4F, -1, -0.8F), 1.0F)};
  scene.materials = {make_metallic(0, 0.7F, vec3(0.5F, 0.4F, 0.3F)),
                     make_metallic(1, 0.0F, vec3(0.9F, 0.8F, 0.6F)),
                     make_metallic(1, 0.2F, vec3(0.9F, 0.8F, 0.6F)),
                     make_metallic(1, 0.6F, vec3(0.9F, 0.8F, 0.6F)),
                     make_metallic(0, 0.3F, vec3(0.2F, 0.5F, 0.3F)),
                     make_metallic(0.4F, 0.5F, vec3(0.6F, 0.1F, 0.1F)),
                     make_phong(vec3(0.1F), vec3(0.5F), 50, 0.8F),
                     make_phong(vec3(0.7F), vec3(0.2F), 10, 0.0F),
                     make_metallic(0, 0.25F, vec3(0.8F))};
  auto& coated = std::get<MetallicRoughness>(scene.materials[5].model);
  coated.clearcoat = 1.0F;
  coated.clearcoat_roughness = 0.12F;
  auto& cloth = std::get<MetallicRoughness>(scene.materials[4].model);
  cloth.sheen_color = vec3(0.7F, 0.5F, 0.9F);
  cloth.sheen_roughness = 0.5F;
  scene.materials[8].alpha_mode = AlphaMode::kBlend;
  scene.materials[8].alpha = 0.5F;
  scene.objects = {{"floor", world::Plane{}, 0}};
  for (uint32_t i = 0; i < 8; ++i) {
    const vec3 center(-2.4F + 1.6F * static_cast<float>(i % 4), 0.75F, i < 4 ? 0.0F : 2.2F);
    scene.objects.push_back({"", world::Sphere{center, 0.7F}, i + 1});
  }
  return scene;
}

View make_gallery_view(uvec2 size) {
  View view;
  view.size = size;
  view.camera.eye = vec3(0.4F, 2.4F, 7.5F);
  view.camera.look = glm::normalize(vec3(-0.05F, -0.18F, -1));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.camera.yfov = 0.7F;
  return view;
}

}  // namespace promin::test
