// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check the panel of an explained pixel, laid out in memory, and its place beside the model.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <memory>

#include "gpu/test_scenes.h"
#include "view/panel/overlay.h"
#include "view/panel/show_explanation.h"

namespace promin::app {
namespace {

constexpr double kAspectRatio = 1280.0 / 720.0;

TEST(ScreenCover, APanelHidesLittle) {
  const dvec2 size(0.3, 0.4);
  const dvec2 margin(0.02, 0.03);
  const auto corner = [&](const ScreenCover& cover) { return choose_corner(cover, size, margin).lo; };
  ScreenCover cover;
  EXPECT_EQ(corner(cover), dvec2(1.0 - 0.02 - 0.3, 0.03));
  cover.raise_line({0.7, 0.0}, {1.0, 0.2}, 1.0F);
  EXPECT_EQ(corner(cover), 1.0 - margin - size);
  cover.raise_triangle({dvec2(0.5, 1.0), dvec2(1.0, 0.5), dvec2(1.5, 1.5)}, 1.0F);
  EXPECT_EQ(corner(cover), dvec2(0.02, 1.0 - 0.03 - 0.4));
  cover.raise({0.1, 0.9}, 1e3F);
  cover.raise_area({{0.0, 0.0}, {0.3, 0.4}}, 10.0F);
  EXPECT_EQ(corner(cover), dvec2(1.0 - 0.02 - 0.3, 0.03)) << "a line costs least";
  EXPECT_EQ(choose_corner(cover, {2.0, 2.0}, margin).lo, margin) << "what does not fit begins within the window";
}

/// Returns a board as high as the picture, at this place to the right of the middle, in halves of that height.
Scene make_scene(float right) {
  Scene scene;
  scene.geometries.emplace_back(test::make_board());
  scene.materials.emplace_back();
  scene.objects.push_back({.name = "board", .geometry = 0});
  scene.objects.back().world_from_object[3].x = double{right};
  return scene;
}

TEST(ScreenCover, KnowsWhereAModelIs) {
  const Camera camera = test::make_board_view(uvec2(1280, 720)).camera;
  const ScreenCover cover = find_cover(make_scene(0.5F), camera, kAspectRatio);
  const auto share_of = [&](double lo, double hi) {
    return cover.cost_of({{lo, 0.0}, {hi, 1.0}}) / (hi - lo) / (ScreenCover::kColumns * ScreenCover::kRows);
  };
  const double left_edge = 0.5 - 0.25 / kAspectRatio;
  const double right_edge = 0.5 + 0.75 / kAspectRatio;
  EXPECT_EQ(share_of(0.0, left_edge - 0.02), 0.0);
  EXPECT_NEAR(share_of(left_edge + 0.02, right_edge - 0.02), 1.0, 0.05);
  EXPECT_EQ(share_of(right_edge + 0.02, 1.0), 0.0);
}

TEST(ScreenCover, KnowsTheWallsOfARoom) {
  Camera camera = test::make_board_view(uvec2(1280, 720)).camera;
  camera.projection = Projection::kPerspective;
  camera.yfov = 1.0F;
  // The floor extends from the front of the camera to the space behind it.
  Scene scene = make_scene(0.0F);
  scene.objects.back().world_from_object = dmat4(dvec4(4.0, 0.0, 0.0, 0.0), dvec4(0.0, 0.0, -4.0, 0.0),
                                                 dvec4(0.0, 1.0, 0.0, 0.0), dvec4(0.0, -1.0, 0.0, 1.0));
  const ScreenCover cover = find_cover(scene, camera, kAspectRatio);
  EXPECT_EQ(cover.cost_of({dvec2(0.0), {1.0, 0.5}}), 0.0);
  EXPECT_GT(cover.cost_of({{0.0, 0.5}, dvec2(1.0)}), 0.3 * 0.5 * ScreenCover::kColumns * ScreenCover::kRows);
}

class ExplanationPanelTest : public testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = ImVec2(1280.0F, 720.0F);
    use_scale({});
  }
  void TearDown() override { ImGui::DestroyContext(); }

  static void use_scale(const OverlayScale& scale) {
    scale_overlay(scale);
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }

