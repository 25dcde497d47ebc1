// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/explain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "core/rounding.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"
#include "shared/layout.h"
#include "support/thorough.h"
#include "support/with_instances.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using Bits = std::array<uint32_t, 3>;

Bits bits_of(const vec3& v) {
  return std::bit_cast<Bits>(v);
}

Hit cast(Caster& caster, const Ray& ray, HitQuery query) {
  Hit hit;
  caster.cast(std::span(&ray, 1), std::span(&hit, 1), query);
  return hit;
}

void expect_same_hit(const Hit& a, const Hit& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.object, b.object);
  EXPECT_EQ(a.primitive, b.primitive);
  EXPECT_EQ(a.u, b.u);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(bits_of(a.normal), bits_of(b.normal));
}

class ExplainTest : public test::DeviceTest {
 protected:
  /// Compares explanations of pixels all over the picture with the picture, with cast rays and with one another.
  static void check(const world::Scene& scene, const View& view) {
    TunedRendererOptions options;
    // With these features, a scene without lights has the same kernels as one with a headlight.
    options.more_features = layout::FEATURE_HEADLIGHT | layout::FEATURE_SHADOWS | layout::FEATURE_SPECULAR;
    Renderer renderer = make_renderer(device(), scene, options);
    Caster caster = make_caster(device(), scene);
    const Image picture = renderer.render(view).image;
    for (uint32_t i = 0; i < 40; ++i) {
      const uvec2 pixel(i * 37 % view.size.x, (i * 23 + i / 7) % view.size.y);
      SCOPED_TRACE(testing::Message() << "pixel " << pixel.x << " " << pixel.y);
      const Explanation explanation = renderer.explain(view, pixel);
      EXPECT_EQ(explanation.pixel, pixel);
      EXPECT_EQ(bits_of(explanation.color), bits_of(picture.at(pixel.x, pixel.y)));
      expect_sums(explanation, scene);
      expect_counts(renderer, view, explanation);
      for (const ExplainedSample& sample : explanation.samples) expect_hits(sample, caster);
    }
  }

  /// Returns the weight of the mirror ray that follows. For a metallic-roughness material it depends on the angle; here
  /// it is only checked to be no larger than `weight`.
  static vec3 next_weight(const ExplainedSample& sample, size_t i, const vec3& weight, const world::Scene& scene) {
    const ExplainedRay& ray = sample.rays[i];
    if (ray.hit.object < 0) return weight;
    if (ray.coverage < 1.0F) return (1.0F - ray.coverage) * weight;
    const auto& model = scene.materials[ray.material].model;
    if (const auto* phong = std::get_if<Phong>(&model)) return weight * phong->reflection;
    if (i + 1 == sample.rays.size()) return vec3(0.0F);
    EXPECT_TRUE(std::holds_alternative<MetallicRoughness>(model));
    const vec3 next = sample.rays[i + 1].weight;
    EXPECT_TRUE(glm::all(glm::lessThanEqual(next, weight)) && max_component(next) > 0.0F);
    return next;
  }

  /// The colour is exactly the fp32 sum of its parts.
  static void expect_sums(const Explanation& explanation, const world::Scene& scene) {
    vec3 sum(0.0F);
    for (const ExplainedSample& sample : explanation.samples) {
      vec3 weight(1.0F);
      vec3 radiance(0.0F);
      bool sees_environment = false;
      for (size_t i = 0; i < sample.rays.size(); ++i) {
        const ExplainedRay& ray = sample.rays[i];
        EXPECT_EQ(bits_of(ray.weight), bits_of(weight));
        vec3 sent = ray.own;
        for (const ExplainedSource& source : ray.sources) sent += source.contribution;
        radiance += ray.coverage * weight * sent;
        EXPECT_EQ(bits_of(ray.radiance), bits_of(radiance));
        if (ray.hit.object < 0) {
          EXPECT_EQ(ray.own, sees_environment ? scene.environment.ambient : scene.environment.background);
          EXPECT_TRUE(ray.sources.empty());
          continue;
        }
        EXPECT_EQ(ray.sources.size(), scene.lights.size());
        weight = next_weight(sample, i, weight, scene);
        const bool is_phong = std::holds_alternative<Phong>(scene.materials[ray.material].model);
        sees_environment = sees_environment || (!is_phong && ray.coverage == 1.0F);
      }
      sum += radiance;
    }
    EXPECT_EQ(bits_of(explanation.sum), bits_of(sum));
  }

