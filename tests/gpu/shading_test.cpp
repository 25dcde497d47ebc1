// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/debug_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "device_scene/pack_scene.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/renderer.h"
#include "shared/layout.h"
#include "trace/kernels/ray_kernel.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using test::has_same_bits;

using Key = std::tuple<float, float, float>;

Key key_of(const vec3& color) {
  return {color.x, color.y, color.z};
}

class ShadingTest : public test::DeviceTest {
 protected:
  ShadingTest() {
    TunedRendererOptions options;
    options.with_aovs = true;
    renderer_.emplace(make_renderer(device(), scene_, options));
    aovs_ = renderer_->render(view_).aovs;
  }

  Image show(DebugView shading) {
    view_.mode.debug_view = shading;
    return renderer_->render(view_).image;
  }

  bool is_miss(size_t pixel) const { return aovs_.object[pixel] == Aovs::kNoId; }

  world::Scene scene_ = test::make_scene_of_everything();
  View view_ = test::make_view(uvec2(150, 100));
  std::optional<Renderer> renderer_;
  Aovs aovs_;
};

TEST_F(ShadingTest, AovsTellMaterialsAndTheirColours) {
  const auto base_color = [](const Material& material) {
    if (const auto* model = std::get_if<MetallicRoughness>(&material.model)) return model->base_color;
    if (const auto* model = std::get_if<Unlit>(&material.model)) return model->color;
    return material.phong().diffuse;
  };
  size_t seen = 0;
  for (size_t i = 0; i < aovs_.object.size(); ++i) {
    if (is_miss(i)) {
      EXPECT_EQ(aovs_.material[i], Aovs::kNoId);
      EXPECT_EQ(aovs_.albedo[i], vec3(0.0F));
      continue;
    }
    const world::Object& object = scene_.objects[aovs_.object[i]];
    ASSERT_EQ(aovs_.material[i], object.material);
    // The gem's vertices have colours.
    if (object.name == "gem") continue;
    ASSERT_EQ(aovs_.albedo[i], base_color(scene_.materials[object.material]));
    ++seen;
  }
  EXPECT_GT(seen, 1000U);
  for (size_t i = 1; i < debug_view_names().size(); ++i) {
    view_.mode.debug_view = static_cast<DebugView>(i);
    const Aovs shown = renderer_->render(view_).aovs;
    EXPECT_EQ(shown.albedo, aovs_.albedo) << debug_view_names()[i];
    EXPECT_EQ(shown.material, aovs_.material) << debug_view_names()[i];
  }
}

TEST_F(ShadingTest, LightHasTheSameBitsAfterEveryOther) {
  const Image before = show(DebugView::kNone);
  for (size_t i = 1; i < debug_view_names().size(); ++i) {
    EXPECT_FALSE(has_same_bits(show(static_cast<DebugView>(i)), before)) << debug_view_names()[i];
  }
  EXPECT_TRUE(has_same_bits(show(DebugView::kNone), before));
}

TEST_F(ShadingTest, NormalsAndDepthAreThoseOfTheAovs) {
  const float size = pack_scene(scene_, "sah").tree_bounds.w;
  const Image normals = show(DebugView::kNormals);
  const Image depth = show(DebugView::kDepth);
  for (size_t i = 0; i < normals.pixels.size(); ++i) {
    ASSERT_EQ(normals.pixels[i], is_miss(i) ? vec3(0.0F) : 0.5F + 0.5F * aovs_.normal[i]) << i;
    // A device may round division in its own way.
    const float nearness = is_miss(i) ? 0.0F : size / (size + aovs_.depth[i]);
    ASSERT_NEAR(depth.pixels[i].x, nearness * nearness, 1e-6F) << i;
    ASSERT_EQ(depth.pixels[i], vec3(depth.pixels[i].x)) << i;
  }
}

