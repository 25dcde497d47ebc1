// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare pictures and hits of instances with those of copied meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <string>
#include <utility>

#include "gpu/device_fixture.h"
#include "gpu/gallery.h"
#include "gpu/test_scenes.h"
#include "measure/meshes.h"
#include "measure/random.h"
#include "measure/ray_sets.h"
#include "promin/caster.h"
#include "support/problems.h"
#include "support/with_instances.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

using measure::Random;

/// Returns whether a pixel has the same surface in both pictures, except for rounding. Its object, primitive and
/// material are the same.
bool has_same_surface(const Aovs& a, const Aovs& b, size_t i) {
  if (a.object[i] != b.object[i] || a.primitive[i] != b.primitive[i] || a.material[i] != b.material[i]) return false;
  if (a.object[i] == Aovs::kNoId) return std::isinf(a.depth[i]) && std::isinf(b.depth[i]);
  const auto is_near = [i](const auto& of_a, const auto& of_b, double bound) {
    return glm::distance(of_a[i], of_b[i]) <= bound;
  };
  const double reach = 1e-4 * (1.0 + double{glm::length(a.position[i])});
  return is_near(a.depth, b.depth, reach) && is_near(a.position, b.position, reach) &&
         is_near(a.normal, b.normal, 1e-3) && is_near(a.shading_normal, b.shading_normal, 2e-3) &&
         is_near(a.uv, b.uv, 1e-3) && is_near(a.albedo, b.albedo, 5e-3);
}

class InstancesTest : public DeviceTest {
 protected:
  /// Compares pictures and AOVs of a scene with those of the same meshes as instances.
  static void expect_same_picture(const world::Scene& flat, const View& view, bool has_cryptomatte = false) {
    TunedRendererOptions options;
    options.aovs = AovSet::of_surfaces();
    options.aovs.error = false;
    options.aovs.cryptomatte = has_cryptomatte;
    const RenderResult a = make_renderer(device(), flat, options).render(view);
    const world::Scene scene = with_instances(flat);
    ASSERT_FALSE(scene.instances.empty());
    const RenderResult b = make_renderer(device(), scene, options).render(view);
    const size_t count = a.image.pixels.size();
    ASSERT_EQ(b.image.pixels.size(), count);
    double sum = 0.0;
    size_t failed = 0;
    size_t others = 0;
    for (size_t i = 0; i < count; ++i) {
      const vec3 difference = glm::abs(a.image.pixels[i] - b.image.pixels[i]);
      const float largest = std::max({difference.x, difference.y, difference.z});
      sum += largest;
      failed += largest <= 0.01F ? 0 : 1;
      others += has_same_surface(a.aovs, b.aovs, i) ? 0 : 1;
    }
    // Rounding selects another surface at some edges and in some mirrors.
    EXPECT_LE(failed, count / 250);
    EXPECT_LE(sum / static_cast<double>(count), 5e-4);
    EXPECT_LE(others, count / 500);
    if (!has_cryptomatte) return;
    size_t other_shares = 0;
    size_t shared = 0;
    for (size_t i = 0; i < count; ++i) {
      const bool is_same = a.aovs.object_coverage[i] == b.aovs.object_coverage[i] &&
                           a.aovs.material_coverage[i] == b.aovs.material_coverage[i];
      other_shares += is_same ? 0 : 1;
      shared += a.aovs.object_coverage[i][1].share > 0.0F ? 1 : 0;
    }
    EXPECT_LE(other_shares, count / 250);
    EXPECT_GT(shared, count / 100) << "pixels show two objects";
  }
};

View gallery_view() {
  View view = make_gallery_view({96, 64});
  view.samples_per_pixel = 4;
  return view;
}

TEST_F(InstancesTest, TexturesAndTangents) {
  expect_same_picture(make_gallery_of_metallic_roughness(), gallery_view());
}

TEST_F(InstancesTest, MasksAndBlending) {
  expect_same_picture(make_gallery_of_alpha(), gallery_view(), true);
}

TEST_F(InstancesTest, Glass) {
  View view = make_view({96, 64});
  view.samples_per_pixel = 2;
  expect_same_picture(make_scene_of_glass(), view);
}