  static void expect_counts(Renderer& renderer, View view, const Explanation& explanation) {
    view.crop = PixelWindow{explanation.pixel, explanation.pixel + 1U};
    const RayCounts counts = renderer.render(view).rays;
    RayCounts explained;
    for (const ExplainedSample& sample : explanation.samples) {
      explained.primary += 1;
      for (const ExplainedRay& ray : sample.rays) {
        explained.reflection += ray.kind == RayKind::kReflection ? 1 : 0;
        explained.refraction += ray.kind == RayKind::kRefraction ? 1 : 0;
        for (const ExplainedSource& source : ray.sources) explained.shadow += source.shadow_ray ? 1 : 0;
      }
    }
    EXPECT_EQ(explained.primary, counts.primary);
    EXPECT_EQ(explained.shadow, counts.shadow);
    EXPECT_EQ(explained.reflection, counts.reflection);
    EXPECT_EQ(explained.refraction, counts.refraction);
  }

  static void expect_hits(const ExplainedSample& sample, Caster& caster) {
    for (const ExplainedRay& ray : sample.rays) {
      expect_same_hit(ray.hit, cast(caster, ray.ray, HitQuery::kNearest));
      for (const ExplainedSource& source : ray.sources) {
        if (!source.shadow_ray) {
          EXPECT_EQ(source.contribution, vec3(0.0F));
          continue;
        }
        const bool is_occluded = cast(caster, *source.shadow_ray, HitQuery::kAny).t == 0.0F;
        EXPECT_EQ(source.is_visible(), !is_occluded);
        EXPECT_EQ(source.contribution != vec3(0.0F), !is_occluded);
      }
    }
  }
};

TEST_F(ExplainTest, EverythingAddsUpToThePicture) {
  View view = test::make_view(uvec2(150, 100));
  view.samples_per_pixel = 3;
  check(test::make_scene_of_everything(), view);
}

TEST_F(ExplainTest, InstancesAddUpToThePicture) {
  const world::Scene scene = test::with_instances(test::make_scene_of_everything());
  ASSERT_FALSE(scene.instances.empty());
  const View view = test::make_view(uvec2(150, 100));
  check(scene, view);
  // The log names the object and the primitive of the instance, and the position in the world.
  TunedRendererOptions options;
  options.aovs.object = options.aovs.primitive = options.aovs.position = options.aovs.material = true;
  Renderer renderer = make_renderer(device(), scene, options);
  const Aovs aovs = renderer.render(view).aovs;
  size_t seen = 0;
  for (size_t i = 0; i < aovs.object.size() && seen < 12; i += 7) {
    const auto is_seen = [&](const world::Instance& instance) { return instance.object == aovs.object[i]; };
    if (std::ranges::none_of(scene.instances, is_seen)) continue;
    const uvec2 pixel(i % view.size.x, i / view.size.x);
    const ExplainedRay& ray = renderer.explain(view, pixel).samples[0].rays[0];
    EXPECT_EQ(static_cast<uint32_t>(ray.hit.object), aovs.object[i]);
    EXPECT_EQ(static_cast<uint32_t>(ray.hit.primitive), aovs.primitive[i]);
    EXPECT_EQ(ray.material, aovs.material[i]);
    EXPECT_EQ(bits_of(ray.position), bits_of(aovs.position[i]));
    ++seen;
  }
  EXPECT_GT(seen, 5U);
}

// cast() returns the nearest surface even if it blends, so the test does not compare hits with cast().
TEST_F(ExplainTest, WhatBlendsAddsUpToThePicture) {
  const world::Scene scene = test::make_scene_of_alpha();
  const View view = test::make_view(uvec2(48, 36));
  Renderer renderer = make_renderer(device(), scene);
  const Image image = renderer.render(view).image;
  size_t through = 0;
  for (uint32_t y = 0; y < view.size.y; y += 5) {
    for (uint32_t x = 0; x < view.size.x; x += 3) {
      const Explanation explanation = renderer.explain(view, uvec2(x, y));
      EXPECT_EQ(bits_of(explanation.color), bits_of(image.pixels[y * view.size.x + x]));
      expect_sums(explanation, scene);
      expect_counts(renderer, view, explanation);
      for (const ExplainedRay& ray : explanation.samples[0].rays) through += ray.coverage < 1.0F ? 1 : 0;
    }
  }
  EXPECT_GT(through, 20U);
}