TEST_F(ShadingTest, ColorsTellObjectsAndPrimitivesApart) {
  const Image objects = show(DebugView::kObject);
  const Image primitives = show(DebugView::kPrimitive);
  std::map<uint32_t, std::set<Key>> of_object;
  std::map<std::pair<uint32_t, uint32_t>, std::set<Key>> of_primitive;
  std::set<Key> object_colors;
  std::set<Key> primitive_colors;
  for (size_t i = 0; i < objects.pixels.size(); ++i) {
    if (is_miss(i)) {
      ASSERT_EQ(objects.pixels[i], vec3(0.0F));
      continue;
    }
    of_object[aovs_.object[i]].insert(key_of(objects.pixels[i]));
    of_primitive[{aovs_.object[i], aovs_.primitive[i]}].insert(key_of(primitives.pixels[i]));
    object_colors.insert(key_of(objects.pixels[i]));
    primitive_colors.insert(key_of(primitives.pixels[i]));
  }
  for (const auto& [id, colors] : of_object) EXPECT_EQ(colors.size(), 1U) << id;
  for (const auto& [id, colors] : of_primitive) EXPECT_EQ(colors.size(), 1U) << id.first << " " << id.second;
  // With 2^15 colours, two may be the same.
  EXPECT_GE(object_colors.size() + 1, of_object.size());
  EXPECT_GE(primitive_colors.size() + 1, of_primitive.size());
  EXPECT_GT(of_primitive.size(), of_object.size());
}

TEST_F(ShadingTest, ColorsDoNotDependOnTheTree) {
  TunedRendererOptions options;
  options.with_aovs = true;
  options.builder = "spatial";
  Renderer other = make_renderer(device(), scene_, options);
  const Image objects = show(DebugView::kObject);
  EXPECT_TRUE(has_same_bits(other.render(view_).image, objects));
  const Image primitives = show(DebugView::kPrimitive);
  EXPECT_TRUE(has_same_bits(other.render(view_).image, primitives));
}

TEST_F(ShadingTest, UvAreTheHits) {
  const Image picture = show(DebugView::kUv);
  size_t triangles = 0;
  for (uint32_t y = 0; y < view_.size.y; y += 11) {
    for (uint32_t x = 0; x < view_.size.x; x += 7) {
      const Hit hit = renderer_->explain(view_, {x, y}).samples.front().rays.front().hit;
      const vec3 expected = hit.object < 0 ? vec3(0.0F) : vec3(hit.u, hit.v, 1.0F - hit.u - hit.v);
      EXPECT_EQ(picture.at(x, y), expected) << x << " " << y;
      triangles += hit.u > 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(triangles, 1U);
}

// The heat map is compared with the counts of cast rays; more steps must be lighter.
TEST_F(ShadingTest, StepsAreAHeatMapOfTheCounts) {
  // With this number of spheres, the number of steps exceeds half of the scale, where a wrong order of colours would be
  // visible.
  scene_ = test::make_scene_of_everything(5000);
  renderer_.emplace(make_renderer(device(), scene_));
  const Image picture = show(DebugView::kSteps);
  std::vector<layout::RayRecord> rays;
  std::vector<vec3> colors;
  for (uint32_t y = 0; y < view_.size.y; y += 7) {
    for (uint32_t x = 0; x < view_.size.x; x += 5) {
      const Ray ray = renderer_->explain(view_, {x, y}).samples.front().rays.front().ray;
      rays.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
      colors.push_back(picture.at(x, y));
    }
  }
  RayKernelOptions options;
  options.features |= layout::FEATURE_STEP_COUNTS;
  std::vector<layout::HitRecord> records(rays.size());
  RayKernel(device(), upload_scene(device(), pack_scene(scene_, "sah")), options).run(rays, records);

  std::map<uint32_t, vec3> heat;
  for (size_t i = 0; i < rays.size(); ++i) {
    const uint32_t steps = std::min((records[i].b.w & 0xFFFF) + (records[i].b.w >> 16), layout::HEAT_STEPS);
    EXPECT_EQ(heat.try_emplace(steps, colors[i]).first->second, colors[i]) << steps << " steps";
  }
  EXPECT_GT(heat.size(), 30U);
  EXPECT_GT(heat.rbegin()->first, layout::HEAT_STEPS / 2);
  float last = -1.0F;
  for (const auto& [steps, color] : heat) {
    const float luminance = glm::dot(color, vec3(0.2126F, 0.7152F, 0.0722F));
    EXPECT_GT(luminance, last) << steps << " steps";
    last = luminance;
  }
}

}  // namespace
}  // namespace promin
