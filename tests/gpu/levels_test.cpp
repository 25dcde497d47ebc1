// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare levels of detail (docs/model.md, "Textures") and masks on a device with the oracle. Textures
// are meters: images in which a texel and the one over it on the next level differ by the same step, up or down, in
// each channel. A colour therefore gives the level to a fraction of a step, and a slightly wrong level shows
// everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "gpu/device_fixture.h"
#include "gpu/faulty_shaders.h"
#include "gpu/gallery.h"
#include "gpu/test_scenes.h"
#include "oracle/compare_picture.h"
#include "oracle/texture.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

using oracle::Real;

constexpr uint32_t kMeterLevels = 7;
/// The step between the meter's levels in an 8-bit code; kMeterLevels of them fit on either side of the middle.
constexpr int kMeterStep = 16;
constexpr int kMeterMiddle = 128;

/// The steps of alpha. They are largest at the finest levels. Without scaling, little of a mask would remain on the
/// coarser levels.
constexpr std::array<int, kMeterLevels> kAlphaSteps{48, 32, 16, 12, 8, 6, 4};

/// Returns the meter's code in a channel at a texel of a level. Of the four texels under one texel, two are a step
/// above it and two a step below. In red this depends on their column, in green on their row, in blue on both, in alpha
/// on the column again. A hash decides whether the first ones are above.
int meter_code(uint32_t level, uint32_t x, uint32_t y, uint32_t channel, bool is_line) {
  int code = kMeterMiddle;
  for (; level < kMeterLevels; ++level, x >>= 1U, y >>= 1U) {
    std::minstd_rand hash(1 + 977 * level + 31 * (x >> 1U) + 7919 * (y >> 1U) + 104729 * channel);
    hash.discard(3);
    const std::array<uint32_t, 4> sides{x, y, x ^ y, x};
    const uint32_t side = is_line ? x : sides[channel];
    const int step = channel == 3 ? kAlphaSteps[level] : kMeterStep;
    code += (side ^ (hash() >> 8U)) % 2 == 0 ? step : -step;
  }
  return code;
}

/// Returns a square of 2^kMeterLevels texels on each side, or a line of as many.
std::shared_ptr<const TextureImage> make_meter(bool is_line = false) {
  TextureImage image{.name = "", .size = uvec2(1U << kMeterLevels), .texels = {}, .use = ImageUse::kData};
  if (is_line) image.size.y = 1;
  for (uint32_t y = 0; y < image.size.y; ++y) {
    for (uint32_t x = 0; x < image.size.x; ++x) {
      uint32_t texel = 0;
      for (uint32_t c = 0; c < 4; ++c) texel |= static_cast<uint32_t>(meter_code(0, x, y, c, is_line)) << 8 * c;
      image.texels.push_back(texel);
    }
  }
  return std::make_shared<TextureImage>(image);
}

/// This texture shows one level at a time, without blur.
constexpr Texture kMeter{.is_magnified_linearly = false, .is_minified_linearly = false};
/// This texture is filtered as masks are.
constexpr Texture kSoftMeter{};

Mesh make_quad(const std::array<vec3, 4>& corners, const std::array<vec2, 4>& places, uint32_t cuts = 1) {
  Mesh mesh;
  for (uint32_t j = 0; j <= cuts; ++j) {
    for (uint32_t i = 0; i <= cuts; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(cuts);
      const float t = static_cast<float>(j) / static_cast<float>(cuts);
      const auto between = [&](const auto& c) { return glm::mix(glm::mix(c[0], c[1], s), glm::mix(c[3], c[2], s), t); };
      mesh.positions.push_back(between(corners));
      mesh.uvs.emplace_back(between(places), -between(places));
      if (i == cuts || j == cuts) continue;
      const uint32_t a = j * (cuts + 1) + i;
      mesh.triangles.emplace_back(a, a + 1, a + cuts + 2);
      mesh.triangles.emplace_back(a, a + cuts + 2, a + cuts + 1);
    }
  }
  return mesh;
}