/// The camera is inside a mesh of glass, whose instance is mirrored.
TEST_F(InstancesTest, CameraInGlass) {
  world::Scene scene = make_scene_of_everything(20);
  Material glass;
  glass.model = MetallicRoughness{.transmission = 1.0F};
  auto& model = std::get<MetallicRoughness>(glass.model);
  model.thickness = 1.0F;
  model.attenuation_distance = 2.0F;
  model.attenuation_color = vec3(0.3F, 0.9F, 0.5F);
  model.ior = 1.5F;
  scene.materials.push_back(glass);
  View view = make_view({48, 32});
  Mesh ball = std::get<Mesh>(measure::make_wavy_sphere(2000).objects[0].shape);
  for (vec3& p : ball.positions) p = view.camera.eye + 0.5F * p;
  if (scene.objects.size() % 2 != 0) scene.objects.push_back({"", world::NotDrawn{}});
  scene.objects.push_back({"glass", ball, static_cast<uint32_t>(scene.materials.size() - 1)});
  expect_same_picture(scene, view);
}

TEST_F(InstancesTest, CrossingsAndAnyHits) {
  const world::Scene flat = measure::make_wavy_sphere(3000);
  const world::Scene scene = with_instances(flat);
  Random random(5);
  std::vector<Ray> rays;
  for (int i = 0; i < 20000; ++i) {
    rays.push_back(measure::ray_towards(4.0 * random.direction(), 0.9 * random.direction()));
    // A light at a finite distance.
    if (i % 2 == 0) rays.back().tmax = static_cast<float>(random.uniform(1.0, 6.0));
  }
  Caster one = make_caster(device(), flat);
  Caster other = make_caster(device(), scene);
  const auto count_others = [](const auto& a, const auto& b, const auto& is_same) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i) count += is_same(a[i], b[i]) ? 0 : 1;
    return count;
  };
  std::vector<std::vector<int32_t>> counts(2, std::vector<int32_t>(rays.size()));
  one.count(rays, counts[0]);
  other.count(rays, counts[1]);
  EXPECT_LE(count_others(counts[0], counts[1], std::equal_to<>()), 4U);
  std::vector<std::vector<Hit>> hits(2, std::vector<Hit>(rays.size()));
  const auto is_same = [](const Hit& a, const Hit& b) { return a.object == b.object && a.primitive == b.primitive; };
  one.cast(rays, hits[0]);
  other.cast(rays, hits[1]);
  EXPECT_LE(count_others(hits[0], hits[1], is_same), 4U);
  std::vector<Hit> any(rays.size());
  other.cast(rays, any, HitQuery::kAny);
  const auto are_both_hits = [](const Hit& a, const Hit& b) { return (a.object >= 0) == (b.t == 0.0F); };
  EXPECT_EQ(count_others(hits[1], any, are_both_hits), 0U) << "any-hit rays agree with nearest hits exactly";
  size_t listed = 0;
  other.list(rays, [&](const HitList& list) { listed += list.hits.size(); });
  size_t counted = 0;
  for (const int32_t count : counts[1]) counted += static_cast<size_t>(count);
  EXPECT_EQ(listed, counted);
}

/// No bit of a hit depends on whether the trees of the meshes are built or read from a file, also after instances move.
TEST_F(InstancesTest, HitsAreThoseOfAFile) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("promin_instances_" + std::to_string(getpid()) + ".pbvh");
  const world::Scene scene = with_instances(make_scene_of_everything(60));
  std::vector<TreeView> views;
  const std::vector<GeometryTree> trees = build_scene_trees(scene, "spatial", {});
  for (const GeometryTree& tree : trees) views.push_back(tree.view());
  ASSERT_GT(views.size(), 1U);
  write_bvh_file(file, views);
  Caster of_built = make_caster(device(), scene);
  Caster of_file = make_caster(device(), scene, {.builder = "", .bvh = file});
  std::filesystem::remove(file);
  const std::vector<Ray> rays = make_rays(20000);
  std::vector<Hit> built(rays.size());
  std::vector<Hit> read(rays.size());
  const auto expect_same_hits = [&] {
    of_built.cast(rays, built);
    of_file.cast(rays, read);
    EXPECT_EQ(std::memcmp(read.data(), built.data(), rays.size() * sizeof(Hit)), 0);
  };
  expect_same_hits();
  const std::vector<Hit> before = built;
  std::vector<std::pair<uint32_t, dmat4>> moved;
  for (const world::Instance& instance : scene.instances) {
    dmat4 place(glm::inverse(dmat3(instance.map.object_from_world)));
    place[3] = dvec4(instance.map.origin + vec3(0.0F, 0.25F, 0.0F), 1.0);
    moved.emplace_back(instance.object, place);
  }
  of_built.set_transforms(moved);
  of_file.set_transforms(moved);
  expect_same_hits();
  EXPECT_NE(std::memcmp(before.data(), built.data(), rays.size() * sizeof(Hit)), 0);
}

