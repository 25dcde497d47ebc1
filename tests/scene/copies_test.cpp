// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/copies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/free_memory.h"
#include "promin/error.h"
#include "scene/world_scene.h"
#include "support/problems.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

class ControlGroupTest : public TempFolder {
 protected:
  void write(const char* file, const char* text) const { std::ofstream(folder_ / file) << text; }
};

/// Returns a scene of objects that share a mesh.
Scene make_herd(size_t triangles, size_t objects) {
  Mesh mesh;
  mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
  mesh.triangles.assign(triangles, uvec3(0, 1, 2));
  Scene scene;
  scene.file = "herd.glb";
  scene.materials.emplace_back();
  scene.add("", mesh);
  scene.objects.resize(objects, scene.objects.front());
  return scene;
}

/// The copies would take hundreds of gigabytes, so the scene must be refused before anything is copied.
TEST(CopiesTest, TooManyCopiesAreRefusedBeforeTheyAreMade) {
  const Scene scene = make_herd(10'000, 1'000'000);
  EXPECT_THAT([&] { world::flatten(scene, world::Purpose::kHits, Instancing::kNone); }, FailsWith("scene.size.limit"));
  EXPECT_EQ(world::flatten(scene, world::Purpose::kHits, Instancing::kAuto).instances.size(), 1'000'000U);
}

TEST(CopiesTest, InstancesTakeNothing) {
  const Scene scene = make_herd(100, 3);
  const Copies all = count_copies(scene, {false, false, false});
  const Copies one = count_copies(scene, {true, false, true});
  EXPECT_EQ(all.triangles, 300U);
  EXPECT_EQ(one.triangles, 100U);
  EXPECT_EQ(all.bytes, 3 * one.bytes);
  EXPECT_GT(one.bytes, 100U * 100U);
}

TEST(CopiesTest, CopiesThatDoNotFitIntoMemoryAreRefused) {
  const Copies copies{.triangles = 1000, .bytes = 1'000'000};
  EXPECT_NO_THROW(check_copies(copies, 1'000'000, "a.glb"));
  EXPECT_NO_THROW(check_copies(copies, std::nullopt, "a.glb"));
  EXPECT_THAT([&] { check_copies(copies, 999'999, "a.glb"); }, FailsWith("scene.memory.short"));
}

TEST(FreeMemoryTest, SomeMemoryIsAvailable) {
  const std::optional<uint64_t> bytes = available_memory();
  ASSERT_TRUE(bytes.has_value());
  EXPECT_GT(*bytes, uint64_t{1} << 20);
}

TEST_F(ControlGroupTest, WithoutALimitNothingIsKnown) {
  EXPECT_EQ(available_in_group(folder_), std::nullopt);
  write("memory.current", "1000\n");
  write("memory.max", "max\n");
  EXPECT_EQ(available_in_group(folder_), std::nullopt);
}

TEST_F(ControlGroupTest, UsedMemoryIsNotAvailable) {
  write("memory.max", "5000\n");
  EXPECT_EQ(available_in_group(folder_), 5000U);
  write("memory.current", "3000\n");
  EXPECT_EQ(available_in_group(folder_), 2000U);
  write("memory.current", "6000\n");
  EXPECT_EQ(available_in_group(folder_), 0U);
}

TEST_F(ControlGroupTest, CopiesOfFilesAreAvailable) {
  write("memory.max", "5000\n");
  write("memory.current", "4000\n");
  write("memory.stat", "anon 500\nfile 3500\ninactive_file 2000\nactive_file 1000\n");
  EXPECT_EQ(available_in_group(folder_), 4000U);
  write("memory.current", "100\n");
  EXPECT_EQ(available_in_group(folder_), 5000U);
}

}  // namespace
}  // namespace promin
