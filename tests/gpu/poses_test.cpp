// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare renderers and casters that show another pose with new ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "measure/meshes.h"
#include "promin/caster.h"
#include "promin/motion_vectors.h"
#include "promin/renderer.h"
#include "support/problems.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {
namespace {

/// A ball that twists and wanders, and other objects.
class PosesTest : public DeviceTest {
 protected:
  PosesTest() : ball_(std::get<Mesh>(measure::make_wavy_sphere(2000).objects[0].shape)) {}

  /// Returns the scene after a twist by this angle per unit of length.
  Scene pose(float twist) const {
    Scene scene;
    Phong red;
    red.diffuse = red.ambient = vec3(0.8F, 0.2F, 0.1F);
    Phong grey;
    grey.diffuse = vec3(0.5F + 0.01F * twist);
    scene.materials.resize(2);
    scene.materials[0].model = red;
    scene.materials[1].model = grey;
    Mesh twisted = ball_;
    for (vec3& p : twisted.positions) {
      const float angle = twist * p.y;
      p = {std::cos(angle) * p.x - std::sin(angle) * p.z, p.y, std::sin(angle) * p.x + std::cos(angle) * p.z};
    }
    scene.add("ball", std::move(twisted), 0, glm::translate(dmat4(1.0), dvec3(0.1 * double{twist}, 1.0, 0.0)));
    scene.add("sphere", Sphere{.radius = 0.5F}, 1, glm::translate(dmat4(1.0), dvec3(1.5, 1.0, double{twist})));
    scene.add("hidden", Sphere{.radius = 0.3F}, 1, glm::translate(dmat4(1.0), dvec3(-1.5, 1.0, 0.0)));
    scene.add("floor", Plane{}, 1);
    scene.lights.push_back(make_sun(vec3(0.3F, -1.0F, -0.2F + 0.1F * twist)));
    return scene;
  }

  /// Returns poses that are fitted and built, hide an object, lose a triangle, and show it again.
  std::vector<Scene> poses() const {
    std::vector<Scene> poses;
    for (const float twist : {0.0F, 0.1F, 0.2F, 6.0F}) poses.push_back(pose(twist));
    poses.push_back(pose(0.3F));
    poses.back().objects[2].geometry = Object::kNoGeometry;
    poses.push_back(pose(0.4F));
    Mesh& mesh = std::get<Mesh>(poses.back().geometries[0]);
    mesh.positions[mesh.triangles[7].x] = mesh.positions[mesh.triangles[7].y];
    poses.push_back(pose(0.0F));
    poses.push_back(pose(1e-3F));
    return poses;
  }

