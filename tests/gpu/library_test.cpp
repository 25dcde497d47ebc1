// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check what the public headers promise for wrong arguments, interrupted work and changes of a scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "device_scene/drop_copies.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/caster.h"
#include "promin/framing.h"
#include "promin/renderer.h"
#include "promin/validate.h"
#include "support/file_size_limit.h"
#include "trace/kernels/ray_kernel.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using test::has_same_bits;

/// Returns a mirroring ball on a floor, with a light.
Scene make_library_scene() {
  Mesh floor;
  floor.positions = {{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}};
  floor.triangles = {{0, 2, 1}, {0, 3, 2}};
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].phong().reflection = vec3(0.5F);
  scene.add("floor", floor);
  scene.add("ball", Sphere{{0, 1, 0}, 1.0}, 1);
  scene.lights.resize(1);
  scene.lights[0].position = {3, 5, 2};
  return scene;
}

View make_library_view(const Scene& scene, uint32_t size = 64) {
  View view;
  view.camera = frame_scene(scene, 1.0F);
  view.size = {size, size};
  return view;
}

class LibraryTest : public test::DeviceTest {
 protected:
  const Scene scene_ = make_library_scene();
  const View view_ = make_library_view(scene_);
};

TEST_F(LibraryTest, WrongViewsAreRefusedAndTheRendererStays) {
  Renderer renderer(device(), scene_);
  const Image before = renderer.render(view_).image;
  const auto ignore = [](const Image&, const View&) { return true; };
  for (const auto& seed : std::vector<std::function<void(View&)>>{
           [](View& v) { v.size.x = 0; },
           [](View& v) { v.samples_per_pixel = 0; },
           [](View& v) { v.max_depth = kMaxDepth + 1; },
           [](View& v) { v.camera.eye.y = std::numeric_limits<float>::quiet_NaN(); },
           [](View& v) { v.camera.up = v.camera.look; },
           [](View& v) { v.mode.debug_view = static_cast<DebugView>(99); },
           [](View& v) {
             v.crop = PixelWindow{{0, 0}, {65, 64}};
           },
       }) {
    View view = view_;
    seed(view);
    EXPECT_THROW(renderer.render(view), UsageError);
    EXPECT_THROW(renderer.explain(view, uvec2(0)), UsageError);
    EXPECT_THROW(renderer.render_progressively(view, 10.0, ignore), UsageError);
  }
  EXPECT_THROW(renderer.explain(view_, uvec2(64, 0)), UsageError);
  for (const double budget_ms : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(renderer.render_progressively(view_, budget_ms, ignore), UsageError);
  }
  EXPECT_THROW(renderer.render_progressively(view_, 10.0, {}), UsageError);
  View cropped = view_;
  cropped.crop = PixelWindow{{0, 0}, {8, 8}};
  EXPECT_THROW(renderer.render_progressively(cropped, 10.0, ignore), UsageError);
  EXPECT_TRUE(has_same_bits(renderer.render(view_).image, before));
}

TEST_F(LibraryTest, WrongScenesAndOptionsAreRefused) {
  Scene broken = scene_;
  broken.objects[0].material = 7;
  EXPECT_THROW(Renderer(device(), broken), InputError);
  EXPECT_THROW(Caster(device(), broken), InputError);
  EXPECT_THROW(Renderer(device(), scene_, {.builder = "shah"}), UsageError);
  EXPECT_THROW(Caster(device(), scene_, {.builder = "shah"}), UsageError);
  EXPECT_THROW(Renderer(device(), scene_, {.bvh = "/nonexistent/f.pbvh"}), InputError);
  EXPECT_THROW(Caster(device(), scene_, {.bvh = "/nonexistent/f.pbvh"}), InputError);
  EXPECT_THROW(gpu::open_device("no such device"), DeviceError);
  EXPECT_THROW(gpu::open_device(""), DeviceError);
}

TEST_F(LibraryTest, WrongChangesAreRefusedAndChangeNothing) {
  Renderer renderer(device(), scene_);
  const Image before = renderer.render(view_).image;
  Light light;
  light.direction = vec3(0);
  EXPECT_THROW(renderer.set_lights({&light, 1}), InputError);
  std::vector<Material> materials = scene_.materials;
  materials[0].phong().diffuse.r = -1.0F;
  EXPECT_THROW(renderer.set_materials(materials), InputError);
  EXPECT_THROW(renderer.set_materials(std::vector<Material>(3)), InputError);
  Environment environment;
  environment.ambient = vec3(-1);
  EXPECT_THROW(renderer.set_environment(environment), InputError);
  EXPECT_TRUE(has_same_bits(renderer.render(view_).image, before));
}