/// Returns the same quad with texture coordinates from `lo` to `hi`.
Mesh make_quad(const std::array<vec3, 4>& corners, const vec2& lo, const vec2& hi, uint32_t cuts = 1) {
  return make_quad(corners, std::array<vec2, 4>{lo, vec2(hi.x, lo.y), hi, vec2(lo.x, hi.y)}, cuts);
}

/// Returns a scene with a floor to the horizon, a board of triangles smaller than pixels, a wall seen at a grazing
/// angle, and far behind a wall of two huge triangles, on which texels are long and turned. A plane mirror and a round
/// one show all of it from another direction. All surfaces show the meter; with a mask it cuts them, and the sun lights
/// the ground below through the floor.
world::Scene make_scene_of_levels(bool is_mask) {
  world::Scene scene;
  scene.images = {make_meter()};
  scene.textures = {is_mask ? kSoftMeter : kMeter};
  Material meter = make_unlit(vec3(1.0F), is_mask ? AlphaMode::kMask : AlphaMode::kOpaque);
  meter.alpha_cutoff = 0.62F;
  std::get<Unlit>(meter.model).color_texture.texture = 0;
  Material turned = meter;
  auto& slot = std::get<Unlit>(turned.model).color_texture;
  slot = {.texture = 0, .uv_set = 1, .to_u = {1.5F, 0.4F, 0.2F}, .to_v = {-0.1F, 0.3F, 0.7F}};
  Material mirror;
  mirror.phong() = Phong{.ambient = vec3(0.0F), .diffuse = vec3(0.0F), .reflection = vec3(1.0F)};
  Material ground;
  ground.phong() = Phong{.ambient = vec3(0.2F), .diffuse = vec3(0.8F)};
  scene.materials = {meter, turned, mirror, ground};
  constexpr float kFar = 250.0F;
  const auto add = [&](const char* name, const Mesh& mesh, uint32_t material) {
    scene.objects.push_back({name, mesh, material});
  };
  add("floor",
      make_quad({vec3(-kFar, 0, 9), vec3(kFar, 0, 9), vec3(kFar, 0, -kFar), vec3(-kFar, 0, -kFar)}, vec2(-50, 2),
                vec2(50, -50)),
      0);
  add("tiny triangles",
      make_quad({vec3(-2.8F, 0.4F, -6), vec3(-0.8F, 0.4F, -6.5F), vec3(-0.8F, 2.4F, -6.5F), vec3(-2.8F, 2.4F, -6)},
                vec2(0.1F), vec2(3.3F, 5.1F), 16),
      0);
  add("grazing wall",
      make_quad({vec3(0.62F, 0.2F, 5), vec3(0.8F, 0.2F, -30), vec3(0.8F, 2.2F, -30), vec3(0.62F, 2.2F, 5)}, vec2(0, 0),
                vec2(5, 1)),
      0);
  add("huge triangles",
      make_quad({vec3(-900, -200, -60), vec3(700, -200, -90), vec3(700, 800, -90), vec3(-900, 800, -60)},
                vec2(-30, -20), vec2(30, 20)),
      1);
  add("plane mirror",
      make_quad({vec3(1.2F, 0.4F, -1), vec3(3.2F, 0.4F, 0), vec3(3.2F, 2.6F, 0), vec3(1.2F, 2.6F, -1)}, vec2(0),
                vec2(1)),
      2);
  Gallery gallery;
  scene.objects.push_back({"round mirror", gallery.add_ball(vec3(0.1F, 0.7F, 1.0F), 0.45F, mirror), 2});
  if (is_mask) {
    scene.objects.push_back({"ground", world::Plane{.point = vec3(0, -0.5F, 0)}, 3});
    scene.lights = {make_sun(vec3(0.3F, -1, -0.2F))};
  }
  scene.environment.background = vec3(0.9F, 0.1F, 0.5F);
  return scene;
}