/// Balls that share a mesh, among other objects. Half of them are mirrored.
class MovedInstancesTest : public DeviceTest {
 protected:
  static constexpr uint32_t kBalls = 40;

  MovedInstancesTest() : scene_(make_scene_of_everything(50)), random_(9) {
    first_ = static_cast<uint32_t>(scene_.objects.size());
    scene_.meshes.push_back(std::get<Mesh>(measure::make_wavy_sphere(300).objects[0].shape));
    for (uint32_t i = 0; i < kBalls; ++i) {
      scene_.instances.push_back({first_ + i, 0});
      scene_.objects.push_back({"ball " + std::to_string(i % 3), world::NotDrawn{}, i % 2});
    }
    for (uint32_t i = 0; i < kBalls; ++i) move(i, 3.0);
  }

  /// Gives a ball another transform, at most this far from the origin.
  std::pair<uint32_t, dmat4> move(uint32_t ball, double distance) {
    dmat4 map = glm::mat4_cast(glm::angleAxis(random_.uniform(-3.0, 3.0), random_.direction()));
    for (int axis = 0; axis < 3; ++axis) map[axis] *= random_.uniform(0.1, 0.4);
    if (random_.uniform(0.0, 1.0) < 0.5) map[1] *= -1.0;
    map[3] = dvec4(random_.uniform(0.0, distance) * random_.direction(), 1.0);
    scene_.instances[ball].map = world::map_of(map);
    return {first_ + ball, map};
  }

  std::vector<std::pair<uint32_t, dmat4>> move_all(double distance) {
    std::vector<std::pair<uint32_t, dmat4>> moved;
    for (uint32_t i = 0; i < kBalls; ++i) moved.push_back(move(i, distance));
    return moved;
  }

  world::Scene scene_;
  uint32_t first_ = 0;
  Random random_;
};

TEST_F(MovedInstancesTest, PicturesAreThoseOfANewRenderer) {
  TunedRendererOptions options;
  options.with_aovs = options.aovs.cryptomatte = true;
  View view = make_view({48, 32});
  view.samples_per_pixel = 2;
  Renderer renderer = make_renderer(device(), scene_, options);
  const Image first = renderer.render(view).image;
  const WorkDone before = renderer.work_done();
  // One moves, then all. The last move changes the bounds of the scene, so rays begin elsewhere.
  const std::vector<std::vector<std::pair<uint32_t, dmat4>>> moves = {{move(3, 2.0)}, move_all(3.0), {move(5, 1e5)}};
  for (const auto& moved : moves) renderer.set_transforms(moved);
  const RenderResult picture = renderer.render(view);
  const WorkDone after = renderer.work_done();
  EXPECT_EQ(after.trees_built, before.trees_built);
  EXPECT_EQ(after.geometry_bytes_uploaded, before.geometry_bytes_uploaded);
  EXPECT_EQ(after.pipelines_compiled, before.pipelines_compiled);
  EXPECT_GT(after.move_bytes_uploaded, 3 * kBalls * layout::INSTANCE_RECORDS * sizeof(layout::Node));
  EXPECT_LT(after.move_bytes_uploaded, 3 * kBalls * 200U);

  const RenderResult fresh = make_renderer(device(), scene_, options).render(view);
  EXPECT_TRUE(has_same_bits(picture.image, fresh.image));
  EXPECT_FALSE(has_same_bits(picture.image, first));
  EXPECT_GT(std::ranges::count_if(fresh.aovs.object, [&](uint32_t id) { return id >= first_ && id != Aovs::kNoId; }),
            20);
  EXPECT_EQ(picture.aovs.depth, fresh.aovs.depth);
  EXPECT_EQ(picture.aovs.object, fresh.aovs.object);
  EXPECT_EQ(picture.aovs.primitive, fresh.aovs.primitive);
  EXPECT_EQ(picture.aovs.normal, fresh.aovs.normal);
  EXPECT_EQ(picture.aovs.position, fresh.aovs.position);
  EXPECT_EQ(picture.rays.shadow, fresh.rays.shadow);
  EXPECT_EQ(picture.aovs.object_coverage, fresh.aovs.object_coverage);
  EXPECT_EQ(picture.aovs.material_coverage, fresh.aovs.material_coverage);
}