// The tree contains only one of these copies. If they were glass, each copy would be visible.
TEST_F(LibraryTest, MaterialsOfManyCopiesStayOpaque) {
  Scene scene = scene_;
  auto& floor = std::get<Mesh>(scene.geometries[0]);
  floor.triangles.insert(floor.triangles.end(), kMostCopies, floor.triangles[0]);
  Renderer renderer(device(), scene);
  std::vector<Material> materials = scene.materials;
  materials[0].phong().diffuse = vec3(0.25F);
  materials[1].phong().transmission = vec3(0.5F);
  EXPECT_NO_THROW(renderer.set_materials(materials)) << "the ball has no copies";
  materials[0].alpha_mode = AlphaMode::kBlend;
  EXPECT_THROW(renderer.set_materials(materials), InputError);
  materials[0].alpha_mode = AlphaMode::kOpaque;
  materials[0].phong().transmission = vec3(0.5F);
  EXPECT_THROW(renderer.set_materials(materials), InputError);
}

// This test needs a process of its own (in tests/CMakeLists.txt each suite on a device has one). Mesa 25.0.7 counts
// memory that it has refused as allocated. Memory that it allocates later then lies beyond the end of its file, where a
// write causes a bus error.
class LibraryOutOfMemoryTest : public LibraryTest {};

