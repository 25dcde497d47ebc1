// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/aovs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "device_fixture.h"
#include "device_scene/sampling.h"
#include "support/thorough.h"
#include "test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using test::has_same_bits;
using test::make_scene_of_alpha;
using test::make_scene_of_everything;
using test::make_scene_of_glass;
using test::make_view;

AovSet all_aovs() {
  AovSet set;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) set.FIELD = true;
#include "promin/kinds/aovs.def"
  set.alpha = false;
  set.cryptomatte = true;
  return set;
}

vec3 sum_of_parts(const Aovs& aovs, size_t i) {
  return aovs.emission[i] + aovs.direct[i] + aovs.indirect[i] + aovs.reflection[i] + aovs.transmission[i] +
         aovs.background[i];
}

float largest(const vec3& color) {
  return std::max({color.x, color.y, color.z});
}

struct Subject {
  const char* name;
  world::Scene scene;
  View view;
};

/// Returns scenes in which each part of light is present in some pixel. The first scenes together have everything that
/// the last one has.
std::vector<Subject> subjects() {
  const View view = make_view(uvec2(48, 36));
  View deep = view;
  deep.max_depth = kMaxDepthOfGlass;
  std::vector<Subject> subjects;
  subjects.push_back({"alpha", make_scene_of_alpha(), view});
  subjects.push_back({"glass", make_scene_of_glass(), deep});
  subjects.push_back({"everything", make_scene_of_everything(40), view});
  for (Subject& subject : subjects) {
    subject.scene.materials[0].emissive = vec3(0.2F, 0.1F, 0.05F);
    subject.scene.environment.ambient = vec3(0.1F);
    subject.scene.environment.background = vec3(0.3F, 0.4F, 0.5F);
    // There are more sources than the stream handles in one turn, so that a bounce takes several turns.
    while (subject.scene.lights.size() < 18) {
      const auto number = static_cast<float>(subject.scene.lights.size());
      subject.scene.lights.push_back(test::make_sun(vec3(-1.0F, -2.0F, 0.1F * number), 0.05F));
    }
  }
  return test::cases_of(subjects, 2);
}

class AovsTest : public test::DeviceTest {};

TEST_F(AovsTest, PartsOfLightSumToTheImage) {
  for (const Subject& subject : subjects()) {
    for (const uint32_t samples : {1U, 6U}) {
      View view = subject.view;
      view.samples_per_pixel = samples;
      TunedRendererOptions options;
      const Image plain = make_renderer(device(), subject.scene, options).render(view).image;
      options.aovs = all_aovs();
      const RenderResult result = make_renderer(device(), subject.scene, options).render(view);
      EXPECT_TRUE(has_same_bits(result.image, plain)) << subject.name;
      float most_off = 0.0F;
      for (size_t i = 0; i < plain.pixels.size(); ++i) {
        const vec3 off = glm::abs(sum_of_parts(result.aovs, i) - plain.pixels[i]);
        most_off = std::max(most_off, largest(off / glm::max(plain.pixels[i], vec3(0.01F))));
        for (const auto* part : {&result.aovs.emission, &result.aovs.direct, &result.aovs.indirect,
                                 &result.aovs.reflection, &result.aovs.transmission, &result.aovs.background}) {
          ASSERT_TRUE(glm::all(glm::greaterThanEqual((*part)[i], vec3(0.0F)))) << subject.name;
        }
      }
      std::printf("%-12s %u spp: parts are off by %.2g of a pixel at most\n", subject.name, samples,
                  static_cast<double>(most_off));
      EXPECT_LT(most_off, 2e-6F) << subject.name;
      const auto is_anywhere = [](const std::vector<vec3>& part) {
        return std::ranges::any_of(part, [](const vec3& light) { return largest(light) > 0.01F; });
      };
      EXPECT_TRUE(is_anywhere(result.aovs.emission)) << subject.name;
      EXPECT_TRUE(is_anywhere(result.aovs.direct)) << subject.name;
      EXPECT_TRUE(is_anywhere(result.aovs.indirect)) << subject.name;
      EXPECT_TRUE(is_anywhere(result.aovs.reflection)) << subject.name;
      EXPECT_TRUE(is_anywhere(result.aovs.background)) << subject.name;
      EXPECT_EQ(is_anywhere(result.aovs.transmission), std::string_view(subject.name) == "glass");
    }
  }
}