  Mesh ball_;
};

TEST_F(PosesTest, PicturesAreThoseOfANewRenderer) {
  TunedRendererOptions options;
  options.with_aovs = options.aovs.cryptomatte = true;
  // The kernels are those of MovedInstancesTest.
  options.more_features = features_of(make_scene_of_everything(50)) | layout::FEATURE_INSTANCES;
  View view = make_view({48, 32});
  view.samples_per_pixel = 2;
  const std::vector<Scene> all = poses();
  Renderer renderer = make_renderer(device(), all[0], options);
  renderer.render(view);
  const WorkDone before = renderer.work_done();
  Image last;
  for (size_t i = 1; i < all.size(); ++i) {
    renderer.set_pose(all[i]);
    const RenderResult picture = renderer.render(view);
    const RenderResult fresh = make_renderer(device(), all[i], options).render(view);
    EXPECT_TRUE(has_same_bits(picture.image, fresh.image)) << i;
    EXPECT_FALSE(has_same_bits(picture.image, last)) << i;
    last = picture.image;
    EXPECT_EQ(picture.aovs.depth, fresh.aovs.depth) << i;
    EXPECT_EQ(picture.aovs.object, fresh.aovs.object) << i;
    EXPECT_EQ(picture.aovs.primitive, fresh.aovs.primitive) << i;
    EXPECT_EQ(picture.aovs.normal, fresh.aovs.normal) << i;
    EXPECT_EQ(picture.aovs.object_coverage, fresh.aovs.object_coverage) << i;
    EXPECT_EQ(picture.aovs.material_coverage, fresh.aovs.material_coverage) << i;
  }
  EXPECT_EQ(renderer.work_done().pipelines_compiled, before.pipelines_compiled);
  EXPECT_EQ(renderer.work_done().trees_built - before.trees_built, 5U) << "two poses have fitted trees";
}

/// Turned normals need further vertices, whose number changes from pose to pose. The scene on the device has space for
/// them after the first change.
TEST_F(PosesTest, OtherNumbersOfVerticesNeedNoNewScene) {
  const auto pose_with = [&](uint32_t turned) {
    Scene scene = pose(0.1F * static_cast<float>(turned));
    Mesh& mesh = std::get<Mesh>(scene.geometries[0]);
    mesh.normals.clear();
    for (const vec3& p : mesh.positions) mesh.normals.push_back(glm::normalize(p));
    for (uint32_t i = 0; i < turned; ++i) {
      for (int corner = 0; corner < 3; ++corner) mesh.normals[mesh.triangles[100 * i][corner]] *= -1.0F;
    }
    return scene;
  };
  TunedRendererOptions options;
  options.more_features = features_of(make_scene_of_everything(50)) | layout::FEATURE_INSTANCES;
  const View view = make_view({48, 32});
  Renderer renderer = make_renderer(device(), pose_with(0), options);
  renderer.set_pose(pose_with(3));
  const auto scene = RendererAccess::scene_of(renderer).device_scene();
  for (const uint32_t turned : {5U, 0U, 2U}) {
    renderer.set_pose(pose_with(turned));
    EXPECT_EQ(RendererAccess::scene_of(renderer).device_scene(), scene) << turned;
    const RenderResult fresh = make_renderer(device(), pose_with(turned), options).render(view);
    EXPECT_TRUE(has_same_bits(renderer.render(view).image, fresh.image)) << turned;
  }
}

/// Poses in turn that need a new scene on the device: because it has instances and other geometry, or because an object
/// is hidden and shown. The spare vertices of one scene must not add to those of the next.
TEST_F(PosesTest, NewScenesDoNotGrow) {
  const auto pose_of = [&](bool has_instances, bool is_second) {
    Scene scene = pose(is_second ? 0.3F : 0.1F);
    Mesh& mesh = std::get<Mesh>(scene.geometries[0]);
    mesh.normals.clear();
    for (const vec3& p : mesh.positions) mesh.normals.push_back(glm::normalize(p));
    if (has_instances) {
      add_instances(scene, 0, std::vector<dmat4>(3, glm::translate(dmat4(1.0), dvec3(0.0, 3.0, 0.0))));
    } else if (is_second) {
      scene.objects[2].geometry = Object::kNoGeometry;
    }
    return scene;
  };
  for (const bool has_instances : {true, false}) {
    TunedRendererOptions options;
    options.instances = has_instances ? Instancing::kAll : Instancing::kNone;
    options.more_features = features_of(make_scene_of_everything(50)) | layout::FEATURE_INSTANCES;
    Renderer renderer = make_renderer(device(), pose_of(has_instances, false), options);
    std::vector<uint64_t> sizes = {RendererAccess::scene_of(renderer).device_scene()->size_bytes()};
    for (int i = 1; i <= 20; ++i) {
      const auto before = RendererAccess::scene_of(renderer).device_scene();
      renderer.set_pose(pose_of(has_instances, i % 2 == 1));
      EXPECT_NE(RendererAccess::scene_of(renderer).device_scene(), before) << i;
      sizes.push_back(RendererAccess::scene_of(renderer).device_scene()->size_bytes());
    }
    EXPECT_LT(sizes[2], sizes[0] + sizes[0] / 10);
    for (size_t i = 3; i < sizes.size(); ++i) EXPECT_EQ(sizes[i], sizes[i - 2]) << i << " " << has_instances;
  }
}

/// A pose uploads only the shading that changes, and each part of it once.
TEST_F(PosesTest, OnlyChangedShadingIsUploaded) {
  TunedRendererOptions options;
  options.with_aovs = options.aovs.cryptomatte = true;
  options.more_features = features_of(make_scene_of_everything(50)) | layout::FEATURE_INSTANCES;
  const Scene first = pose(0.0F);
  Renderer renderer = make_renderer(device(), first, options);
  const auto uploaded_by = [&](const Scene& posed) {
    const uint64_t before = renderer.work_done().shading_bytes_uploaded;
    renderer.set_pose(posed);
    return renderer.work_done().shading_bytes_uploaded - before;
  };
  Scene next = pose(0.2F);
  const std::vector<Material> materials = std::exchange(next.materials, first.materials);
  const std::vector<Light> lights = std::exchange(next.lights, first.lights);
  EXPECT_EQ(uploaded_by(next), 0U);
  next.lights = lights;
  const uint64_t of_lights = uploaded_by(next);
  EXPECT_GT(of_lights, 0U);
  // There may be a record of the environment.
  EXPECT_LE(of_lights, 2 * sizeof(layout::LightRecord));
  next.materials = materials;
  EXPECT_EQ(uploaded_by(next), materials.size() * sizeof(layout::MaterialRecord));
  next.materials = first.materials;
  next.lights = first.lights;
  EXPECT_EQ(uploaded_by(next), of_lights + materials.size() * sizeof(layout::MaterialRecord));
}

/// Steps show the tree, so the tree of each pose is built.
TEST_F(PosesTest, StepsAreThoseOfANewTree) {
  TunedRendererOptions options;
  options.aovs.steps = true;
  Renderer renderer = make_renderer(device(), pose(0.0F), options);
  const View view = make_view({32, 24});
  renderer.render(view);
  for (const float twist : {0.1F, 0.2F}) renderer.set_pose(pose(twist));
  const RenderResult picture = renderer.render(view);
  const RenderResult fresh = make_renderer(device(), pose(0.2F), options).render(view);
  EXPECT_EQ(picture.aovs.steps, fresh.aovs.steps);
}

TEST_F(PosesTest, HitsAreThoseOfANewCaster) {
  const std::vector<Scene> all = poses();
  Caster caster(device(), all[0]);
  const std::vector<Ray> rays = make_rays(20000);
  std::vector<Hit> hits(rays.size());
  std::vector<Hit> fresh_hits(rays.size());
  std::vector<int32_t> counts(rays.size());
  std::vector<int32_t> fresh_counts(rays.size());
  caster.cast(rays, hits);
  for (size_t i = 1; i < all.size(); ++i) {
    caster.set_pose(all[i]);
    Caster fresh(device(), all[i]);
    caster.cast(rays, hits);
    fresh.cast(rays, fresh_hits);
    EXPECT_EQ(std::memcmp(hits.data(), fresh_hits.data(), hits.size() * sizeof(Hit)), 0) << i;
    caster.count(rays, counts);
    fresh.count(rays, fresh_counts);
    EXPECT_EQ(counts, fresh_counts) << i;
  }
}

/// Instances and what is beside them.
TEST_F(PosesTest, InstancesMoveWithPoses) {
  const auto pose_of_instances = [&](double step, float twist) {
    Scene scene = pose(twist);
    std::vector<dmat4> maps;
    for (int i = 0; i < 20; ++i) maps.push_back(glm::translate(dmat4(1.0), dvec3(0.3 * i - 3.0, step * i, 0.5 * step)));
    add_instances(scene, 0, maps);
    return scene;
  };
  Caster caster(device(), pose_of_instances(0.0, 0.0F), {.instances = Instancing::kAll});
  const std::vector<Ray> rays = make_rays(5000);
  std::vector<Hit> hits(rays.size());
  std::vector<Hit> fresh_hits(rays.size());
  // The mesh, the sphere beside the instances, and only the instances change.
  for (const auto& [step, twist] : {std::pair(0.1, 0.5F), std::pair(0.2, 0.5F), std::pair(0.3, 0.5F)}) {
    const Scene posed = pose_of_instances(step, twist);
    caster.set_pose(posed);
    caster.cast(rays, hits);
    Caster(device(), posed, {.instances = Instancing::kAll}).cast(rays, fresh_hits);
    EXPECT_EQ(std::memcmp(hits.data(), fresh_hits.data(), hits.size() * sizeof(Hit)), 0);
  }
}

/// The AOV of motion is the same for instances and for copies.
TEST_F(PosesTest, InstancesHaveTheMotionOfCopies) {
  const auto make = [&](double step) {
    Scene scene = pose(0.1F);
    std::vector<dmat4> maps;
    for (int i = 0; i < 6; ++i) {
      const dmat4 map = glm::translate(dmat4(1.0), dvec3(0.8 * i - 2.0, 0.5 + step * i, 0.3 * i));
      maps.push_back(glm::scale(map, dvec3(0.4, i % 2 == 0 ? 0.4 : -0.4, 0.4)));
    }
    add_instances(scene, 0, maps);
    return scene;
  };
  const Scene scene = make(0.0);
  const Scene next = make(0.05);
  View view = make_view({48, 32});
  view.samples_per_pixel = 2;
  Camera camera = view.camera;
  camera.eye.x += 0.1F;
  std::vector<Aovs> all;
  for (const Instancing instancing : {Instancing::kAll, Instancing::kNone}) {
    TunedRendererOptions options;
    options.instances = instancing;
    options.aovs.motion = options.aovs.cryptomatte = true;
    options.more_features = features_of(make_scene_of_everything(50)) | layout::FEATURE_INSTANCES;
    all.push_back(make_renderer(device(), scene, options).render(view).aovs);
    add_motion(scene, view, next, camera, all.back());
  }
  size_t others = 0;
  size_t moved = 0;
  for (size_t i = 0; i < all[0].motion.size(); ++i) {
    const bool is_same = all[0].object[i] == all[1].object[i] && all[0].primitive[i] == all[1].primitive[i] &&
                         glm::distance(all[0].motion[i], all[1].motion[i]) < 1e-3F;
    others += is_same ? 0 : 1;
    moved += all[0].object[i] != Aovs::kNoId && all[0].object[i] > 3 && glm::length(all[0].motion[i]) > 0.5F ? 1 : 0;
  }
  EXPECT_LE(others, 6U);
  EXPECT_GT(moved, 50U);
}

TEST_F(PosesTest, OtherScenesAreRefused) {
  Caster caster(device(), pose(0.0F));
  Scene other = pose(0.0F);
  other.objects.pop_back();
  EXPECT_THAT([&] { caster.set_pose(other); }, FailsWith("scene.pose.other"));
  other = pose(0.0F);
  other.materials.emplace_back();
  EXPECT_THAT([&] { caster.set_pose(other); }, FailsWith("scene.pose.other"));
  other = pose(0.0F);
  other.objects[0].world_from_object[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { caster.set_pose(other); }, FailsWith("scene.transform.range"));
}

}  // namespace
}  // namespace promin::test
