// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare node steps and primitive tests of fixed rays through fixed scenes with stored numbers, for every
// builder. The numbers show what makes rays faster or slower on any machine. PROMIN_UPDATE_COUNTS=1, which
// tools/update_counts sets, stores new numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "core/file.h"
#include "gpu/device_fixture.h"
#include "measure/meshes.h"
#include "measure/step_counts.h"
#include "promin/caster.h"
#include "promin/load_scene.h"
#include "trace/render/caster_access.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using measure::RaySet;
using measure::StepCounts;

constexpr uint32_t kSide = 128;
/// GPUs may round a division differently from CPU drivers; on CPU drivers no count may differ.
constexpr double kGpuTolerance = 1e-3;

/// The counts of one scene. The key is "builder rays".
using Counts = std::map<std::string, StepCounts>;

constexpr const char* kHead = "# builder rays: count hits node_steps primitive_tests; by tools/update_counts\n";

std::string to_text(const Counts& counts) {
  std::string text = kHead;
  for (const auto& [name, c] : counts) {
    text += fmt::format("{} {} {} {} {}\n", name, c.rays, c.hits, c.node_steps, c.primitive_tests);
  }
  return text;
}

Counts read_counts(const fs::path& file) {
  Counts counts;
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string builder;
    std::string rays;
    StepCounts c;
    if (words >> builder >> rays >> c.rays >> c.hits >> c.node_steps >> c.primitive_tests) {
      counts[builder + " " + rays] = c;
    }
  }
  return counts;
}

bool is_near(uint64_t value, uint64_t stored, double tolerance) {
  const auto wanted = static_cast<double>(stored);
  return std::abs(static_cast<double>(value) - wanted) <= tolerance * wanted;
}

std::string describe_change(const char* what, uint64_t stored, uint64_t now) {
  if (stored == now) return "";
  const double percent = 100.0 * (static_cast<double>(now) / static_cast<double>(stored) - 1.0);
  return fmt::format("; {} {} -> {} ({:+.3f} %)", what, stored, now, percent);
}

/// Returns an empty text if all counts are as stored; otherwise a line for each count that is not.
std::string compare_counts(const Counts& now, const Counts& stored, double tolerance) {
  std::string text;
  for (const auto& [name, c] : now) {
    const auto found = stored.find(name);
    if (found == stored.end()) {
      text += name + ": nothing is stored\n";
      continue;
    }
    const StepCounts& s = found->second;
    if (is_near(c.rays, s.rays, tolerance) && is_near(c.hits, s.hits, tolerance) &&
        is_near(c.node_steps, s.node_steps, tolerance) && is_near(c.primitive_tests, s.primitive_tests, tolerance)) {
      continue;
    }
    text += name + describe_change("rays", s.rays, c.rays) + describe_change("hits", s.hits, c.hits) +
            describe_change("node steps", s.node_steps, c.node_steps) +
            describe_change("primitive tests", s.primitive_tests, c.primitive_tests) + "\n";
  }
  for (const auto& [name, unused] : stored) {
    if (!now.contains(name)) text += name + ": is stored, but no longer counted\n";
  }
  return text;
}

world::Scene make_scene(const std::string& name) {
  if (name == "wavy") return measure::make_wavy_sphere(20000);
  if (name == "needles") return measure::make_needles(5000);
  return world::flatten(load_scene(fs::path(PROMIN_SCENES_DIR) / (name + ".gltf")));
}

class StepCountsTest : public test::DeviceTest, public testing::WithParamInterface<const char*> {
 protected:
  static Counts count_all(const world::Scene& scene) {
    const Camera camera = scene.cameras.empty() ? look_from_front(scene, 1.0F) : scene.cameras.front();
    std::vector<RaySet> sets = {measure::make_camera_rays(camera, uvec2(kSide))};
    std::vector<Hit> hits(sets[0].rays.size());
    make_caster(device(), scene).cast(sets[0].rays, hits);
    sets.push_back(measure::make_shadow_rays(sets[0], hits, scene, camera));
    sets.push_back(measure::make_random_rays(scene, hits.size()));
    Counts counts;
    for (const std::string_view builder : builder_names()) {
      const measure::StepCounter counter(device(), scene, builder);
      for (const RaySet& set : sets) counts[fmt::format("{} {}", builder, set.name)] = counter.count(set);
    }
    return counts;
  }
};