/// Returns the view from the position `number`. Position 0 is in front of all objects.
View make_view_of_levels(const uvec2& size, uint32_t number) {
  View view;
  view.size = size;
  std::mt19937 random(number);
  const auto within = [&](float range) {
    return number == 0 ? 0.0F : range * (static_cast<float>(random() % 2001) / 1000.0F - 1.0F);
  };
  view.camera.eye = vec3(0.4F + within(0.15F), 1.6F + within(0.6F), 6.0F + within(1.0F));
  view.camera.look = glm::normalize(vec3(within(0.2F), -0.12F + within(0.1F), -1.0F));
  view.camera.up = glm::normalize(glm::cross(glm::cross(view.camera.look, vec3(0, 1, 0)), view.camera.look));
  view.camera.yfov = 0.8F + within(0.3F);
  return view;
}

/// Returns the number of positions from which pictures are rendered. It is larger with the label `long`.
uint32_t view_count() {
  const char* word = std::getenv("PROMIN_TEST_LEVEL_VIEWS");
  return word == nullptr ? 1 : static_cast<uint32_t>(std::stoul(word));
}
constexpr uvec2 kSize(80, 60);

/// The error of a level: 0.64e-3 from its logarithms, and the rounding of cosines and lengths.
constexpr Real kLevelBound = 1e-3L;

/// Returns the meter's level that a device shows at a place as the color `seen`: the level nearest to `level` at which
/// all channels agree.
std::optional<Real> read_meter(const oracle::Textures& textures, const TextureSlot& slot, const oracle::Vector2& place,
                               Real level, const vec3& seen) {
  std::optional<Real> nearest;
  const int below = static_cast<int>(std::floor(level));
  for (int number = std::max(below - 1, 0); number <= std::min<int>(below + 1, kMeterLevels - 1); ++number) {
    // The level 0 is exactly that of the image's own texels.
    const oracle::Texel first = textures.filter(slot, place, std::max<Real>(number, 1e-12L));
    const oracle::Texel second = textures.filter(slot, place, number + 1);
    std::array<Real, 3> parts{};
    for (int c = 0; c < 3; ++c) parts[static_cast<size_t>(c)] = (Real(seen[c]) - first[c]) / (second[c] - first[c]);
    const auto [least, most] = std::ranges::minmax(parts);
    if (most - least > 1e-4L || least < -1e-4L || most > 1 + 1e-4L) continue;
    const Real read = number + (least + most) / 2;
    if (!nearest || std::abs(read - level) < std::abs(*nearest - level)) nearest = read;
  }
  return nearest;
}

class LevelsTest : public DeviceTest {
 protected:
  static RenderResult trace(const world::Scene& scene, const View& view,
                            const PictureShaders& shaders = picture_shaders()) {
    TunedRendererOptions options;
    options.with_aovs = true;
    options.shaders = shaders;
    return make_renderer(device(), scene, options).render(view);
  }
  static oracle::PictureReport compare(const world::Scene& scene, const oracle::Picture& truth,
                                       const RenderResult& result, const oracle::PictureBounds& bounds) {
    const oracle::DeviceAovs aovs{result.aovs.depth, result.aovs.normal, result.aovs.object, result.aovs.primitive};
    return compare_picture(scene, truth, result.image, aovs, bounds);
  }
};

/// Bounds of the differences that remain if positions and levels are within the oracle's errors. Such differences come
/// from rounding. No pixel may be wrong, not even in mirrors.
constexpr oracle::PictureBounds kOfLevels{
    .color_error = 1e-5L, .color_mean = 1e-6L, .color_share = 0, .color_share_with_mirrors = 0, .unsure_share = 1};
/// Bounds of masks. A mask that hides something changes the pixel entirely. If alpha is nearer to its cutoff than its
/// error, the pixel is not compared.
constexpr oracle::PictureBounds kOfMasks{
    .color_error = 0.005L, .color_mean = 1e-4L, .color_share = 0, .color_share_with_mirrors = 0, .unsure_share = 0.25};

