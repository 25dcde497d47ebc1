// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/progressive_picture.h"

#include <gtest/gtest.h>

#include "device/device.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/error.h"
#include "promin/renderer.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

const uvec2 kPictureSize(150, 100);  // neither number is a multiple of the block's size

class ProgressivePictureTest : public test::DeviceTest {
 protected:
  ProgressivePicture make_picture(FeatureMask requests = {}) const {
    const PackedScene packed = pack_scene(scene_, "sah");
    ProgressivePicture picture(
        device(),
        upload_scene(device(), packed, {scene_.materials, scene_.textures, scene_.lights, scene_.environment}),
        features_of(scene_) | requests, 1.0);
    picture.resize(kPictureSize);
    return picture;
  }

  /// Records a frame's tracing and waits for it, but does not report the time, so that budgets stay as small as
  /// possible.
  double trace(ProgressivePicture& picture) const {
    double units = 0.0;
    device().run([&](const vk::raii::CommandBuffer& commands) { units = picture.record(commands); });
    return units;
  }

  /// Returns the shown picture.
  static Image read(const ProgressivePicture& picture) {
    const ShownPicture& shown = *picture.shown();
    Image image{shown.size, std::vector<vec3>(size_t{shown.size.x} * shown.size.y)};
    std::vector<uvec4> records(image.pixels.size());
    picture.film(shown.film).read(std::as_writable_bytes(std::span(records)), Film::kPixelsOffset);
    average_samples(records, shown.samples_per_pixel, image.pixels);
    return image;
  }

  const world::Scene scene_ = test::make_scene_of_everything();
};

TEST_F(ProgressivePictureTest, EveryLevelIsWhatTheRendererGives) {
  ProgressivePicture picture = make_picture();
  Renderer renderer = make_renderer(device(), scene_);
  View view = test::make_view(kPictureSize);
  picture.want(view);
  for (const uint32_t samples : {1U, 4U, 16U}) {
    view.samples_per_pixel = samples;
    while (!picture.is_complete() || picture.shown()->samples_per_pixel != samples) trace(picture);
    EXPECT_TRUE(test::has_same_bits(read(picture), renderer.render(view).image)) << samples << " spp";
  }
}

// In these frames one piece ends and the next begins, with all samples of some blocks and a few of others.
TEST_F(ProgressivePictureTest, NoBudgetChangesABit) {
  Renderer renderer = make_renderer(device(), scene_);
  View view = test::make_view(kPictureSize);
  view.samples_per_pixel = 16;
  const Image expected = renderer.render(view).image;
  for (const double units : {150.0, 1050.0, 3000.0}) {
    ProgressivePicture picture = make_picture();
    picture.take_finished({.units = 1.0, .time_ms = 1.0});  // the first time is not used
    picture.want(view);
    while (!picture.is_complete() || picture.shown()->samples_per_pixel != 16) {
      picture.take_finished({.units = units, .time_ms = 1.0});
      trace(picture);
    }
    EXPECT_TRUE(test::has_same_bits(read(picture), expected)) << units << " units a frame";
  }
}

TEST_F(ProgressivePictureTest, IsRefinedStepByStepAndThenRests) {
  ProgressivePicture picture = make_picture();
  picture.resize(uvec2(16, 16));
  picture.want(test::make_view(kPictureSize));
  std::vector<uint32_t> levels;
  while (!picture.is_settled()) {
    trace(picture);
    const uint32_t samples = picture.shown()->samples_per_pixel;
    if (levels.empty() || levels.back() != samples) levels.push_back(samples);
  }
  EXPECT_EQ(levels, (std::vector<uint32_t>{1, 4, 16, 64}));
  EXPECT_EQ(trace(picture), 0.0);
}

View with_target(View view, float error) {
  view.error_target = ErrorTarget{.error = error, .min_samples = 4, .max_samples = 32};
  return view;
}