// A change for which there is no memory is refused before the scene changes. Lavapipe from Mesa 24.3 on has its memory
// in a file, whose size can be limited; other drivers accept the change.
TEST_F(LibraryOutOfMemoryTest, AChangeThatFailsChangesNothing) {
  Renderer renderer(device(), scene_);
  const Image before = renderer.render(view_).image;
  bool is_refused = false;
  try {
    const FileSizeLimit limit(1 << 16);
    renderer.set_lights(std::vector<Light>(10'000));
  } catch (const RunError&) {
    is_refused = true;
  }
  if (is_refused) {
    EXPECT_TRUE(has_same_bits(renderer.render(view_).image, before));
  }
  renderer.set_lights(scene_.lights);
  EXPECT_TRUE(has_same_bits(renderer.render(view_).image, before));
}

// The device reverses the corners of a mirrored mesh; hits give them in the mesh's order.
TEST_F(LibraryTest, WeightsAreThoseOfTheMeshsOwnCorners) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Ray near_second{.origin = {0.9F, 0.05F, 1}, .direction = {0, 0, -1}};
  const Ray mirrored_near_second{.origin = {-0.9F, 0.05F, 1}, .direction = {0, 0, -1}};
  for (const char* builder : {"sah", "spatial"}) {
    for (const double side : {1.0, -1.0}) {
      Scene scene;
      scene.materials.resize(1);
      scene.add("before", Sphere{{0, 0, -9}, 1.0});
      scene.add("mesh", mesh);
      scene.objects.back().world_from_object[0][0] = side;
      Hit hit;
      Caster(device(), scene, {.builder = builder})
          .cast({side > 0 ? &near_second : &mirrored_near_second, 1}, {&hit, 1});
      EXPECT_NEAR(hit.u, 0.9F, 1e-6F) << builder << side;
      EXPECT_NEAR(hit.v, 0.05F, 1e-6F) << builder << side;
      EXPECT_EQ(hit.normal, vec3(0, 0, 1));
    }
  }
}

TEST_F(LibraryTest, ANarrowSpotHasItsWholePowerInItsMiddle) {
  Scene scene;
  scene.materials.resize(1);
  scene.add("wall", Sphere{{0, 0, -10}, 5.0});
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::kSpot;
  View view;
  view.camera.yfov = 1e-4F;
  view.size = uvec2(1);
  std::vector<vec3> colors;
  for (const float angle : {0.5F, 0.05F, 0.02F, 0.01F}) {
    scene.lights[0].outer_cone_angle = angle;
    colors.push_back(Renderer(device(), scene).render(view).image.pixels[0]);
    EXPECT_NEAR(colors.back().r, colors.front().r, 0.01F * colors.front().r) << angle;
  }
  EXPECT_GT(colors.front().r, 0.1F);
}

TEST_F(LibraryTest, AChangedSceneHasTheBitsOfANewOne) {
  Renderer renderer(device(), scene_);
  const Image before = renderer.render(view_).image;
  Scene changed = scene_;
  changed.lights.push_back(make_headlight());
  changed.materials[0].phong().specular = vec3(0.5F);
  changed.materials[0].phong().shininess = 10.0F;
  changed.environment.ambient = vec3(0.2F);
  changed.environment.background = vec3(0, 0, 1);
  renderer.set_lights(changed.lights);
  renderer.set_materials(changed.materials);
  renderer.set_environment(changed.environment);
  const Image after = renderer.render(view_).image;
  EXPECT_FALSE(has_same_bits(after, before));
  EXPECT_TRUE(has_same_bits(after, Renderer(device(), changed).render(view_).image));
}

TEST_F(LibraryTest, ABrokenOffConstructorLeavesTheDeviceUsable) {
  const ProgressCallback stop = [](double) { return false; };
  EXPECT_THROW(Renderer(device(), scene_, {.progress = stop}), Cancelled);
  EXPECT_THROW(Caster(device(), scene_, {.progress = stop}), Cancelled);
  EXPECT_NO_THROW(Renderer(device(), scene_).render(view_));
}

TEST_F(LibraryTest, ABrokenOffPictureStopsAtTheNextDispatchAndTheRendererStays) {
  const View view = make_library_view(scene_, 256);
  // A dispatch traces so few rays that several dispatches are needed.
  TunedRendererOptions options;
  options.blocks_per_dispatch = 1;
  Renderer renderer = make_renderer(device(), scene_, options);
  int calls = 0;
  double last = -1.0;
  const RenderResult whole = renderer.render(view, [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    return ++calls > 0;
  });
  ASSERT_GT(calls, 3);
  EXPECT_EQ(last, 1.0);
  for (const int wanted : {1, 3}) {
    calls = 0;
    EXPECT_THROW(renderer.render(view, [&](double) { return ++calls < wanted; }), Cancelled);
    EXPECT_EQ(calls, wanted);
  }
  const RenderResult again = renderer.render(view);
  EXPECT_TRUE(has_same_bits(again.image, whole.image));
  EXPECT_EQ(again.rays.total(), whole.rays.total());
}

TEST_F(LibraryTest, ProgressivePicturesEndWhereTheyAreToldAndHaveTheBitsOfOthers) {
  Renderer renderer(device(), scene_);
  int calls = 0;
  renderer.render_progressively(view_, 1000.0, [&](const Image&, const View&) { return ++calls < 1; });
  EXPECT_EQ(calls, 1);
  View view = view_;
  view.samples_per_pixel = 4;
  Image last;
  View last_view;
  renderer.render_progressively(view, 1000.0, [&](const Image& image, const View& shown) {
    last = image;
    last_view = shown;
    return true;
  });
  EXPECT_EQ(last_view.size, view.size);
  EXPECT_EQ(last_view.samples_per_pixel, 4U);
  EXPECT_TRUE(has_same_bits(last, renderer.render(view).image));
}

TEST_F(LibraryTest, OcclusionIsWhetherAnythingIsHit) {
  Caster caster(device(), scene_);
  std::vector<Ray> rays;
  // Some directions are used unchanged; some have a length that is scaled.
  for (const float length : {1.0F, 0x1p127F}) {
    for (int i = 0; i < 3000; ++i) {
      const float x = static_cast<float>(i * 7919 % 3000) / 200.0F - 7.5F;
      rays.push_back({{x, 5, static_cast<float>(i % 60) / 6.0F - 5.0F}, 0, vec3(0, -length, 0)});
    }
  }
  std::vector<Hit> hits(rays.size());
  caster.cast(rays, hits);
  const auto are_occluded = std::make_unique<bool[]>(rays.size());
  const std::span<bool> answers(are_occluded.get(), rays.size());
  caster.occluded(rays, answers);
  for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(answers[i], hits[i].object >= 0) << i;
  EXPECT_GT(std::ranges::count(answers, true), 100);
  EXPECT_GT(std::ranges::count(answers, false), 100);
  EXPECT_THROW(caster.occluded(rays, answers.first(1)), UsageError);
}

TEST_F(LibraryTest, ABrokenOffCastStopsAtTheNextDispatchAndTheCasterStays) {
  Caster caster(device(), scene_);
  std::vector<Ray> rays(RayKernel::kMaxRays + 1, Ray{{0, 5, 0}, 0, {0, -1, 0}});
  std::vector<Hit> hits(rays.size());
  int calls = 0;
  double told = 0.0;
  const auto stops_at_once = [&](double fraction) {
    told = fraction;
    return ++calls < 1;
  };
  EXPECT_THROW(caster.cast(rays, hits, HitQuery::kNearest, stops_at_once), Cancelled);
  EXPECT_EQ(calls, 1);
  EXPECT_LT(told, 0.9) << "no dispatch but the last was told";
  const auto stops_late = [&](double fraction) { return fraction < 0.99999; };
  EXPECT_THROW(caster.cast(rays, hits, HitQuery::kNearest, stops_late), Cancelled);
  EXPECT_EQ(hits.front().object, 1);
  EXPECT_EQ(hits.back().object, -1) << "the dispatch of the second part ran";
  EXPECT_THROW(caster.cast(rays, std::span(hits).first(1)), UsageError);
  caster.cast(std::span(rays).first(2), std::span(hits).last(2));
  EXPECT_EQ(hits.back().object, 1);
}

}  // namespace
}  // namespace promin