TEST_F(LevelsTest, LevelsOfCameraRaysAreTheOracles) {
  const world::Scene scene = make_scene_of_levels(false);
  const oracle::Textures textures(scene);
  Real largest = 0;
  std::array<size_t, kMeterLevels> counts{};
  size_t grazing = 0;
  for (uint32_t number = 0; number < view_count(); ++number) {
    const View view = make_view_of_levels(kSize, number);
    const Real spread = 2 * std::tan(Real(view.camera.yfov) / 2) / view.size.y;
    const oracle::Picture truth = oracle::render(scene, view);
    const RenderResult result = trace(scene, view);
    for (size_t i = 0; i < truth.pixels.size(); ++i) {
      const oracle::Pixel& pixel = truth.pixels[i];
      if (!pixel.hit.exists() || result.aovs.object[i] != static_cast<uint32_t>(pixel.hit.object)) continue;
      const auto* unlit = std::get_if<Unlit>(&material_of(scene, pixel.hit).model);
      // At a texel's edge it is not certain which texel is seen.
      if (unlit == nullptr || pixel.explained_error > 0.01L) continue;
      oracle::TrianglePoint point;
      point.mesh = std::get_if<Mesh>(&scene.objects[static_cast<size_t>(pixel.hit.object)].shape);
      point.triangle = pixel.hit.primitive;
      point.u = pixel.hit.u;
      point.v = pixel.hit.v;
      point.width = spread * pixel.depth();
      point.cosine = std::abs(glm::dot(pixel.hit.normal, glm::normalize(pixel.ray.direction)));
      const Real level = textures.level_at(unlit->color_texture, point);
      if (level < kLevelBound || level > kMeterLevels - kLevelBound) continue;
      const std::optional<Real> read = read_meter(
          textures, unlit->color_texture, coordinates_at(unlit->color_texture, point), level, result.image.pixels[i]);
      ASSERT_TRUE(read) << "no level near " << level << " shows what pixel " << i << " of view " << number << " does";
      ASSERT_LE(std::abs(*read - level), kLevelBound) << "pixel " << i << " of view " << number;
      largest = std::max(largest, std::abs(*read - level));
      ++counts[static_cast<size_t>(level)];
      grazing += point.cosine < 0.05L ? 1 : 0;
    }
  }
  std::printf("largest error of a level %.3Lg; pixels", largest);
  for (const size_t count : counts) std::printf(" %zu", count);
  std::printf(" by level, %zu at less than 3 degrees\n", grazing);
  for (const size_t count : counts) EXPECT_GE(count, 20U);
  EXPECT_GE(grazing, 50U);
}

TEST_F(LevelsTest, LevelsInMirrorsAreTheOracles) {
  const world::Scene scene = make_scene_of_levels(false);
  for (uint32_t number = 0; number < view_count(); ++number) {
    const View view = make_view_of_levels(kSize, number);
    const oracle::Picture truth = oracle::render(scene, view);
    const oracle::PictureReport report = compare(scene, truth, trace(scene, view), kOfLevels);
    EXPECT_TRUE(report.passes()) << report.summary(scene);
    size_t mirrored = 0;
    for (const oracle::Pixel& pixel : truth.pixels) {
      const bool is_mirror = pixel.hit.exists() && scene.objects[static_cast<size_t>(pixel.hit.object)].material == 2;
      mirrored += is_mirror && pixel.explained_error < 0.001L ? 1 : 0;
    }
    std::printf("view %u: %zu pixels of mirrors whose level is sure to a sixtieth\n", number, mirrored);
    EXPECT_GE(mirrored, 100U);
  }
}

TEST_F(LevelsTest, MasksAreTheOracles) {
  const world::Scene scene = make_scene_of_levels(true);
  for (uint32_t number = 0; number < view_count(); ++number) {
    const View view = make_view_of_levels(kSize, number);
    const oracle::Picture truth = oracle::render(scene, view);
    const oracle::PictureReport report = compare(scene, truth, trace(scene, view), kOfMasks);
    EXPECT_TRUE(report.passes()) << report.summary(scene);
    const auto at_cutoff = std::ranges::count_if(truth.pixels, [](const auto& pixel) { return pixel.is_at_cutoff; });
    std::printf("view %u: %td of %zu camera rays pass beside a cutoff, %llu pixels are unsure\n", number, at_cutoff,
                truth.pixels.size(), static_cast<unsigned long long>(report.unsure_count));
  }
}