TEST_F(ExplainTest, GlassIsATreeWithParents) {
  const world::Scene scene = test::make_scene_of_glass();
  View view = test::make_view(uvec2(64, 48));
  view.max_depth = kMaxDepthOfGlass;
  view.samples_per_pixel = 2;
  Renderer renderer = make_renderer(device(), scene);
  const Image picture = renderer.render(view).image;
  size_t branches = 0;
  size_t fans = 0;
  for (uint32_t i = 0; i < 60; ++i) {
    const uvec2 pixel(12 + i * 37 % 40, 12 + i * 11 % 30);
    SCOPED_TRACE(testing::Message() << "pixel " << pixel.x << " " << pixel.y);
    const Explanation explanation = renderer.explain(view, pixel);
    EXPECT_EQ(bits_of(explanation.color), bits_of(picture.at(pixel.x, pixel.y)));
    expect_counts(renderer, view, explanation);
    vec3 sum(0.0F);
    for (const ExplainedSample& sample : explanation.samples) {
      sum += sample.radiance();
      std::vector<int> reflected(sample.rays.size());
      std::vector<int> refracted(sample.rays.size());
      EXPECT_EQ(sample.rays.front().kind, RayKind::kCamera);
      EXPECT_LE(sample.rays.size(), 1U + layout::MOST_TREE_RAYS + layout::MOST_LAYERS);
      for (size_t k = 1; k < sample.rays.size(); ++k) {
        const ExplainedRay& ray = sample.rays[k];
        ASSERT_LT(ray.parent, k);
        const ExplainedRay& parent = sample.rays[ray.parent];
        EXPECT_GE(parent.hit.object, 0);
        EXPECT_TRUE(glm::all(glm::lessThanEqual(ray.weight, parent.weight + 1e-6F)));
        if (ray.kind == RayKind::kThrough) {
          EXPECT_EQ(ray.ray.origin, parent.ray.origin);
          continue;
        }
        // The ray leaves the parent's hit.
        EXPECT_LT(glm::distance(ray.ray.origin, parent.position), 1e-3F);
        ++(ray.kind == RayKind::kReflection ? reflected : refracted)[ray.parent];
      }
      for (size_t k = 0; k < sample.rays.size(); ++k) {
        EXPECT_LE(reflected[k], 1);
        EXPECT_LE(refracted[k], 3) << "one of each color";
        branches += reflected[k] > 0 && refracted[k] > 0 ? 1 : 0;
        fans += refracted[k] == 3 ? 1 : 0;
      }
    }
    EXPECT_EQ(bits_of(explanation.sum), bits_of(sum));
  }
  EXPECT_GT(branches, 20U);
  EXPECT_GT(fans, 5U);
}

TEST_F(ExplainTest, MirrorsAndScenesWithoutLightsAddUp) {
  for (const char* name :
       test::cases_of<const char*>({"metallic_roughness.gltf", "mirrors.gltf", "triangles_smooth.gltf"}, 1)) {
    SCOPED_TRACE(name);
    world::Scene scene = world::flatten(load_scene(std::filesystem::path(PROMIN_SCENES_DIR) / name));
    View view;
    view.size = uvec2(96, 72);
    view.camera = scene.cameras.empty() ? look_from_front(scene, 4.0F / 3.0F) : scene.cameras.front();
    check(scene, view);
    scene.lights = {make_headlight()};
    check(scene, view);
  }
}

TEST_F(ExplainTest, TooLongALogIsRefused) {
  world::Scene scene = test::make_scene_of_everything();
  scene.lights.resize(1000);
  View view = test::make_view(uvec2(16, 16));
  Renderer renderer = make_renderer(device(), scene);
  EXPECT_NO_THROW(renderer.explain(view, uvec2(0)));
  view.max_depth = 1000;
  EXPECT_THROW(renderer.explain(view, uvec2(0)), RunError);
}

}  // namespace
}  // namespace promin
