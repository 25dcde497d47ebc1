// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check the overlay without a window: its panel is laid out and clicked in memory.

#include "view/panel/overlay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "device/device.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"

namespace promin::app {
namespace {

class OverlayTest : public test::DeviceTest {
 protected:
  void SetUp() override {
    picture_.emplace(device(),
                     upload_scene(device(), pack_scene(scene_, "sah"),
                                  {scene_.materials, scene_.textures, scene_.lights, scene_.environment}),
                     features_of(scene_), 1.0);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = ImVec2(1000.0F, 1000.0F);
    use_scale({});
    switches_.scene.builder = "sah";
  }
  void TearDown() override { ImGui::DestroyContext(); }

  void use_scale(const OverlayScale& scale) {
    scale_overlay(scale);
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    for (int i = 0; i < 3; ++i) show({-1.0F, -1.0F}, false);  // repeats until the panel no longer moves
  }

  void show(const ImVec2& pointer, bool is_down) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 0.1F;
    io.MousePos = pointer;
    io.MouseDown[0] = is_down;
    ImGui::NewFrame();
    OverlayContent content;
    content.statistics = &statistics_;
    content.picture = &*picture_;
    content.scene = &described_;
    content.device = "device";
    content.entry = entry_ ? &*entry_ : nullptr;
    answer_ = show_overlay(content, switches_);
    ImGui::Render();
  }

  static void set_key(ImGuiKey key, bool is_down) {
#if IMGUI_VERSION_NUM >= 18700
    ImGui::GetIO().AddKeyEvent(key, is_down);
#else
    ImGui::GetIO().KeyMap[key] = key;
    ImGui::GetIO().KeysDown[key] = is_down;
#endif
  }

  /// Presses a key, and collects its effects.
  void press(ImGuiKey key) {
    OverlayAnswer sum;
    for (const bool is_down : {true, false, false}) {
      set_key(key, is_down);
      show({-1.0F, -1.0F}, false);
      sum.has_typed = sum.has_typed || answer_.has_typed;
      sum.gives_up = sum.gives_up || answer_.gives_up;
    }
    answer_ = sum;
  }

  void click(const ImVec2& place) {
    for (const bool is_down : {false, true, false, false}) show(place, is_down);
  }

  /// Clicks on points along the panel's left side, from top to bottom, until a click has an effect.
  template <typename Effect>
  bool click_until(const Effect& has_effect) {
    for (float y = 20.0F; y < 400.0F && !has_effect(); y += 5.0F) click({25.0F, y});
    return has_effect();
  }

  /// Returns how far the drawing reaches to the right.
  static float drawn_width() {
    float width = 0.0F;
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; ++i) {
      for (const ImDrawVert& vertex : data.CmdLists[i]->VtxBuffer) width = std::max(width, vertex.pos.x);
    }
    return width;
  }

  const world::Scene scene_ = test::make_scene_of_everything();
  /// The scene whose lights and cameras the overlay lists.
  const Scene described_ = [this] {
    Scene scene;
    scene.lights = scene_.lights;
    scene.cameras = scene_.cameras;
    return scene;
  }();
  FrameStatistics statistics_;
  std::optional<ProgressivePicture> picture_;
  Switches switches_;
  std::optional<PathEntry> entry_;
  OverlayAnswer answer_;
};

TEST_F(OverlayTest, AClickTurnsASwitch) {
  ASSERT_TRUE(click_until([&] { return !switches_.has_shadows; }));
  ASSERT_TRUE(click_until([&] { return switches_.has_shadows; }));
  EXPECT_TRUE(switches_.has_mirrors);
}

TEST_F(OverlayTest, ASliderChangesTheDepth) {
  const uint32_t before = switches_.max_depth;
  EXPECT_TRUE(click_until([&] { return switches_.max_depth != before; }));
}

TEST_F(OverlayTest, AScaleOfTheCommandLineHasAName) {
  switches_.scale = 0.3;
  show({-1.0F, -1.0F}, false);
  EXPECT_EQ(switches_.scale, 0.3);
}

TEST_F(OverlayTest, APathIsTypedAtOnceAndEscapeGivesItUp) {
  for (const bool is_typed : {true, false}) {
    entry_.emplace();
    for (int i = 0; i < 3; ++i) show({-1.0F, -1.0F}, false);
    EXPECT_TRUE(ImGui::GetIO().WantTextInput);
    ImGui::GetIO().AddInputCharactersUTF8("a.png");
    show({-1.0F, -1.0F}, false);
    EXPECT_STREQ(entry_->text.data(), "a.png");
    press(is_typed ? ImGuiKey_Enter : ImGuiKey_Escape);
    EXPECT_EQ(answer_.has_typed, is_typed);
    EXPECT_EQ(answer_.gives_up, !is_typed);
    entry_.reset();
    show({-1.0F, -1.0F}, false);
  }
}

TEST(OverlayWordsTest, SayHowAccurateAPictureIs) {
  ShownPicture shown;
  shown.size = uvec2(100, 50);
  shown.error = PictureError{.target = 0.125F, .largest_claim = 1.0F / 9.0F, .unmet_pixels = 0, .samples = 64500};
  shown.wanted_error = 1.0F / 64.0F;
  shown.finished_pixels = 4999;
  EXPECT_EQ(describe_accuracy(shown, false),
            "sharpening: 99.9 % of pixels within 1/64\n12.9 samples per pixel, largest error 1/9");
  shown.finished_pixels = 5000;
  shown.error->largest_claim = 0.0F;
  shown.wanted_error = 0.02F;
  EXPECT_EQ(describe_accuracy(shown, true),
            "done: 100 % of pixels within 1/50\n12.9 samples per pixel, largest error 0");
  shown.error->largest_claim = 3.0F;
  shown.wanted_error = 2.0F;
  EXPECT_THAT(describe_accuracy(shown, true), testing::EndsWith(" within 2\n12.9 samples per pixel, largest error 3"));
}

TEST_F(OverlayTest, GrowsWithTheDisplaysScale) {
  const float width = drawn_width();
  EXPECT_GT(width, 200.0F);
  // On this display, a unit of the window's coordinates is one pixel.
  use_scale({2.0, 1.0});
  EXPECT_NEAR(drawn_width(), 2.0F * width, 0.05F * width);
  // On this display a unit is two pixels. The system scales the window, and the overlay's fonts have more pixels.
  use_scale({2.0, 2.0});
  EXPECT_NEAR(drawn_width(), width, 0.05F * width);
}

}  // namespace
}  // namespace promin::app