// Each part of light equals a picture in which this is the only light.
TEST_F(AovsTest, EachPartIsThePictureWithoutTheOthers) {
  for (Subject& subject : subjects()) {
    // The surroundings replace rays in glass that are not traced.
    if (std::string_view(subject.name) == "glass") continue;
    View view = subject.view;
    view.max_depth = 0;
    TunedRendererOptions options;
    options.aovs = all_aovs();
    const Aovs aovs = make_renderer(device(), subject.scene, options).render(view).aovs;
    Renderer renderer = make_renderer(device(), subject.scene);
    const auto expect_part = [&](const std::vector<vec3>& part, const char* name) {
      const Image image = renderer.render(view).image;
      float most_off = 0.0F;
      float most = 0.0F;
      for (size_t i = 0; i < part.size(); ++i) {
        most_off = std::max(most_off, largest(glm::abs(part[i] - image.pixels[i])));
        most = std::max(most, largest(part[i]));
      }
      EXPECT_LT(most_off, 3e-6F) << name << " of " << subject.name;
      EXPECT_GT(most, 0.01F) << name << " of " << subject.name;
    };
    std::vector<Material> dark = subject.scene.materials;
    for (Material& material : dark) {
      material.emissive = vec3(0.0F);
      if (Unlit* unlit = std::get_if<Unlit>(&material.model)) unlit->color = vec3(0.0F);
    }
    Environment black = subject.scene.environment;
    black.ambient = black.background = vec3(0.0F);
    renderer.set_materials(dark);
    renderer.set_environment(black);
    expect_part(aovs.direct, "direct light");
    renderer.set_lights({});
    black.ambient = subject.scene.environment.ambient;
    renderer.set_environment(black);
    expect_part(aovs.indirect, "indirect light");
    black.ambient = vec3(0.0F);
    black.background = subject.scene.environment.background;
    renderer.set_environment(black);
    expect_part(aovs.background, "background");
    black.background = vec3(0.0F);
    renderer.set_environment(black);
    renderer.set_materials(subject.scene.materials);
    expect_part(aovs.emission, "emission");
  }
}

// Returns a board that mirrors a quarter and transmits a half, with one board behind it and one behind the camera.
TEST_F(AovsTest, MirrorsAndGlassTellWhatTheyBring) {
  Scene scene;
  Phong glass;
  glass.ambient = glass.diffuse = glass.specular = vec3(0.0F);
  glass.reflection = vec3(0.25F);
  glass.transmission = vec3(0.5F);
  scene.materials.resize(3);
  scene.materials[0].model = glass;
  scene.materials[1] = test::make_unlit(vec3(0.2F, 0.4F, 0.6F));
  scene.materials[2] = test::make_unlit(vec3(0.8F, 0.4F, 0.1F));
  scene.add("glass", test::make_board(), 0);
  scene.add("beyond", test::make_board(-1.0F), 1);
  scene.add("mirrored", test::make_board(3.0F), 2);
  RendererOptions options;
  options.aovs = all_aovs();
  const Aovs aovs = Renderer(device(), scene, options).render(test::make_board_view(uvec2(8))).aovs;
  for (size_t i = 0; i < aovs.object.size(); ++i) {
    EXPECT_LT(largest(glm::abs(aovs.reflection[i] - vec3(0.2F, 0.1F, 0.025F))), 1e-6F);
    EXPECT_LT(largest(glm::abs(aovs.transmission[i] - vec3(0.1F, 0.2F, 0.3F))), 1e-6F);
    EXPECT_EQ(aovs.emission[i] + aovs.direct[i] + aovs.indirect[i] + aovs.background[i], vec3(0.0F));
    EXPECT_EQ(aovs.object[i], 0U);
  }
}