TEST_P(StepCountsTest, AreAsStored) {
  const fs::path file = fs::path(PROMIN_COUNTS_DIR) / (std::string(GetParam()) + ".txt");
  const Counts counts = count_all(make_scene(GetParam()));
  if (std::getenv("PROMIN_UPDATE_COUNTS") != nullptr) {
    fs::create_directories(PROMIN_COUNTS_DIR);
    write_text_file(file, to_text(counts));
    return;
  }
  const double tolerance = gpu::info_of(device()).type == "CPU" ? 0.0 : kGpuTolerance;
  EXPECT_EQ(compare_counts(counts, read_counts(file), tolerance), "")
      << "if this is meant and for the better, run tools/update_counts and say why in the commit";
}

INSTANTIATE_TEST_SUITE_P(Scenes, StepCountsTest,
                         testing::Values("all_primitives", "showcase", "sphereflake", "wavy", "needles"),
                         [](const auto& param_info) { return std::string(param_info.param); });

class RaysFromAfarTest : public test::DeviceTest {};

/// Returns rays from this distance at points of the unit ball, as exactly as fp32 can represent them.
RaySet make_rays_from(double distance) {
  RaySet set{"from afar", HitQuery::kNearest, {}};
  std::mt19937 generator(1);
  const auto random = [&] { return static_cast<double>(generator()) * 0x1p-31 - 1.0; };
  while (set.rays.size() < 4096) {
    const dvec3 target(random(), random(), random());
    const dvec3 way(random(), random(), random());
    if (glm::length(target) > 1.0 || glm::length(way) < 0.1) continue;
    const vec3 direction(glm::normalize(way));
    set.rays.push_back({vec3(target - distance * dvec3(direction)), 0.0F, direction});
  }
  return set;
}

// On an endless floor, mirror and shadow rays start far away, and the margin of a box grows with the distance. Without
// a correction these rays would hit every box, and llvmpipe would cut the loops.
TEST_F(RaysFromAfarTest, TakeNoMoreStepsThanOthers) {
  const measure::StepCounter counter(device(), measure::make_wavy_sphere(20000), "sah");
  const StepCounts near = counter.count(make_rays_from(10.0));
  EXPECT_GT(near.hits, near.rays / 2);
  for (const double distance : {1e3, 1e4, 1e5, 1e6}) {
    const StepCounts far = counter.count(make_rays_from(distance));
    EXPECT_LT(static_cast<double>(far.node_steps), 1.5 * static_cast<double>(near.node_steps)) << distance;
    EXPECT_NEAR(static_cast<double>(far.hits), static_cast<double>(near.hits), 0.03 * near.rays) << distance;
  }
  // At these distances fp32's grid is as coarse as the tree; most rays miss the tree, and others go through its middle.
  for (const double distance : {1e7, 1e8, 1e9, 1e12}) {
    const StepCounts far = counter.count(make_rays_from(distance));
    EXPECT_LT(static_cast<double>(far.node_steps), 3.0 * static_cast<double>(near.node_steps)) << distance;
  }
}

TEST(CompareCountsTest, SeesOneStepMoreAndWhatIsMissing) {
  const Counts stored = {{"sah camera", {100, 50, 1000, 200}}, {"sah random", {100, 50, 1000, 200}}};
  EXPECT_EQ(compare_counts(stored, stored, 0.0), "");
  Counts changed = stored;
  changed["sah camera"].node_steps = 1001;
  EXPECT_EQ(compare_counts(changed, stored, 0.0), "sah camera; node steps 1000 -> 1001 (+0.100 %)\n");
  EXPECT_EQ(compare_counts(changed, stored, kGpuTolerance), "");
  changed["sah camera"].node_steps = 1002;
  EXPECT_NE(compare_counts(changed, stored, kGpuTolerance), "");
  EXPECT_EQ(compare_counts(stored, {}, 0.0), "sah camera: nothing is stored\nsah random: nothing is stored\n");
  EXPECT_EQ(compare_counts({}, {*stored.begin()}, 0.0), "sah camera: is stored, but no longer counted\n");
}

TEST(CompareCountsTest, ReadsWhatIsWritten) {
  const Counts counts = {{"median shadow", {1, 2, 3, 4}}, {"sah camera", {100, 50, 1000, 200}}};
  const fs::path file = fs::path(testing::TempDir()) / "promin_counts.txt";
  write_text_file(file, to_text(counts));
  EXPECT_EQ(read_counts(file), counts);
  fs::remove(file);
}

}  // namespace
}  // namespace promin
