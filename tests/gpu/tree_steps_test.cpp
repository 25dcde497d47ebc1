// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "device_scene/pack_scene.h"
#include "gpu/device_fixture.h"
#include "support/pipes.h"
#include "trace/kernels/ray_kernel.h"

namespace promin {
namespace {

constexpr size_t kRays = 50'000;

/// Returns chords of a ball around the unit cube.
std::vector<layout::RayRecord> make_chords() {
  std::mt19937 generator(2);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator()) * 0x1p-32 - 1.0; };
  const auto random_point = [&] {
    for (;;) {
      const double x = uniform();
      const double y = uniform();
      const dvec3 p(x, y, uniform());
      if (glm::length(p) <= 1.0 && glm::length(p) > 0.1) return vec3(0.5 + glm::normalize(p));
    }
  };
  std::vector<layout::RayRecord> rays;
  for (size_t i = 0; i < kRays; ++i) {
    const vec3 from = random_point();
    rays.push_back({vec4(from, 0.0F), vec4(random_point() - from, std::numeric_limits<float>::infinity())});
  }
  return rays;
}

struct Answers {
  std::vector<layout::HitRecord> records{kRays};
  uint64_t node_steps = 0;
  uint64_t tests = 0;
  uint64_t hits = 0;
};

class TreeSteps : public test::DeviceTest {
 protected:
  static Answers cast(const world::Scene& scene, std::string_view builder) {
    RayKernelOptions options;
    options.features |= layout::FEATURE_STEP_COUNTS;
    Answers answers;
    RayKernel(device(), upload_scene(device(), pack_scene(scene, builder)), options)
        .run(make_chords(), answers.records);
    for (layout::HitRecord& record : answers.records) {
      answers.node_steps += record.b.w & 0xFFFF;
      answers.tests += record.b.w >> 16;
      answers.hits += record.a.y != layout::NO_ORDER ? 1 : 0;
      record.b.w = 0;
    }
    return answers;
  }
};

// The tree of the offline builder is compared with the default builder's.
TEST_F(TreeSteps, SpatialSplitsTakeFewerStepsThroughPipesToTheSameHits) {
  world::Scene scene;
  scene.materials.resize(1);
  scene.objects = {{"pipes", test::make_pipes(300), 0}};
  const Answers sah = cast(scene, "sah");
  const Answers spatial = cast(scene, "spatial");
  EXPECT_GT(sah.hits, kRays / 20);
  EXPECT_EQ(std::memcmp(sah.records.data(), spatial.records.data(), kRays * sizeof(layout::HitRecord)), 0);
  EXPECT_LE(static_cast<double>(spatial.node_steps), 0.9 * static_cast<double>(sah.node_steps));
  EXPECT_LE(static_cast<double>(spatial.tests), 0.9 * static_cast<double>(sah.tests));
}

}  // namespace
}  // namespace promin