TEST_F(AovsTest, BitsDoNotDependOnPiecesPacketsOrCrops) {
  for (const Subject& subject : subjects()) {
    if (std::string_view(subject.name) == "alpha") continue;
    View view = subject.view;
    view.samples_per_pixel = test::is_thorough() ? 18 : 6;
    TunedRendererOptions options;
    options.aovs = all_aovs();
    options.packet_size = 1;
    const Aovs expected = make_renderer(device(), subject.scene, options).render(view).aovs;
    options.packet_size = 4;
    options.blocks_per_dispatch = 5;
    Renderer renderer = make_renderer(device(), subject.scene, options);
    const Aovs same = renderer.render(view).aovs;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  EXPECT_EQ(same.FIELD, expected.FIELD) << #FIELD << " of " << subject.name;
#include "promin/kinds/aovs.def"
    EXPECT_EQ(same.object_coverage, expected.object_coverage) << subject.name;
    EXPECT_EQ(same.material_coverage, expected.material_coverage) << subject.name;
    view.crop = PixelWindow{uvec2(11, 7), uvec2(30, 21)};
    const Aovs crop = renderer.render(view).aovs;
    for (uint32_t y = 0; y < 14; ++y) {
      for (uint32_t x = 0; x < 19; ++x) {
        const size_t of_crop = size_t{y} * 19 + x;
        const size_t of_whole = size_t{y + 7} * 48 + x + 11;
        ASSERT_EQ(crop.reflection[of_crop], expected.reflection[of_whole]);
        ASSERT_EQ(crop.transmission[of_crop], expected.transmission[of_whole]);
        ASSERT_EQ(crop.position[of_crop], expected.position[of_whole]);
        ASSERT_EQ(crop.steps[of_crop], expected.steps[of_whole]);
        ASSERT_EQ(crop.object_coverage[of_crop], expected.object_coverage[of_whole]);
      }
    }
  }
}

// The AOVs are compared with positions and normals that are computed from the scene alone.
TEST_F(AovsTest, SurfacesAreWhereTheyAre) {
  Scene scene;
  scene.materials.emplace_back();
  scene.add("ball", Sphere{.center = vec3(0.5F, 0.25F, -4.0F), .radius = 1.5F});
  View view;
  view.size = uvec2(64, 48);
  view.camera.eye = vec3(0.0F, 0.0F, 1.0F);
  view.camera.look = vec3(0.0F, 0.0F, -1.0F);
  RendererOptions options;
  options.with_aovs = true;
  Renderer renderer(device(), scene, options);
  const Aovs by_ray = renderer.render(view).aovs;
  view.depth_kind = DepthKind::kPlane;
  const Aovs by_plane = renderer.render(view).aovs;
  size_t hits = 0;
  for (size_t i = 0; i < by_ray.depth.size(); ++i) {
    if (by_ray.object[i] == Aovs::kNoId) {
      EXPECT_EQ(by_ray.position[i], vec3(0.0F));
      EXPECT_EQ(by_ray.shading_normal[i], vec3(0.0F));
      EXPECT_TRUE(std::isinf(by_ray.depth[i]) && std::isinf(by_plane.depth[i]));
      continue;
    }
    ++hits;
    const vec3 from_center = by_ray.position[i] - vec3(0.5F, 0.25F, -4.0F);
    EXPECT_NEAR(glm::length(from_center), 1.5F, 2e-6F);
    EXPECT_LT(glm::length(by_ray.shading_normal[i] - from_center / 1.5F), 2e-6F);
    EXPECT_NEAR(glm::length(by_ray.position[i] - view.camera.eye), by_ray.depth[i], 4e-6F);
    EXPECT_NEAR(view.camera.eye.z - by_ray.position[i].z, by_plane.depth[i], 4e-6F);
  }
  EXPECT_GT(hits, 300U);
}

TEST_F(AovsTest, TextureCoordinatesAreThoseOfTheMesh) {
  Scene scene;
  const uint32_t texture =
      test::add_texture(scene, uvec2(2), {0xFFFFFFFF, 0xFF808080, 0xFF404040, 0xFFFFFFFF}, ImageUse::kColor);
  Material textured = test::make_unlit(vec3(1.0F));
  std::get<Unlit>(textured.model).color_texture.texture = texture;
  scene.materials = {textured};
  scene.add("board", test::make_board(0.0F, vec2(0.25F, 0.125F), vec2(0.75F, 0.5F)));
  RendererOptions options;
  options.aovs.uv = true;
  const Aovs aovs = Renderer(device(), scene, options).render(test::make_board_view(uvec2(16))).aovs;
  for (uint32_t y = 0; y < 16; ++y) {
    for (uint32_t x = 0; x < 16; ++x) {
      const vec2 share((static_cast<float>(x) + 0.5F) / 16.0F, 1.0F - (static_cast<float>(y) + 0.5F) / 16.0F);
      const vec2 expected = vec2(0.25F, 0.125F) + share * vec2(0.5F, 0.375F);
      const vec2 off = aovs.uv[size_t{y} * 16 + x] - expected;
      // The coordinates may differ from the expected ones by whole numbers.
      EXPECT_LT(std::abs(off.x - std::round(off.x)) + std::abs(off.y - std::round(off.y)), 1e-5F) << x << " " << y;
    }
  }
}