/// After the first pose, poses in which only instances move upload nothing else.
TEST_F(MovedInstancesTest, PosesMoveInstances) {
  TunedRendererOptions options;
  options.with_aovs = options.aovs.cryptomatte = true;
  const View view = make_view({48, 32});
  Renderer renderer = make_renderer(device(), scene_, options);
  RendererAccess::set_pose(renderer, scene_, TreeOfPose::kRefitted);
  const WorkDone before = renderer.work_done();
  move_all(2.0);
  RendererAccess::set_pose(renderer, scene_, TreeOfPose::kRefitted);
  const WorkDone after = renderer.work_done();
  EXPECT_EQ(after.geometry_bytes_uploaded, before.geometry_bytes_uploaded);
  EXPECT_EQ(after.trees_built, before.trees_built);
  const RenderResult fresh = make_renderer(device(), scene_, options).render(view);
  EXPECT_TRUE(has_same_bits(renderer.render(view).image, fresh.image));
  // A sphere beside the instances moves.
  for (world::Object& object : scene_.objects) {
    if (auto* sphere = std::get_if<world::Sphere>(&object.shape)) sphere->center.y += 0.5F;
  }
  RendererAccess::set_pose(renderer, scene_, TreeOfPose::kRefitted);
  EXPECT_GT(renderer.work_done().geometry_bytes_uploaded, after.geometry_bytes_uploaded);
  EXPECT_TRUE(has_same_bits(renderer.render(view).image, make_renderer(device(), scene_, options).render(view).image));
}

TEST_F(MovedInstancesTest, HitsAreThoseOfANewCaster) {
  Caster caster = make_caster(device(), scene_);
  const std::vector<Ray> rays = make_rays(20000);
  const auto list_all = [&](Caster& of) {
    std::vector<Hit> hits;
    of.list(rays, [&](const HitList& list) { hits.insert(hits.end(), list.hits.begin(), list.hits.end()); });
    return hits;
  };
  list_all(caster);
  // First all balls have one centre, later they do not, so the upper level needs more or less space.
  for (const double distance : {0.0, 3.0, 1e4}) {
    caster.set_transforms(move_all(distance));
    Caster fresh = make_caster(device(), scene_);
    std::vector<Hit> hits(rays.size());
    std::vector<Hit> fresh_hits(rays.size());
    for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
      caster.cast(rays, hits, query);
      fresh.cast(rays, fresh_hits, query);
      EXPECT_EQ(std::memcmp(hits.data(), fresh_hits.data(), hits.size() * sizeof(Hit)), 0);
    }
    const std::vector<Hit> listed = list_all(caster);
    const std::vector<Hit> fresh_listed = list_all(fresh);
    ASSERT_EQ(listed.size(), fresh_listed.size());
    EXPECT_EQ(std::memcmp(listed.data(), fresh_listed.data(), listed.size() * sizeof(Hit)), 0);
  }
}

TEST_F(MovedInstancesTest, WrongTransformsChangeNothing) {
  Caster caster = make_caster(device(), scene_);
  const std::vector<Ray> rays = make_rays(1000);
  std::vector<Hit> before(rays.size());
  caster.cast(rays, before);
  dmat4 sheared(1.0);
  sheared[1].x = 50.0;
  dmat4 far(1.0);
  far[3].x = 1e16;
  dmat4 projective(1.0);
  projective[0].w = 1.0;
  const auto refuse = [&](uint32_t object, const dmat4& transform, const char* code) {
    const std::vector<std::pair<uint32_t, dmat4>> moved = {{first_ + 1, dmat4(1.0)}, {object, transform}};
    EXPECT_THAT([&] { caster.set_transforms(moved); }, FailsWith(code));
  };
  refuse(9999, dmat4(1.0), "scene.reference.range");
  refuse(0, dmat4(1.0), "scene.move.copied");
  refuse(first_, dmat4(std::numeric_limits<double>::quiet_NaN()), "scene.transform.range");
  refuse(first_, dmat4(0.0), "scene.transform.affine");
  refuse(first_, projective, "scene.transform.affine");
  refuse(first_, dmat4(dmat3(0.0)), "scene.transform.singular");
  refuse(first_, sheared, "scene.move.sheared");
  refuse(first_, far, "scene.position.far");
  std::vector<Hit> after(rays.size());
  caster.cast(rays, after);
  EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size() * sizeof(Hit)), 0);
  caster.set_transforms({});
}

/// Kernels that can trace instances give the same bits for a scene without instances.
TEST_F(InstancesTest, FeatureDoesNotChangeOtherScenes) {
  const world::Scene scene = make_scene_of_everything(50);
  const View view = make_view({64, 48});
  TunedRendererOptions options;
  const Image plain = make_renderer(device(), scene, options).render(view).image;
  options.more_features = layout::FEATURE_INSTANCES;
  EXPECT_TRUE(has_same_bits(make_renderer(device(), scene, options).render(view).image, plain));
}

}  // namespace
}  // namespace promin::test