  /// Returns a pixel that sees a board through this number of rays.
  static ExplainedPixel explain(float right, size_t ray_count) {
    const auto scene = std::make_shared<const Scene>(make_scene(right));
    ExplainedSample sample;
    sample.rays.resize(ray_count);
    for (ExplainedRay& ray : sample.rays) {
      ray.hit.object = 0;
      ray.kind = &ray == &sample.rays.front() ? RayKind::kCamera : RayKind::kReflection;
    }
    ExplainedPixel pixel{.title = "a pixel", .explanation = {}, .scene = scene, .cover = {}};
    pixel.explanation.samples.push_back(sample);
    pixel.cover = find_cover(*scene, camera(), kAspectRatio);
    return pixel;
  }
  static Camera camera() { return test::make_board_view(uvec2(1280, 720)).camera; }

  /// Returns the panel's position after it has stopped moving.
  WindowArea show(const std::optional<WindowArea>& other = std::nullopt) {
    for (int i = 0; i < 3; ++i) {
      ImGui::GetIO().DeltaTime = 0.1F;
      ImGui::NewFrame();
      panel_.show(camera(), {}, other);
      ImGui::Render();
    }
    WindowArea area{dvec2(1e9), dvec2(-1e9)};
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; ++i) {
      if (data.CmdLists[i] == ImGui::GetBackgroundDrawList()) continue;
      for (const ImDrawVert& vertex : data.CmdLists[i]->VtxBuffer) {
        area.lo = glm::min(area.lo, dvec2(vertex.pos.x, vertex.pos.y));
        area.hi = glm::max(area.hi, dvec2(vertex.pos.x, vertex.pos.y));
      }
    }
    return area;
  }

  ExplanationPanel panel_;
};

TEST_F(ExplanationPanelTest, IsAsHighAsItsTextBesideTheModel) {
  panel_.open(explain(0.5F, 1));
  const WindowArea area = show();
  EXPECT_LT(area.hi.y - area.lo.y, 8.0F * ImGui::GetTextLineHeightWithSpacing());
  EXPECT_LT(area.hi.x, 640.0 - 0.5 * 360.0);
  // The model goes to the left, and the panel to the right.
  panel_.open(explain(-0.5F, 1));
  EXPECT_GT(show().lo.x, 640.0 + 0.5 * 360.0);
}

TEST_F(ExplanationPanelTest, StandsWhereTheOtherPanelIsNot) {
  panel_.open(explain(0.5F, 1));
  const WindowArea area = show(WindowArea{{0.0, 0.6}, {0.3, 1.0}});
  EXPECT_LT(area.hi.x, 640.0 - 0.5 * 360.0);
  EXPECT_LT(area.hi.y, 0.6 * 720.0);
}

TEST_F(ExplanationPanelTest, ScrollsWhereItDoesNotFit) {
  panel_.open(explain(0.0F, 60));
  const WindowArea area = show();
  EXPECT_GT(area.hi.y - area.lo.y, 600.0);
  EXPECT_GE(area.lo.y, 0.0);
  EXPECT_LE(area.hi.y, 720.0);
}

TEST_F(ExplanationPanelTest, ClosesRaysOfLittleWeight) {
  ExplainedPixel pixel = explain(0.0F, 30);
  for (ExplainedRay& ray : pixel.explanation.samples.front().rays) {
    if (ray.kind != RayKind::kCamera) ray.weight = vec3(0.01F);
  }
  panel_.open(pixel);
  const WindowArea area = show();
  EXPECT_LT(area.hi.y - area.lo.y, 34.0F * ImGui::GetTextLineHeightWithSpacing());
}

TEST_F(ExplanationPanelTest, StandsInTheSmallestWindow) {
  ImGui::GetIO().DisplaySize = ImVec2(8.0F, 8.0F);
  panel_.open(explain(0.0F, 60));
  show();
  EXPECT_TRUE(panel_.is_open());
}

TEST_F(ExplanationPanelTest, HelpNeedsRoomBesideThePanel) {
  ImGui::NewFrame();
  EXPECT_TRUE(has_room_beside_help());
  ImGui::Render();
  use_scale({2.0, 1.0});
  ImGui::NewFrame();
  EXPECT_FALSE(has_room_beside_help());
  ImGui::Render();
}

}  // namespace
}  // namespace promin::app