// The AOVs are compared with the hits of rays through the same points of the picture.
TEST_F(AovsTest, CoverageIsTheShareOfRaysThatHit) {
  const world::Scene world_scene = make_scene_of_everything(60);
  View view = make_view(uvec2(40, 30));
  view.samples_per_pixel = 21;
  TunedRendererOptions options;
  options.aovs.cryptomatte = true;
  options.aovs.object = true;
  Renderer renderer = make_renderer(device(), world_scene, options);
  const Aovs aovs = renderer.render(view).aovs;
  std::vector<std::map<uint32_t, uint32_t>> counts(aovs.object.size());
  // Each sample is also rendered by a larger picture with one sample per pixel. A pixel of this picture lies at the
  // position of the sample.
  View fine = view;
  fine.size = view.size * 21U;
  fine.samples_per_pixel = 1;
  const Aovs of_fine = renderer.render(fine).aovs;
  const uint32_t generator = lattice_generator(21);
  for (uint32_t y = 0; y < view.size.y; ++y) {
    for (uint32_t x = 0; x < view.size.x; ++x) {
      for (uint32_t sample = 0; sample < 21; ++sample) {
        // The points of the lattice are the centres of the larger picture's pixels.
        const uvec2 place(sample_point(view, generator, sample) * 21.0F);
        const size_t at = (size_t{y} * 21 + place.y) * fine.size.x + size_t{x} * 21 + place.x;
        if (of_fine.object[at] != Aovs::kNoId) ++counts[size_t{y} * view.size.x + x][of_fine.object[at]];
      }
    }
  }
  size_t shared_pixels = 0;
  size_t differing = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    shared_pixels += counts[i].size() > 1 ? 1 : 0;
    float before = 1.0F;
    for (const Coverage& covered : aovs.object_coverage[i]) {
      ASSERT_LE(covered.share, before);
      before = covered.share;
      if (covered.id == Coverage::kNoId) continue;
      // Rays that are rounded differently may miss at an edge.
      differing += covered.share != static_cast<float>(counts[i][covered.id]) / 21.0F ? 1 : 0;
    }
    float objects = 0.0F;
    float materials = 0.0F;
    for (const Coverage& covered : aovs.object_coverage[i]) objects += covered.share;
    for (const Coverage& covered : aovs.material_coverage[i]) materials += covered.share;
    if (counts[i].size() <= kCoverageRanks) {
      EXPECT_NEAR(objects, materials, 1e-5F);
    }
  }
  EXPECT_GT(shared_pixels, 100U);
  EXPECT_LT(differing, 4U);
}

TEST_F(AovsTest, AlphaIsTheShareThatIsNoBackground) {
  for (const Subject& subject : subjects()) {
    View view = subject.view;
    view.samples_per_pixel = 4;
    TunedRendererOptions options;
    const Image plain = make_renderer(device(), subject.scene, options).render(view).image;
    options.aovs = all_aovs();
    options.aovs.alpha = true;
    const RenderResult result = make_renderer(device(), subject.scene, options).render(view);
    size_t between = 0;
    for (size_t i = 0; i < plain.pixels.size(); ++i) {
      const float alpha = result.aovs.alpha[i];
      ASSERT_TRUE(alpha >= 0.0F && alpha <= 1.0F);
      between += alpha > 0.0F && alpha < 1.0F ? 1 : 0;
      if (alpha == 1.0F || alpha == 0.0F) {
        ASSERT_EQ(result.image.pixels[i], alpha * plain.pixels[i]) << subject.name;
      }
      const vec3 again = result.image.pixels[i] + (1.0F - alpha) * subject.scene.environment.background;
      ASSERT_LT(largest(glm::abs(again - plain.pixels[i])), 2e-6F) << subject.name;
    }
    EXPECT_GT(between, 20U) << subject.name;
  }
}