TEST_F(ProgressivePictureTest, EveryErrorIsWhatTheRendererGives) {
  ProgressivePicture picture = make_picture();
  Renderer renderer = make_renderer(device(), scene_);
  const View view = with_target(test::make_view(kPictureSize), 1.0F / 16.0F);
  picture.want(view);
  std::vector<float> errors;
  while (!picture.is_settled()) {
    const uint64_t shown_count = picture.shown_count();
    picture.trace();
    if (picture.shown_count() == shown_count || !picture.shown()->error) continue;
    const PictureError& error = *picture.shown()->error;
    errors.push_back(error.target);
    const RenderResult expected = renderer.render(picture.shown()->view_of(view));
    EXPECT_TRUE(test::has_same_bits(read(picture), expected.image)) << error.target;
    EXPECT_EQ(error.largest_claim, expected.error->largest_claim);
    EXPECT_EQ(error.unmet_pixels, expected.error->unmet_pixels);
    EXPECT_EQ(error.samples, expected.error->samples);
    EXPECT_EQ(error.first_samples, 4U);
    EXPECT_EQ(expected.error->first_samples, 4U);
    EXPECT_EQ(picture.shown()->wanted_error, view.error_target->error);
    const uint64_t area = uint64_t{kPictureSize.x} * kPictureSize.y;
    if (error.target == view.error_target->error) {
      EXPECT_EQ(picture.shown()->finished_pixels, area - error.unmet_pixels);
    } else {
      EXPECT_LT(picture.shown()->finished_pixels, area - error.unmet_pixels);
    }
  }
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(errors.front(), 0.125F);
  EXPECT_EQ(errors.back(), 1.0F / 16.0F);
  EXPECT_EQ(trace(picture), 0.0);
}

// Samples of soft and scattered light choose their points by the numbers of the samples, also in lists.
TEST_F(ProgressivePictureTest, SoftLightIsRefinedToWhatTheRendererGives) {
  const uvec2 size(48, 32);
  world::Scene scene = scene_;
  scene.lights[0].angle = 0.2F;
  SetupStats stats;
  const SceneOnDevice on_device(device(), scene, {}, stats);
  for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
    View view = with_target(test::make_view(size), 1.0F / 16.0F);
    view.mode.integrator = integrator;
    ProgressivePicture picture(device(), on_device.device_scene(), on_device.features(view.mode), 1.0);
    picture.resize(size);
    picture.want(view);
    while (!picture.is_settled()) picture.trace();
    TunedRendererOptions options;
    options.mode = view.mode;
    options.has_error_target = true;
    const RenderResult expected = make_renderer(device(), scene, options).render(view);
    EXPECT_GT(expected.error->samples, 16U * size.x * size.y);
    EXPECT_TRUE(test::has_same_bits(read(picture), expected.image)) << static_cast<int>(integrator);
    EXPECT_EQ(picture.shown()->error->samples, expected.error->samples);
    EXPECT_EQ(picture.shown()->error->largest_claim, expected.error->largest_claim);
    EXPECT_EQ(picture.shown()->error->first_samples, expected.error->first_samples);
    if (integrator == Integrator::kPath) {
      EXPECT_EQ(expected.error->first_samples, 16U);
    }
  }
}

// A refined picture is written to a film that has held a smaller one, with a second record for unlit surfaces.
TEST_F(ProgressivePictureTest, RefinedFilmsAreAsIfTracedAndTellOfUnlitSurfaces) {
  ProgressivePicture picture = make_picture(layout::FEATURE_UNLIT_SHARE);
  ASSERT_TRUE(picture.has_unlit());
  picture.fix_scale(0.25);
  const View view = with_target(test::make_view(kPictureSize), 1.0F / 8.0F);
  picture.want(view);
  while (!picture.is_settled()) picture.trace();
  const gpu::Buffer& film = picture.film(picture.shown()->film);
  layout::FilmHead head;
  film.read(std::as_writable_bytes(std::span(&head, 1)), 0);
  EXPECT_EQ(head.dispatch.window, uvec4(0, 0, kPictureSize));
  EXPECT_EQ(head.dispatch.sampling.x, 1U);
  std::vector<vec4> records(size_t{2} * kPictureSize.x * kPictureSize.y);
  film.read(std::as_writable_bytes(std::span(records)), Film::kPixelsOffset);
  TunedRendererOptions options;
  options.aovs.unlit = true;
  options.has_error_target = true;
  const RenderResult expected = make_renderer(device(), scene_, options).render(picture.shown()->view_of(view));
  EXPECT_TRUE(test::has_same_bits(read(picture), expected.image));
  const std::vector<vec4> unlit(records.begin() + kPictureSize.x * kPictureSize.y, records.end());
  EXPECT_EQ(unlit, expected.aovs.unlit);
  EXPECT_TRUE(std::ranges::any_of(unlit, [](const vec4& one) { return one.w == 1.0F; }));
}

