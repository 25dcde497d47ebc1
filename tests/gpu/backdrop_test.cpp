// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check a backdrop (docs/model.md, "Backdrop"): how the camera, glass and mirrors see it, and which pixels
// are shown unchanged.
#include <gtest/gtest.h>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/display.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

const vec3 kColor(0.25F, 0.5F, 0.75F);
constexpr float kFactor = 4.0F;
constexpr uint32_t kColumns = 5;

/// Adds a board in one column of the picture that make_columns_view shows.
void add_column(Scene& scene, uint32_t column, const Material& material) {
  Mesh board = make_board();
  for (vec3& position : board.positions) {
    position.x = (2.0F * static_cast<float>(column) + position.x + 1.0F) / static_cast<float>(kColumns) - 1.0F;
  }
  scene.materials.push_back(material);
  scene.add("column", board, static_cast<uint32_t>(scene.materials.size() - 1));
}

Material make_phong_material(const Phong& phong) {
  Material material;
  material.model = phong;
  return material;
}

/// Returns columns from the left: nothing, a lit board, a quarter of it before nothing, a mirror of half, and a pane of
/// clear glass.
Scene make_columns() {
  const Phong lit{.ambient = vec3(0.0F), .diffuse = vec3(0.5F)};
  Scene scene;
  scene.environment.backdrop = Backdrop{kColor, kColor, kFactor};
  add_column(scene, 1, make_phong_material(lit));
  Material quarter = make_phong_material(lit);
  quarter.alpha_mode = AlphaMode::kBlend;
  quarter.alpha = 0.25F;
  add_column(scene, 2, quarter);
  add_column(scene, 3, make_phong_material({.ambient = vec3(0.0F), .diffuse = vec3(0.0F), .reflection = vec3(0.5F)}));
  Material pane;
  pane.model = MetallicRoughness{.metallic = 0.0F, .roughness = 0.0F, .specular = 0.0F, .transmission = 1.0F};
  add_column(scene, 4, pane);
  scene.lights = {make_sun(vec3(0.0F, 0.0F, -1.0F), 8.0F)};
  return scene;
}

View make_columns_view(const uvec2& size, uint32_t samples = 1) {
  View view = make_board_view(size, samples);
  view.camera.ymag = static_cast<float>(size.y) / static_cast<float>(size.x);
  view.max_depth = 3;
  return view;
}

class BackdropTest : public DeviceTest {
 protected:
  static RenderResult trace(const Scene& scene, const View& view, TunedRendererOptions options = {}) {
    options.aovs.unlit = true;
    options.has_error_target = view.error_target.has_value();
    return make_renderer(device(), scene, options).render(view);
  }

  const Scene scene_ = make_columns();
};

TEST_F(BackdropTest, TheCameraSeesItAsShownAndGlassAndMirrorsSeeItAsLight) {
  const RenderResult result = trace(scene_, make_columns_view(uvec2(kColumns, 1)));
  const std::vector<vec3>& seen = result.image.pixels;
  const std::vector<vec4>& unlit = result.aovs.unlit;
  EXPECT_EQ(seen[0], kColor);
  EXPECT_EQ(unlit[0], vec4(kColor, 1.0F));
  EXPECT_EQ(unlit[1], vec4(0.0F));
  EXPECT_EQ(unlit[2], 0.75F * vec4(kColor, 1.0F));
  EXPECT_EQ(seen[2], 0.25F * seen[1] + 0.75F * kColor);
  EXPECT_EQ(unlit[3], vec4(0.0F));
  EXPECT_EQ(seen[3], 0.5F * kFactor * kColor);
  EXPECT_EQ(unlit[4], vec4(0.0F));
  EXPECT_EQ(seen[4], kFactor * kColor);
  for (const ToneMapping mapping :
       {ToneMapping::kNone, ToneMapping::kNeutral, ToneMapping::kAces, ToneMapping::kReinhard, ToneMapping::kAgx}) {
    EXPECT_EQ(apply({3.0F, mapping}, seen[0], unlit[0]), kColor);
  }
}

TEST_F(BackdropTest, NoFormOfThePictureChangesABit) {
  const View view = make_columns_view(uvec2(2 * kColumns + 1, 2), 16);
  const RenderResult result = trace(scene_, view);
  const vec4 edge = result.aovs.unlit[1];
  EXPECT_GT(edge.w, 0.0F);
  TunedRendererOptions forced;
  forced.packet_size = 1;
  forced.more_features = all_features();
  const RenderResult same = trace(scene_, view, forced);
  EXPECT_EQ(same.aovs.unlit, result.aovs.unlit);
  EXPECT_TRUE(has_same_bits(same.image, result.image));
  EXPECT_TRUE(has_same_bits(make_renderer(device(), scene_, {}).render(view).image, result.image));
  // The light of the backdrop is not the light of a surface. Without a backdrop, exposure and tone mapping change all
  // pixels.
  Scene plain = scene_;
  plain.environment.backdrop.reset();
  plain.environment.background = kColor;
  for (const vec4& unlit : trace(plain, view, forced).aovs.unlit) EXPECT_EQ(unlit, vec4(0.0F));
}

TEST_F(BackdropTest, APictureWithAlphaHasNone) {
  TunedRendererOptions options;
  options.aovs.alpha = true;
  const View view = make_columns_view(uvec2(kColumns, 1));
  const RenderResult result = trace(scene_, view, options);
  EXPECT_EQ(result.image.pixels[0], vec3(0.0F));
  EXPECT_EQ(result.aovs.alpha[0], 0.0F);
  for (const vec4& unlit : result.aovs.unlit) EXPECT_EQ(unlit, vec4(0.0F));
}

TEST_F(BackdropTest, AGradientIsEvenOverTheRowsOfAnyCamera) {
  Scene scene;
  scene.environment.backdrop = Backdrop{vec3(1.0F, 0.5F, 0.0F), vec3(0.0F, 0.5F, 1.0F)};
  View view = make_columns_view(uvec2(4, 7), 16);
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    view.camera.projection = projection;
    const RenderResult result = trace(scene, view);
    for (uint32_t y = 0; y < view.size.y; ++y) {
      const float height = (static_cast<float>(y) + 0.5F) / static_cast<float>(view.size.y);
      const vec3& seen = result.image.at(2, y);
      EXPECT_NEAR(seen.x, 1.0F - height, 1e-6F) << "all samples of a pixel see the same";
      EXPECT_EQ(seen.y, 0.5F);
      EXPECT_NEAR(seen.z, height, 1e-6F);
      EXPECT_EQ(result.image.at(0, y), seen);
      EXPECT_EQ(result.aovs.unlit[y * view.size.x].w, 1.0F);
    }
    View crop = view;
    crop.crop = PixelWindow{uvec2(1, 3), uvec2(3, 5)};
    EXPECT_EQ(trace(scene, crop).image.at(0, 0), result.image.at(1, 3));
    View refined = view;
    refined.error_target = ErrorTarget{.error = 1.0F / 256.0F, .min_samples = 16, .max_samples = 64};
    refined.error_target->display = DisplayTransform{1.0F, ToneMapping::kNeutral};
    const RenderResult same = trace(scene, refined);
    EXPECT_EQ(same.error->largest_claim, 0.0F) << "a backdrop has no errors";
    EXPECT_NEAR(same.image.at(2, 3).x, 0.5F, 1e-6F);
  }
}

}  // namespace
}  // namespace promin::test
