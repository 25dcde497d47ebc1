// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check pack_scene_sharing(): the first process that needs a tree builds and writes it, and the others read
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <future>
#include <optional>

#include "core/file.h"
#include "core/file_lock.h"
#include "device_scene/pack_scene.h"
#include "promin/error.h"
#include "support/sheet.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

world::Scene make_scene(size_t triangle_count) {
  world::Scene scene;
  scene.file = "sheet";
  scene.materials.resize(1);
  scene.objects = {{"", make_sheet(triangle_count), 0}};
  return scene;
}

class SharedTreeTest : public TempFolder {
 protected:
  PackedScene pack(const world::Scene& scene, const BuildOptions& options = {}) const {
    return pack_scene_sharing(file_, scene, "median", options);
  }
  /// Expects that the packed scene has the tree of this test, and the primitives in the tree's order.
  void expect_is_own(const PackedScene& packed) const {
    const auto is_same = [](const auto& a, const auto& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), std::as_bytes(std::span(a)).size()) == 0;
    };
    EXPECT_TRUE(is_same(packed.tree().nodes, own_.tree().nodes));
    EXPECT_TRUE(is_same(packed.tree().references, own_.tree().references));
    EXPECT_TRUE(is_same(packed.primitives, own_.primitives));
    EXPECT_EQ(packed.stack_size, own_.stack_size);
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(file_.parent_path())) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
  }

  /// The file's folder does not exist yet.
  const fs::path file_ = folder_ / "trees" / "median.pbvh";
  const world::Scene scene_ = make_scene(kLeastShared + kLeastShared / 10);
  const PackedScene own_ = pack_scene(scene_, "median");
};

TEST_F(SharedTreeTest, TheFirstBuildsAndOthersRead) {
  const PackedScene first = pack(scene_);
  EXPECT_EQ(first.file, nullptr);
  expect_is_own(first);
  const auto stamp = stamp_of(file_);
  write_bvh_file(folder_ / "own.pbvh", own_.tree());
  EXPECT_EQ(read_file(file_), read_file(folder_ / "own.pbvh"));
  const PackedScene second = pack(scene_);
  EXPECT_NE(second.file, nullptr);
  expect_is_own(second);
  EXPECT_EQ(stamp_of(file_), stamp);
  EXPECT_THAT(second.warnings, IsEmpty());
  EXPECT_THAT(files(), testing::ElementsAre("median.lock", "median.pbvh"));
}

TEST_F(SharedTreeTest, ThoseWhoBeginAtOnceBuildOne) {
  std::vector<std::future<PackedScene>> all;
  for (int i = 0; i < 4; ++i) all.push_back(std::async(std::launch::async, [&] { return pack(scene_); }));
  int built = 0;
  for (auto& one : all) {
    const PackedScene packed = one.get();
    expect_is_own(packed);
    built += packed.file == nullptr ? 1 : 0;
  }
  EXPECT_EQ(built, 1);
}

TEST_F(SharedTreeTest, WhatIsDamagedIsBuiltAgain) {
  pack(scene_);
  const std::vector<std::byte> whole = read_file(file_);
  const auto write = [&](std::span<const std::byte> bytes) {
    fs::remove(file_);
    write_file(file_, {bytes});
  };
  std::vector<std::byte> flipped = whole;
  flipped[whole.size() / 2] ^= std::byte{4};
  world::Scene other = scene_;
  std::get<Mesh>(other.objects[0].shape).positions[0].x += 0.01F;
  write_bvh_file(folder_ / "other.pbvh", pack_scene(other, "median").tree());
  for (const auto& [bytes, why] : {std::pair(std::vector(whole.begin(), whole.end() - 100), "bytes, but its header"),
                                   std::pair(std::vector<std::byte>(), "empty"), std::pair(flipped, "damaged"),
                                   std::pair(read_file(folder_ / "other.pbvh"), "does not belong")}) {
    write(bytes);
    const PackedScene packed = pack(scene_);
    EXPECT_EQ(packed.file, nullptr);
    expect_is_own(packed);
    ASSERT_EQ(packed.warnings.size(), 1U) << why;
    EXPECT_THAT(packed.warnings[0].sentence(), HasSubstr(why));
    EXPECT_THAT(packed.warnings[0].sentence(), testing::StartsWith(file_.string() + ": "));
    EXPECT_EQ(read_file(file_), whole) << why;
  }
}

TEST_F(SharedTreeTest, WhatADeadWriterLeftIsRemoved) {
  fs::create_directory(file_.parent_path());
  // No process has this number.
  std::ofstream(file_.parent_path() / ("median.tmp99999999-" + host_name() + ".pbvh")) << "half";
  pack(scene_);
  EXPECT_THAT(files(), testing::ElementsAre("median.lock", "median.pbvh"));
}

TEST_F(SharedTreeTest, SmallTreesHaveNoFile) {
  pack(make_scene(kLeastShared - kLeastShared / 10));
  EXPECT_FALSE(fs::exists(file_.parent_path()));
}

TEST_F(SharedTreeTest, WhereItCannotBeWrittenEverybodyBuilds) {
  std::ofstream(file_.parent_path()) << "a file in the folder's place";
  const PackedScene packed = pack(scene_);
  expect_is_own(packed);
  ASSERT_EQ(packed.warnings.size(), 1U);
  EXPECT_THAT(packed.warnings[0].sentence(), HasSubstr(file_.string()));
}

TEST_F(SharedTreeTest, WhoIsAskedToStopStopsAndLeavesNothing) {
  EXPECT_THROW(pack(scene_, {.progress = [](double) { return false; }}), Cancelled);
  EXPECT_THAT(files(), testing::ElementsAre("median.lock"));
  EXPECT_EQ(pack(scene_).file, nullptr);
}

TEST_F(SharedTreeTest, WhoWaitsForAnotherMayBeStopped) {
  fs::create_directory(file_.parent_path());
  auto held =
      std::make_optional<FileLock>(file_.parent_path() / "median.lock", std::chrono::seconds(1), ProgressCallback());
  auto waiting =
      std::async(std::launch::async, [&] { return pack(scene_, {.progress = [](double) { return false; }}); });
  const bool is_over = waiting.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
  held.reset();
  EXPECT_TRUE(is_over);
  EXPECT_THROW(waiting.get(), Cancelled);
}

}  // namespace
}  // namespace promin