// Samples in progress are lost when the view changes, and a pause delays samples that have not begun.
TEST_F(ProgressivePictureTest, AChangedViewIsRefinedFromItsOwnSamples) {
  ProgressivePicture picture = make_picture();
  View view = with_target(test::make_view(kPictureSize), 1.0F / 8.0F);
  picture.want(view);
  while (!picture.has_recorded_list()) {
    picture.trace();
    ASSERT_FALSE(picture.is_settled());
  }
  EXPECT_GT(picture.fraction_done(), 0.0);
  EXPECT_LT(picture.fraction_done(), 1.0);
  double units = 0.0;
  device().run([&](const vk::raii::CommandBuffer& commands) { units = picture.record(commands); });
  ASSERT_GT(units, 0.0);
  ASSERT_TRUE(picture.has_recorded_list());
  EXPECT_TRUE(picture.awaits_samples());
  EXPECT_EQ(trace(picture), 0.0);
  view.camera.eye.x += 0.25F;
  picture.want(view);
  EXPECT_FALSE(picture.awaits_samples());
  trace(picture);
  EXPECT_FALSE(picture.has_recorded_list());
  picture.take_finished({.units = units, .time_ms = 1.0, .has_list = true});
  picture.pause(true);
  while (!picture.is_settled()) picture.trace();
  EXPECT_FALSE(picture.shown()->error);
  picture.pause(false);
  while (!picture.is_settled()) picture.trace();
  EXPECT_TRUE(test::has_same_bits(read(picture), make_renderer(device(), scene_).render(view).image));
}

// While an animation plays, views have no error target, but the refined picture stays until the next one is traced.
TEST_F(ProgressivePictureTest, ARefinedPictureKnowsItsErrorWhenTheNextViewHasNone) {
  ProgressivePicture picture = make_picture();
  View view = with_target(test::make_view(kPictureSize), 1.0F / 8.0F);
  picture.want(view);
  while (!picture.is_settled()) picture.trace();
  ASSERT_TRUE(picture.shown()->error);
  view.error_target.reset();
  picture.want(view);
  EXPECT_FALSE(picture.wanted().error_target);
  ASSERT_TRUE(picture.shown()->error);
  EXPECT_EQ(picture.shown()->wanted_error, 1.0F / 8.0F);
  while (!picture.is_settled()) picture.trace();
  EXPECT_FALSE(picture.shown()->error);
  EXPECT_EQ(picture.shown()->wanted_error, 0.0F);
}

// If only the background is visible, the first samples are exact. The picture then reports only the final error.
TEST_F(ProgressivePictureTest, WhatIsExactIsShownOnceMore) {
  ProgressivePicture picture = make_picture();
  View view = with_target(test::make_view(kPictureSize), 1.0F / 4096.0F);
  view.camera.look = vec3(0, 1, 0);
  view.camera.up = vec3(0, 0, 1);
  picture.want(view);
  std::vector<float> errors;
  uint64_t shown_count = 0;
  while (!picture.is_settled()) {
    picture.trace();
    if (picture.shown_count() == shown_count) continue;
    shown_count = picture.shown_count();
    if (picture.shown()->error) errors.push_back(picture.shown()->error->target);
  }
  ASSERT_TRUE(picture.shown()->error);
  ASSERT_EQ(picture.shown()->error->samples, 4U * kPictureSize.x * kPictureSize.y) << "something else is seen";
  EXPECT_EQ(errors, (std::vector<float>{0.125F, 1.0F / 4096.0F}));
}

