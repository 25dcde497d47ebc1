// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Boards like those of Khronos' sample models: rows of patches with an expected green each. Red light in a patch is an
// error. Shaders with a fault (tests/faults) also draw each board, and must turn it red; this shows that each board can
// fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "gpu/device_fixture.h"
#include "gpu/faulty_shaders.h"
#include "gpu/test_scenes.h"
#include "promin/image.h"
#include "promin/validate.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

constexpr uint32_t kPatchPixels = 8;
constexpr uint32_t kGreen = 0xFF00FF00U;
constexpr uint32_t kRed = 0xFF0000FFU;

/// A board of patches side by side. The patch i lies from x = i to i + 1 and is seen along -z from z = 2.
class Board {
 public:
  Scene scene;
  /// The expected colour of each patch.
  std::vector<vec3> expected;

  float left() const { return static_cast<float>(expected.size()); }

  uint32_t add_material(const Material& material) {
    scene.materials.push_back(material);
    return static_cast<uint32_t>(scene.materials.size() - 1);
  }

  /// Adds a mesh over the next patch at the height z; `uv` is at its corners, from the lower left one on.
  Mesh& add(float z, const Material& material,
            const std::vector<vec4>& uvs = {{0, 1, 0, 1}, {1, 1, 1, 1}, {1, 0, 1, 0}, {0, 0, 0, 0}}) {
    Mesh mesh;
    const float x = left();
    mesh.positions = {{x, 0, z}, {x + 1, 0, z}, {x + 1, 1, z}, {x, 1, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.uvs = uvs;
    scene.add("patch", mesh, add_material(material));
    return std::get<Mesh>(scene.geometries.back());
  }

  void end_patch(const vec3& color = vec3(0, 1, 0)) { expected.push_back(color); }

  uint32_t add_image(const uvec2& size, const std::vector<uint32_t>& texels, ImageUse use = ImageUse::kColor) {
    return add_texture(scene, size, texels, use);
  }

  View view() const {
    View view = make_board_view(kPatchPixels * uvec2(expected.size(), 1));
    view.camera.eye = vec3(0.5F * left(), 0.5F, 2.0F);
    view.camera.ymag = 0.5F;
    return view;
  }
};

const vec3 kGreenLight(0, 1, 0);
const vec3 kRedLight(1, 0, 0);

Material make_textured(uint32_t texture, AlphaMode mode = AlphaMode::kOpaque) {
  Material material = make_unlit(vec3(1.0F), mode);
  std::get<Unlit>(material.model).color_texture.texture = texture;
  return material;
}

std::vector<vec4> uvs_of(const vec2& lo, const vec2& hi) {
  return {{lo.x, hi.y, lo.x, hi.y}, {hi.x, hi.y, hi.x, hi.y}, {hi.x, lo.y, hi.x, lo.y}, {lo.x, lo.y, lo.x, lo.y}};
}

Board make_wraps() {
  Board board;
  const auto add = [&](TextureWrap wrap, const vec2& from_to) {
    const uint32_t texture = board.add_image({2, 1}, {kGreen, kRed});
    board.scene.textures[texture].wrap_u = wrap;
    board.add(0, make_textured(texture), uvs_of({from_to.x, 0}, {from_to.y, 1}));
    board.end_patch();
  };
  for (const vec2& green : {vec2(0, 0.5F), vec2(1, 1.5F), vec2(-1, -0.5F)}) add(TextureWrap::kRepeat, green);
  for (const vec2& green : {vec2(0, 0.5F), vec2(1.5F, 2.5F), vec2(-0.5F, 0.5F)})
    add(TextureWrap::kMirroredRepeat, green);
  for (const vec2& green : {vec2(-3, 0.5F), vec2(-9, 0)}) add(TextureWrap::kClampToEdge, green);
  return board;
}

// The second set shows green at the points where the first set shows red. Transforms move these points to green, too.
Board make_coordinates() {
  Board board;
  const uint32_t texture = board.add_image({4, 4}, {kRed, kRed, kRed, kRed,    //
                                                    kRed, kRed, kGreen, kRed,  //
                                                    kRed, kRed, kRed, kRed,    //
                                                    kRed, kRed, kRed, kRed});
  Material second = make_textured(texture);
  std::get<Unlit>(second.model).color_texture.uv_set = 1;
  std::vector<vec4> uvs;
  for (const vec2& uv : {vec2(0.5F, 0.5F), vec2(0.75F, 0.5F), vec2(0.75F, 0.25F), vec2(0.5F, 0.25F)}) {
    uvs.emplace_back(0.1F, 0.1F, uv);
  }
  board.add(0, second, uvs);
  board.end_patch();
  // KHR_texture_transform moves, rotates and scales (s, t) of the patch to the green texel.
  const auto add = [&](const vec3& to_u, const vec3& to_v) {
    Material material = make_textured(texture);
    TextureSlot& slot = std::get<Unlit>(material.model).color_texture;
    slot.to_u = to_u;
    slot.to_v = to_v;
    board.add(0, material, uvs_of(vec2(0), vec2(1)));
    board.end_patch();
  };
  add({0.25F, 0, 0.5F}, {0, 0.25F, 0.25F});
  // A quarter turn gives u = s_v t + o_u and v = -s_u s + o_v.
  add({0, 0.25F, 0.5F}, {-0.25F, 0, 0.5F});
  // This is a shear, as a rotation with unequal scales gives it.
  add({0.125F, 0.125F, 0.5F}, {0.0625F, 0.125F, 0.25F});
  return board;
}

// Half of a bright texel is half of its light: halfway between the codes 0 and 255 is 188, not 128.
Board make_srgb() {
  Board board;
  const uint32_t texture = board.add_image({2, 1}, {0xFF000000U, kGreen});
  board.scene.textures[texture].is_magnified_linearly = true;
  board.add(0, make_textured(texture), uvs_of({0.5F, 0}, {0.5F, 1}));
  board.end_patch(vec3(0, 0.5F, 0));
  const uint32_t middle = board.add_image({1, 1}, {0xFF00BC00U});
  board.add(0, make_textured(middle));
  board.end_patch(vec3(0, std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 0));
  return board;
}

/// The cutoff is in the middle column of the texture: the surface is present there and absent to the left of it.
Board make_masks() {
  Board board;
  for (const uint32_t cutoff : {64U, 128U, 191U}) {
    const std::array<uint32_t, 2> alphas = {cutoff - 1, cutoff};
    for (const bool is_there : {false, true}) {
      const uint32_t color = (is_there ? kGreen : kRed) & 0xFFFFFFU;
      Material mask =
          make_textured(board.add_image({1, 1}, {color | alphas[is_there ? 1 : 0] << 24}), AlphaMode::kMask);
      mask.alpha_cutoff = static_cast<float>(cutoff) / 255.0F;
      board.add(0, mask);
      board.add(-1, make_unlit(is_there ? kRedLight : kGreenLight));
      board.end_patch();
    }
  }
  // Opaque materials ignore alpha.
  board.add(0, make_textured(board.add_image({1, 1}, {0x0000FF00U})));
  board.add(-1, make_unlit(kRedLight));
  board.end_patch();
  return board;
}

Board make_blends() {
  Board board;
  const auto add = [&](const std::vector<float>& alphas, float z_step) {
    float light = 1.0F;
    for (size_t i = 0; i < alphas.size(); ++i) {
      board.add(-z_step * static_cast<float>(i), make_unlit(vec3(0), AlphaMode::kBlend, alphas[i]));
      light *= 1.0F - alphas[i];
    }
    board.add(-1, make_unlit(kGreenLight));
    board.end_patch(vec3(0, light, 0));
  };
  add({0.0F}, 0.1F);
  add({0.5F}, 0.1F);
  add({0.5F, 0.25F}, 0.1F);
  // These surfaces are in one place.
  add({0.5F, 0.25F, 0.75F}, 0.0F);
  board.add(0, make_unlit(kGreenLight, AlphaMode::kBlend, 0.25F));
  board.add(-1, make_unlit(vec3(0)));
  board.end_patch(vec3(0, 0.25F, 0));
  return board;
}

Board make_sides() {
  Board board;
  for (const bool is_back : {false, true}) {
    for (const bool is_double_sided : {false, true}) {
      const bool is_seen = !is_back || is_double_sided;
      Material material = make_unlit(is_seen ? kGreenLight : kRedLight);
      material.is_double_sided = is_double_sided;
      Mesh& mesh = board.add(0, material);
      if (is_back) mesh.triangles = {{2, 1, 0}, {3, 2, 0}};
      board.add(-1, make_unlit(is_seen ? kRedLight : kGreenLight));
      board.end_patch();
    }
  }
  return board;
}

Material make_leaf_matt() {
  Material material;
  material.model = MetallicRoughness{.base_color = kGreenLight, .metallic = 0.0F, .specular = 0.0F};
  return material;
}

constexpr float kHalfTurn = std::numbers::pi_v<float>;

// Curtains with holes and blending ones hang behind the camera.
Board make_shadows() {
  Board board;
  board.scene.lights = {make_sun(vec3(0, 0, -1), kHalfTurn)};
  const auto add = [&](const Material& curtain, float light) {
    board.add(0, make_leaf_matt());
    board.add(3, curtain);
    board.end_patch(vec3(0, light, 0));
  };
  add(make_unlit(vec3(1)), 0.0F);
  for (const AlphaMode mode : {AlphaMode::kMask, AlphaMode::kBlend}) {
    add(make_textured(board.add_image({1, 1}, {0x33FFFFFFU}), mode), mode == AlphaMode::kMask ? 1.0F : 0.8F);
    add(make_textured(board.add_image({1, 1}, {0xFFFFFFFFU}), mode), 0.0F);
  }
  // The backs of surfaces cast shadows, too.
  Material one_sided = make_unlit(vec3(1));
  one_sided.is_double_sided = false;
  add(one_sided, 0.0F);
  return board;
}

// A surface with a texture of normals looks like geometry that is tilted by the same angle.
Board make_normals() {
  Board board;
  const vec3 sun(1, -2, -3);
  board.scene.lights = {make_sun(sun, kHalfTurn)};
  const auto lit = [&](const vec3& normal) {
    return vec3(0, std::max(0.0F, glm::dot(glm::normalize(normal), -glm::normalize(sun))), 0);
  };
  const auto add = [&](uint32_t texel, float scale) {
    const auto component = [&](uint32_t shift) { return static_cast<float>(texel >> shift & 0xFF) / 127.5F - 1.0F; };
    Material material = make_leaf_matt();
    auto& model = std::get<MetallicRoughness>(material.model);
    model.normal_texture.texture = board.add_image({1, 1}, {texel}, ImageUse::kNormal);
    model.normal_scale = scale;
    board.add(0, material).normals.assign(4, vec3(0, 0, 1));
    // The normal's green component goes up as v goes down (glTF 2.0, 3.9.3), and v goes down as y goes up.
    board.end_patch(lit(vec3(scale * component(0), scale * component(8), component(16))));
  };
  add(0xFFFF8080U, 1.0F);
  add(0xFFC0A0F0U, 1.0F);
  add(0xFFC0F0A0U, 1.0F);
  add(0xFFC0A030U, 0.5F);
  add(0xFFC030A0U, 1.0F);
  return board;
}

// Occlusion reduces only light from everywhere.
Board make_occlusion() {
  Board board;
  board.scene.lights = {make_sun(vec3(0, 0, -1), 0.5F * kHalfTurn)};
  board.scene.environment.ambient = vec3(0.5F);
  for (const uint32_t left : {0U, 51U, 255U}) {
    Material material = make_leaf_matt();
    auto& model = std::get<MetallicRoughness>(material.model);
    model.occlusion_texture.texture = board.add_image({1, 1}, {0xFF000000U | left}, ImageUse::kData);
    board.add(0, material);
    board.end_patch(vec3(0, 0.5F + 0.5F * static_cast<float>(left) / 255.0F, 0));
  }
  return board;
}

// The layers under a coat may have a texture of normals; the coat stays flat. Its mirror ray sees the board behind the
// camera with the weight of Schlick's factor.
Board make_coats() {
  Board board;
  for (const bool has_normals : {false, true}) {
    Material material = make_leaf_matt();
    auto& model = std::get<MetallicRoughness>(material.model);
    model.base_color = vec3(0.0F);
    model.clearcoat = 1.0F;
    if (has_normals) model.normal_texture.texture = board.add_image({1, 1}, {0xFFC0A0F0U}, ImageUse::kNormal);
    board.add(0, material).normals.assign(4, vec3(0, 0, 1));
    board.add(3, make_unlit(kGreenLight));
    board.end_patch(vec3(0, 0.04F, 0));
  }
  return board;
}

struct BoardCase {
  const char* name;
  std::function<Board()> make;
  std::vector<const char*> faults;
};

const BoardCase kBoards[] = {
    {"Wraps", make_wraps, {"wraps_swapped"}},
    {"Coordinates", make_coordinates, {"one_uv_set", "transform_transposed"}},
    {"Srgb", make_srgb, {"srgb_is_linear", "srgb_after_filter"}},
    {"Masks", make_masks, {"cutoff_excluded", "masks_in_shadows_alone"}},
    {"Blends", make_blends, {"alpha_premultiplied", "edges_counted_twice", "equal_t_passed"}},
    {"Sides", make_sides, {"fronts_culled"}},
    {"Shadows", make_shadows, {"shadows_without_holes"}},
    {"Normals", make_normals, {"green_flipped", "normals_unscaled"}},
    {"Occlusion", make_occlusion, {"occlusion_dims_sources"}},
    {"Coats", make_coats, {"coat_bent_by_normals"}},
};

void PrintTo(const BoardCase& board, std::ostream* out) {
  *out << board.name;
}

class BoardsTest : public DeviceTest, public testing::WithParamInterface<BoardCase> {
 protected:
  /// Returns the number of wrong pixels. A pixel is wrong if it differs by more than one 8-bit step in dark parts of a
  /// picture.
  size_t count_red(const Board& board, const TunedRendererOptions& options = {}) {
    EXPECT_TRUE(validate(board.scene).empty());
    const Image image = make_renderer(device(), board.scene, options).render(board.view()).image;
    size_t red = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const vec3& expected = board.expected[i % image.size.x / kPatchPixels];
      const vec3 off = glm::abs(image.pixels[i] - expected);
      if (!(std::max({off.r, off.g, off.b}) <= 0.5F / 255.0F)) ++red;
    }
    return red;
  }
};

TEST_P(BoardsTest, HasNoRed) {
  EXPECT_EQ(count_red(GetParam().make()), 0U);
}

TEST_P(BoardsTest, TurnsRedWithAFault) {
  for (const char* fault : GetParam().faults) {
    const FaultyShaders faulty(fault);
    TunedRendererOptions options;
    options.shaders = faulty.shaders();
    EXPECT_GT(count_red(GetParam().make(), options), 0U) << fault;
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, BoardsTest, testing::ValuesIn(kBoards),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace promin::test
