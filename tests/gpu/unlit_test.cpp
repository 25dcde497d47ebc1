// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check what the camera sees of unlit surfaces (Aovs::unlit; docs/model.md, "Unlit"): beside lit ones,
// through blending ones and in a mirror.
#include <gtest/gtest.h>

#include <array>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/display.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

const vec3 kUnlitColor(0.25F, 0.5F, 0.75F);
constexpr uint32_t kStripes = 5;

/// Adds a stripe to the board that fills the picture; `index` counts from the left.
void add_stripe(Scene& scene, uint32_t index, float z, const Material& material) {
  Mesh board = make_board(z);
  for (vec3& position : board.positions) {
    position.x = (2.0F * static_cast<float>(index) + position.x + 1.0F) / static_cast<float>(kStripes) - 1.0F;
  }
  scene.materials.push_back(material);
  scene.add("stripe", board, static_cast<uint32_t>(scene.materials.size() - 1));
}

Material make_lit(AlphaMode mode = AlphaMode::kOpaque, float alpha = 1.0F) {
  Material material = make_unlit(vec3(0.0F), mode, alpha);
  material.model = Phong{.ambient = vec3(0.0F), .diffuse = vec3(0.5F)};
  return material;
}

/// Returns stripes, from the left: unlit, lit, unlit behind a quarter of a lit surface, lit behind a quarter of an
/// unlit surface, and a mirror of an unlit surface.
Scene make_stripes() {
  Scene scene;
  add_stripe(scene, 0, 0.0F, make_unlit(kUnlitColor));
  add_stripe(scene, 1, 0.0F, make_lit());
  add_stripe(scene, 2, 0.5F, make_lit(AlphaMode::kBlend, 0.25F));
  add_stripe(scene, 2, 0.0F, make_unlit(kUnlitColor));
  add_stripe(scene, 3, 0.5F, make_unlit(kUnlitColor, AlphaMode::kBlend, 0.25F));
  add_stripe(scene, 3, 0.0F, make_lit());
  Material mirror;
  mirror.model = Phong{.ambient = vec3(0.0F), .diffuse = vec3(0.0F), .reflection = vec3(0.5F)};
  add_stripe(scene, 4, 0.0F, mirror);
  add_stripe(scene, 4, 3.0F, make_unlit(kUnlitColor));
  scene.lights = {make_sun(vec3(0.0F, 0.0F, -1.0F), 8.0F)};
  return scene;
}

/// Returns a view that the stripes fill from left to right.
View make_stripes_view(const uvec2& size, uint32_t samples = 1) {
  View view = make_board_view(size, samples);
  view.camera.ymag = static_cast<float>(size.y) / static_cast<float>(size.x);
  return view;
}

class UnlitTest : public DeviceTest {
 protected:
  Renderer renderer(const TunedRendererOptions& options) const { return make_renderer(device(), scene_, options); }
  RenderResult trace(View view, TunedRendererOptions options = {}) const {
    view.max_depth = 2;
    options.aovs.unlit = true;
    options.has_error_target = view.error_target.has_value();
    return renderer(options).render(view);
  }

  const Scene scene_ = make_stripes();
};

TEST_F(UnlitTest, TheShareIsWhatTheCameraSeesDirectly) {
  const RenderResult result = trace(make_stripes_view(uvec2(kStripes, 1)));
  const std::vector<vec4>& unlit = result.aovs.unlit;
  EXPECT_EQ(unlit[0], vec4(kUnlitColor, 1.0F));
  EXPECT_EQ(result.image.pixels[0], kUnlitColor);
  EXPECT_EQ(unlit[1], vec4(0.0F));
  EXPECT_EQ(unlit[2], 0.75F * vec4(kUnlitColor, 1.0F));
  EXPECT_EQ(unlit[3], 0.25F * vec4(kUnlitColor, 1.0F));
  EXPECT_EQ(unlit[4], vec4(0.0F)) << "a mirror shows light";
  EXPECT_EQ(result.image.pixels[4], 0.5F * kUnlitColor);
}

TEST_F(UnlitTest, NoTransformChangesAnUnlitColourAndItChangesNoOther) {
  const RenderResult result = trace(make_stripes_view(uvec2(kStripes, 1)));
  for (const ToneMapping mapping :
       {ToneMapping::kNone, ToneMapping::kNeutral, ToneMapping::kAces, ToneMapping::kReinhard, ToneMapping::kAgx}) {
    for (const float stops : {-4.0F, 0.0F, 6.0F}) {
      const DisplayTransform display{stops, mapping};
      std::array<vec3, kStripes> shown;
      for (size_t i = 0; i < kStripes; ++i) {
        shown[i] = apply(display, result.image.pixels[i], result.aovs.unlit[i]);
      }
      EXPECT_EQ(shown[0], kUnlitColor);
      EXPECT_EQ(shown[1], apply(display, result.image.pixels[1]));
      EXPECT_EQ(shown[4], apply(display, result.image.pixels[4]));
      // The light on the blending surface is that on the stripe beside it; shadows go through it.
      const vec3 lit = apply(display, result.image.pixels[1]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(shown[2][c], 0.75F * kUnlitColor[c] + 0.25F * lit[c], 1e-5F * (1.0F + lit[c]));
      }
    }
  }
}

// Edges go through all pixels: 3 pixels show 5 stripes.
TEST_F(UnlitTest, EdgesCountByTheirShare) {
  View view = make_stripes_view(uvec2(3, 2), 16);
  const RenderResult result = trace(view);
  EXPECT_NEAR(result.aovs.unlit[0].w, 0.6F, 0.1F);
  const vec4 expected = result.aovs.unlit[0].w * vec4(kUnlitColor, 1.0F);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.aovs.unlit[0][c], expected[c], 1e-6F);
  // Packets change no bit, and the picture is the same if the fraction is not requested.
  TunedRendererOptions single;
  single.packet_size = 1;
  const RenderResult same = trace(view, single);
  EXPECT_EQ(same.aovs.unlit, result.aovs.unlit);
  view.max_depth = 2;
  EXPECT_TRUE(has_same_bits(renderer({}).render(view).image, result.image));
  view.error_target = ErrorTarget{.error = 1.0F / 64.0F, .min_samples = 16, .max_samples = 64};
  view.error_target->display = DisplayTransform{3.0F, ToneMapping::kNeutral};
  const RenderResult refined = trace(view);
  EXPECT_NEAR(refined.aovs.unlit[0].w, 0.6F, 0.03F);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(refined.aovs.unlit[0][c], refined.aovs.unlit[0].w * kUnlitColor[c], 1e-6F);
  }
}

}  // namespace
}  // namespace promin::test