TEST_F(ProgressivePictureTest, ANewViewComesFirstInFewPixels) {
  ProgressivePicture picture = make_picture();
  View view = test::make_view(kPictureSize);
  picture.want(view);
  while (!picture.is_complete()) trace(picture);
  trace(picture);  // refining is under way
  view.camera.eye.x += 0.25F;
  picture.want(view);
  EXPECT_FALSE(picture.is_complete());
  trace(picture);
  EXPECT_LT(picture.shown()->size.x, kPictureSize.x);
  // The picture has the window's aspect ratio, to a pixel, and shows the new view.
  view.size = picture.shown()->size;
  EXPECT_NEAR(view.size.x * kPictureSize.y, view.size.y * kPictureSize.x, kPictureSize.x + kPictureSize.y);
  EXPECT_TRUE(test::has_same_bits(read(picture), make_renderer(device(), scene_).render(view).image));
}

TEST_F(ProgressivePictureTest, AFirstPictureIsFinishedAlthoughTheViewChanges) {
  ProgressivePicture picture = make_picture();
  picture.fix_scale(1.0);
  View view = test::make_view(kPictureSize);
  for (int frame = 0; !picture.shown(); ++frame) {
    ASSERT_LT(frame, 100);
    view.camera.eye.x += 0.01F;
    picture.want(view);
    trace(picture);
  }
  EXPECT_FALSE(picture.is_complete());
}

TEST_F(ProgressivePictureTest, APausedPictureIsNotRefined) {
  ProgressivePicture picture = make_picture();
  picture.want(test::make_view(kPictureSize));
  picture.pause(true);
  while (!picture.is_settled()) trace(picture);
  ASSERT_TRUE(picture.shown());
  EXPECT_LT(picture.shown()->size.x, kPictureSize.x);
  EXPECT_EQ(trace(picture), 0.0);
  picture.pause(false);
  EXPECT_FALSE(picture.is_settled());
}

TEST_F(ProgressivePictureTest, RestsWhenPausedWhileItIsRefined) {
  ProgressivePicture picture = make_picture();
  picture.want(test::make_view(kPictureSize));
  while (!picture.is_complete()) trace(picture);
  trace(picture);  // refining is under way
  ASSERT_LT(picture.fraction_done(), 1.0);
  picture.pause(true);
  EXPECT_TRUE(picture.is_settled());
  EXPECT_EQ(trace(picture), 0.0);
  picture.pause(false);
  EXPECT_FALSE(picture.is_settled());
}

TEST_F(ProgressivePictureTest, IsRefusedWhereLoopsWereCut) {
  ProgressivePicture picture = make_picture();
  picture.want(test::make_view(kPictureSize));
  trace(picture);
  EXPECT_THROW(picture.take_finished({.units = 1.0, .time_ms = 1.0, .has_cut_loops = true}), RunError);
}

TEST_F(ProgressivePictureTest, AFasterDeviceGetsMorePixels) {
  ProgressivePicture picture = make_picture();
  View view = test::make_view(kPictureSize);
  picture.want(view);
  const double units = trace(picture);
  const uvec2 before = picture.shown()->size;
  picture.take_finished({.units = units, .time_ms = 1.0});  // the first time, which includes compiling, is not used
  picture.take_finished({.units = units, .time_ms = 0.5});
  view.camera.eye.x += 0.25F;
  picture.want(view);
  trace(picture);
  // The picture has twice the pixels, except for blocks that are not full.
  EXPECT_NEAR(picture.shown()->size.x, std::sqrt(2.0) * before.x, 0.12 * before.x);
}

}  // namespace
}  // namespace promin
