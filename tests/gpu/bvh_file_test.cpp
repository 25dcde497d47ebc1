// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/bvh_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "device_scene/pack_scene.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "promin/renderer.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

/// A test with a device and a folder.
class BvhFileOnDevice : public test::DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    DeviceTest::TearDown();
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("promin_bvh_file_on_device_" + std::to_string(getpid()));
  std::filesystem::path file_ = folder_ / "tree.pbvh";
};

TEST_F(BvhFileOnDevice, PicturesAndHitsAreThoseOfTheBuiltTree) {
  const world::Scene scene = test::make_scene_of_everything(500);
  const View view = test::make_view(uvec2(120, 80));
  const std::vector<Ray> rays = test::make_rays(20000);
  for (const std::string_view name : builder_names()) {
    const std::string builder(name);
    SCOPED_TRACE(builder);
    write_bvh_file(file_, pack_scene(scene, builder).tree());

    Renderer built = make_renderer(device(), scene, {.builder = builder});
    Renderer read = make_renderer(device(), scene, {.builder = "", .bvh = file_});
    EXPECT_TRUE(test::has_same_bits(built.render(view).image, read.render(view).image));
    EXPECT_EQ(read.setup_stats().bvh.builder, builder);
    EXPECT_EQ(read.setup_stats().bvh.sah_cost, built.setup_stats().bvh.sah_cost);
    EXPECT_EQ(read.setup_stats().device_bytes, built.setup_stats().device_bytes);

    std::vector<Hit> hits(rays.size());
    std::vector<Hit> expected(rays.size());
    make_caster(device(), scene, {.builder = builder}).cast(rays, expected);
    make_caster(device(), scene, {.builder = "", .bvh = file_}).cast(rays, hits);
    EXPECT_EQ(std::memcmp(hits.data(), expected.data(), rays.size() * sizeof(Hit)), 0);
  }
}

TEST_F(BvhFileOnDevice, AFileOfAnotherSceneIsRefused) {
  write_bvh_file(file_, pack_scene(test::make_scene_of_everything(3), "sah").tree());
  const world::Scene scene = test::make_scene_of_everything(4);
  EXPECT_THROW(make_renderer(device(), scene, {.bvh = file_}), InputError);
  EXPECT_THROW(make_caster(device(), scene, {.bvh = file_}), InputError);
  EXPECT_THROW(make_caster(device(), scene, {.bvh = folder_ / "none.pbvh"}), InputError);
}

}  // namespace
}  // namespace promin
