// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check pixel filters beside a straight edge, where their results have a closed form.
#include <gtest/gtest.h>

#include "device_scene/sampling.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

constexpr float kEdge = 0.25F;

class PixelFilterTest : public DeviceTest {
 protected:
  /// Returns a scene that is white to the right of an edge at x = kEdge and black to the left.
  static world::Scene make_edge() {
    world::Scene scene;
    Mesh mesh;
    mesh.positions = {{kEdge, -100, 0}, {100, -100, 0}, {100, 100, 0}, {kEdge, 100, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.objects = {{"edge", mesh, 0}};
    scene.materials = {make_unlit(vec3(1.0F), AlphaMode::kOpaque, 1.0F)};
    return scene;
  }
  /// Returns a view whose pixels have sides of 1 and centres at -3.5...3.5.
  static View look_at_it(PixelFilter filter, float width) {
    View view;
    view.camera.eye = vec3(0, 0, 2);
    view.camera.projection = Projection::kOrthographic;
    view.camera.ymag = 4.0F;
    view.size = uvec2(8);
    view.samples_per_pixel = 256;
    view.filter = filter;
    view.filter_width = width;
    return view;
  }
};

TEST_F(PixelFilterTest, AnEdgeIsAsSoftAsTheFilterIsWide) {
  Renderer renderer = make_renderer(device(), make_edge());
  for (size_t number = 0; number < pixel_filter_names().size(); ++number) {
    const auto filter = static_cast<PixelFilter>(number);
    for (const float width : {default_width(filter), 5.0F}) {
      SCOPED_TRACE(testing::Message() << pixel_filter_names()[number] << " " << width);
      const View view = look_at_it(filter, width);
      const Image image = renderer.render(view).image;
      for (uint32_t x = 0; x < 8; ++x) {
        constexpr int kShares = 1 << 14;
        int beyond = 0;
        for (int i = 0; i < kShares; ++i) {
          const double place = place_of_share(filter, static_cast<double>(width), (i + 0.5) / kShares);
          beyond += x - 3.5 + place > static_cast<double>(kEdge) ? 1 : 0;
        }
        EXPECT_NEAR(image.at(x, 4).x, static_cast<double>(beyond) / kShares, 1.0 / 256) << x;
      }
    }
  }
}

TEST_F(PixelFilterTest, ACropHasTheBitsOfTheWhole) {
  Renderer renderer = make_renderer(device(), make_scene_of_everything(10));
  View view = make_view({40, 30});
  view.samples_per_pixel = 5;
  view.filter = PixelFilter::kBlackmanHarris;
  view.filter_width = 3.0F;
  const Image whole = renderer.render(view).image;
  view.crop = PixelWindow{uvec2(7, 9), uvec2(31, 22)};
  const Image crop = renderer.render(view).image;
  for (uint32_t y = 0; y < crop.size.y; ++y) {
    for (uint32_t x = 0; x < crop.size.x; ++x) EXPECT_EQ(crop.at(x, y), whole.at(x + 7, y + 9));
  }
}

}  // namespace
}  // namespace promin::test