TEST_F(AovsTest, RefinedPicturesHaveThemToo) {
  for (const Subject& subject : subjects()) {
    if (std::string_view(subject.name) == "glass") continue;
    TunedRendererOptions options;
    options.aovs = all_aovs();
    Renderer renderer = make_renderer(device(), subject.scene, options);
    const Aovs of_one = renderer.render(subject.view).aovs;
    View view = subject.view;
    view.error_target = ErrorTarget{.error = 1.0F / 16.0F, .min_samples = 4, .max_samples = 32};
    const RenderResult result = renderer.render(view);
    EXPECT_EQ(result.aovs.position, of_one.position);
    EXPECT_EQ(result.aovs.steps, of_one.steps);
    for (size_t i = 0; i < result.image.pixels.size(); ++i) {
      const vec3 off = glm::abs(sum_of_parts(result.aovs, i) - result.image.pixels[i]);
      ASSERT_LT(largest(off), 3e-6F) << subject.name << " " << i;
      const auto samples = static_cast<float>(result.aovs.samples[i]);
      for (const Coverage& covered : result.aovs.object_coverage[i]) {
        ASSERT_EQ(covered.share * samples, std::round(covered.share * samples));
      }
    }
    View fixed = subject.view;
    fixed.samples_per_pixel = 64;
    const Aovs fine = renderer.render(fixed).aovs;
    double off = 0.0;
    for (size_t i = 0; i < fine.direct.size(); ++i) {
      off += static_cast<double>(largest(glm::abs(fine.direct[i] - result.aovs.direct[i])));
    }
    EXPECT_LT(off / static_cast<double>(fine.direct.size()), 0.03) << subject.name;
  }
}

// With step counts, separate rays find the hits.
TEST_F(AovsTest, SurfacesAreTheSameBesideSteps) {
  for (const Subject& subject : test::cases_of(subjects(), 1)) {
    View view = subject.view;
    view.samples_per_pixel = 4;
    // The kernels of this debug view compile fast.
    view.mode.debug_view = DebugView::kNormals;
    TunedRendererOptions options;
    options.with_aovs = true;
    options.mode = view.mode;
    const Aovs expected = make_renderer(device(), subject.scene, options).render(view).aovs;
    options.aovs.steps = true;
    const Aovs same = make_renderer(device(), subject.scene, options).render(view).aovs;
    EXPECT_FALSE(same.steps.empty());
    EXPECT_FALSE(expected.albedo.empty());
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE)             \
  if (AovSource::SOURCE == AovSource::kSurface) {                              \
    EXPECT_EQ(same.FIELD, expected.FIELD) << #FIELD << " of " << subject.name; \
  }
#include "promin/kinds/aovs.def"
  }
}

// The heat map is a debug view that counts the same steps.
TEST_F(AovsTest, StepsAreThoseOfTheDebugView) {
  const world::Scene scene = make_scene_of_everything(60);
  View view = make_view(uvec2(40, 30));
  TunedRendererOptions options;
  options.aovs.steps = true;
  options.aovs.albedo = true;
  const Aovs aovs = make_renderer(device(), scene, options).render(view).aovs;
  view.mode.debug_view = DebugView::kSteps;
  const Image heat = make_renderer(device(), scene).render(view).image;
  std::map<uint32_t, vec3> colors;
  for (size_t i = 0; i < aovs.steps.size(); ++i) {
    const auto [known, is_new] = colors.try_emplace(std::min(aovs.steps[i], 64U), heat.pixels[i]);
    ASSERT_EQ(known->second, heat.pixels[i]) << aovs.steps[i] << " steps";
  }
  EXPECT_GT(colors.size(), 10U);
  float before = -1.0F;
  for (const auto& [steps, color] : colors) {
    EXPECT_GT(color.x + color.y + color.z, before) << steps;
    before = color.x + color.y + color.z;
  }
}

}  // namespace
}  // namespace promin