// Each of these faults makes a picture wrong, so the three tests above can fail.
TEST_F(LevelsTest, EachFaultDisagreesWithTheOracle) {
  const View view = make_view_of_levels({48, 36}, 0);
  for (const bool is_mask : {false, true}) {
    const world::Scene scene = make_scene_of_levels(is_mask);
    const oracle::Picture truth = oracle::render(scene, view);
    const oracle::PictureBounds& bounds = is_mask ? kOfMasks : kOfLevels;
    ASSERT_TRUE(compare(scene, truth, trace(scene, view), bounds).passes());
    const std::vector<const char*> faults =
        is_mask ? std::vector{"levels_of_fronts", "mirrored_masks_anew", "mirrors_keep_cones", "shadows_take_levels"}
                : std::vector{"levels_of_fronts", "levels_a_little_fine", "mirrors_keep_cones"};
    for (const char* fault : faults) {
      const FaultyShaders faulty(fault);
      EXPECT_FALSE(compare(scene, truth, trace(scene, view, faulty.shaders()), bounds).passes())
          << fault << (is_mask ? " in masks" : "");
    }
  }
}

// Boards lie one above the other. On each, a pixel is a texel wide and has another height, so that all samples of a
// pixel lie in one texel and have one level. Each of N samples takes one of the two neighbouring levels. The number of
// samples that take the upper one is such that the mean is at most half a sample off.
TEST_F(LevelsTest, EachOfManySamplesTakesOneLevel) {
  constexpr uint32_t kSide = 1U << kMeterLevels;
  constexpr uint32_t kRows = 16;
  Scene scene;
  scene.images = {make_meter(true)};
  scene.textures = {kMeter};
  scene.materials = {make_unlit(vec3(1.0F))};
  std::get<Unlit>(scene.materials[0].model).color_texture.texture = 0;
  std::vector<double> levels;
  for (const uint32_t samples : {4U, 16U}) {
    scene.objects.clear();
    scene.geometries.clear();
    levels.clear();
    for (uint32_t row = 0; row < kRows; ++row) {
      // These levels are far from the levels at which a sample's level changes. Those are at odd values of 2 * samples.
      levels.push_back((row * (kMeterLevels * samples - 1) / (kRows - 1)) / static_cast<double>(samples));
      // The level is 1/2 log2(w^2 W H A_uv / A), where w is the width of a sample, and H = 1.
      const double side = 2.0 / kSide / std::sqrt(samples);
      const double height = 2.0 / kRows;
      const double coverage = std::exp2(2.0 * levels.back()) * (2.0 * height) / (side * side * kSide);
      const float y = static_cast<float>(1.0 - height * row);
      const auto v = static_cast<float>(coverage);
      scene.add("board", make_quad({vec3(-1, y - height, 0), vec3(1, y - height, 0), vec3(1, y, 0), vec3(-1, y, 0)},
                                   vec2(0), vec2(1, v)));
    }
    const Image image =
        make_renderer(device(), scene, TunedRendererOptions()).render(make_board_view(uvec2(kSide), samples)).image;
    for (uint32_t row = 0; row < kRows; ++row) {
      for (uint32_t x = 0; x < kSide; ++x) {
        for (int c = 0; c < 3; ++c) {
          double expected = 0.0;
          for (uint32_t i = 0; i < samples; ++i) {
            const auto level = static_cast<uint32_t>(std::floor(levels[row] + (i + 0.5) / samples));
            const uint32_t taken = std::min(level, kMeterLevels);
            expected += meter_code(taken, x >> taken, 0, static_cast<uint32_t>(c), true) / 255.0 / samples;
          }
          const vec3& pixel = image.pixels[size_t{row * (kSide / kRows) + 3} * kSide + x];
          ASSERT_NEAR(static_cast<double>(pixel[c]), expected, 1e-6) << levels[row] << " " << x << " " << c;
        }
      }
    }
  }
}

}  // namespace
}  // namespace promin::test
