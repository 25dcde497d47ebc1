// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <ostream>
#include <random>

#include "bvh/builder.h"
#include "promin/error.h"
#include "support/expect_tree.h"

namespace promin {
namespace {

using Boxes = std::vector<Bounds>;

/// A function that makes boxes that may be difficult for a builder.
struct BoxSet {
  const char* name;
  Boxes (*make)();
};

std::ostream& operator<<(std::ostream& out, const BoxSet& scene) {
  return out << scene.name;
}

Bounds box_around(const vec3& center, const vec3& half_size) {
  return {center - half_size, center + half_size};
}

float random_between(std::mt19937& random, float lo, float hi) {
  return lo + (hi - lo) * static_cast<float>(random() >> 8) * 0x1p-24F;
}

vec3 random_point(std::mt19937& random, float lo, float hi) {
  const float x = random_between(random, lo, hi);
  const float y = random_between(random, lo, hi);
  return {x, y, random_between(random, lo, hi)};
}

Boxes make_random(uint32_t count, float scale) {
  std::mt19937 random(1);
  Boxes boxes;
  for (uint32_t i = 0; i < count; ++i) {
    const vec3 center = random_point(random, -scale, scale);
    boxes.push_back(box_around(center, random_point(random, 0.0F, 0.01F * scale)));
  }
  return boxes;
}

/// Returns clusters of a thousand small boxes each, far from one another, and a few boxes as large as the whole scene.
Boxes make_clusters() {
  std::mt19937 random(2);
  Boxes boxes;
  for (int cluster = 0; cluster < 60; ++cluster) {
    const vec3 middle = random_point(random, -1e3F, 1e3F);
    for (int i = 0; i < 1000; ++i) {
      boxes.push_back(box_around(middle + random_point(random, -1.0F, 1.0F), random_point(random, 0.0F, 0.05F)));
    }
    boxes.push_back(box_around(vec3(0.0F), vec3(1e3F, 1e3F, 10.0F)));
  }
  return boxes;
}

/// Returns centres at 2^-140...2^49 on each axis, several at each place. Planes at equal distances split off only the
/// few largest boxes at a time.
Boxes make_geometric_series() {
  Boxes boxes;
  for (int exponent = 49; exponent >= -140; --exponent) {
    for (int axis = 0; axis < 3; ++axis) {
      vec3 center(0.0F);
      center[axis] = std::ldexp(1.0F, exponent);
      for (int copy = 0; copy < 60; ++copy) boxes.push_back(box_around(center, vec3(0.0F)));
    }
  }
  return boxes;
}

/// Returns boxes without extent along one line: every area is 0.
Boxes make_points_on_a_line() {
  Boxes boxes;
  for (int exponent = 49; exponent >= -140; --exponent) {
    for (int copy = 0; copy < 20; ++copy) {
      boxes.push_back(box_around({std::ldexp(1.0F, exponent) * static_cast<float>(1 + copy), 0, 0}, vec3(0.0F)));
    }
  }
  return boxes;
}

Boxes make_flat_grid() {
  Boxes boxes;
  for (int x = 0; x < 100; ++x) {
    for (int z = 0; z < 100; ++z) boxes.push_back({vec3(x, 2, z), vec3(x + 1, 2, z + 1)});
  }
  return boxes;
}

Boxes make_concentric() {
  Boxes boxes;
  for (int i = 1; i <= 5000; ++i) boxes.push_back(box_around(vec3(0.0F), vec3(static_cast<float>(i))));
  return boxes;
}

constexpr float kLargest = std::numeric_limits<float>::max();

const BoxSet kBoxSets[] = {
    {"one", [] { return make_random(1, 1.0F); }},
    {"two", [] { return make_random(2, 1.0F); }},
    {"three", [] { return make_random(3, 1.0F); }},
    {"seventeen", [] { return make_random(17, 1.0F); }},
    {"coincident",
     [] {
       return Boxes(10'000, box_around({1, 2, 3}, vec3(0.5F)));
     }},
    {"coincident_beyond_a_subtree",
     [] {
       return Boxes(20'000, box_around({1, 2, 3}, vec3(0.0F)));
     }},
    {"concentric", make_concentric},
    {"random", [] { return make_random(100'000, 1.0F); }},
    {"clusters", make_clusters},
    {"geometric_series", make_geometric_series},
    {"points_on_a_line", make_points_on_a_line},
    {"flat_grid", make_flat_grid},
    {"huge", [] { return make_random(1000, 1e15F); }},
    {"tiny", [] { return make_random(1000, 1e-22F); }},
    {"all_floats",
     [] {
       return Boxes{{vec3(-kLargest), vec3(kLargest)},
                    {vec3(kLargest), vec3(kLargest)},
                    {vec3(-kLargest), vec3(-kLargest)},
                    {vec3(0.0F), vec3(0x1p-149F)}};
     }},
};

class BvhTest : public testing::TestWithParam<std::tuple<std::string_view, BoxSet>> {
 protected:
  std::string_view builder() const { return std::get<0>(GetParam()); }
  Boxes boxes() const { return std::get<1>(GetParam()).make(); }
};

TEST_P(BvhTest, IsATreeOverAllBoxes) {
  const Boxes input = boxes();
  const Bvh bvh = build_bvh(builder(), {input});
  test::expect_tree(bvh);
  std::vector<int> box_uses(input.size(), 0);
  for (const BvhNode& node : bvh.nodes) {
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      box_uses.at(bvh.references[k]) += 1;
      ASSERT_TRUE(test::contains(node.bounds, input[bvh.references[k]])) << k;
    }
  }
  EXPECT_THAT(box_uses, testing::Each(1));
}

TEST_P(BvhTest, BoxesAreTight) {
  const Boxes input = boxes();
  const Bvh bvh = build_bvh(builder(), {input});
  Bounds all;
  for (const Bounds& box : input) all.extend(box);
  EXPECT_EQ(bvh.nodes[0].bounds.lo, all.lo);
  EXPECT_EQ(bvh.nodes[0].bounds.hi, all.hi);
  for (const BvhNode& node : bvh.nodes) {
    Bounds inside;
    if (node.count == 0) {
      inside.extend(bvh.nodes[node.first].bounds);
      inside.extend(bvh.nodes[node.first + 1].bounds);
    }
    for (uint32_t k = node.first; k < node.first + node.count; ++k) inside.extend(input[bvh.references[k]]);
    ASSERT_EQ(node.bounds.lo, inside.lo);
    ASSERT_EQ(node.bounds.hi, inside.hi);
  }
}

TEST_P(BvhTest, DepthAndLeavesKeepTheirBounds) {
  const BvhStats stats = measure_bvh(builder(), build_bvh(builder(), {boxes()}));
  EXPECT_EQ(stats.builder, builder());
  EXPECT_EQ(stats.nodes, 2 * stats.leaves - 1);
  EXPECT_LE(stats.depth, kMaxBvhDepth);
  EXPECT_LE(stats.max_leaf_size, kMaxLeafSize);
  EXPECT_TRUE(std::isfinite(stats.sah_cost));
}

TEST_P(BvhTest, IsTheSameForAnyNumberOfThreads) {
  const Boxes input = boxes();
  const Bvh expected = build_bvh(builder(), {input}, {.thread_count = 1});
  for (const unsigned thread_count : {2U, 3U, 8U}) {
    const Bvh bvh = build_bvh(builder(), {input}, {.thread_count = thread_count});
    EXPECT_EQ(bvh.references, expected.references);
    ASSERT_EQ(bvh.nodes.size(), expected.nodes.size());
    EXPECT_EQ(std::memcmp(bvh.nodes.data(), expected.nodes.data(), bvh.nodes.size() * sizeof(BvhNode)), 0);
  }
}

// A builder may cut the boxes until no plane can cut the remaining parts.
TEST_P(BvhTest, PartsOfBoxesCoverThem) {
  const Boxes input = boxes();
  const Bvh bvh = build_bvh(builder(), {input, [](uint32_t, const Bounds& window) { return window; }});
  test::expect_tree(bvh);
  EXPECT_LE(bvh.references.size(), input.size() * kMaxReferencesPerPrimitive);
  // The test takes points of each box, among them its corners. Each must still be in the box of a leaf that refers to
  // the box.
  std::mt19937 random(4);
  std::vector<std::vector<vec3>> points(input.size());
  for (size_t i = 0; i < input.size(); ++i) {
    points[i] = {input[i].lo, input[i].hi};
    for (int k = 0; k < 8; ++k) {
      const vec3 weights = random_point(random, 0.0F, 1.0F);
      points[i].push_back(glm::clamp(input[i].lo * (1.0F - weights) + input[i].hi * weights, input[i].lo, input[i].hi));
    }
  }
  for (const BvhNode& node : bvh.nodes) {
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      std::erase_if(points[bvh.references[k]], [&](const vec3& p) { return test::contains(node.bounds, {p, p}); });
    }
  }
  EXPECT_EQ(std::count_if(points.begin(), points.end(), [](const auto& left) { return !left.empty(); }), 0);
}

struct HostRay {
  dvec3 origin;
  dvec3 direction;
};

/// The slab test. If a ray hits a box, it also hits every box around it.
bool is_met(const Bounds& box, const HostRay& ray) {
  const dvec3 below = (dvec3(box.lo) - ray.origin) / ray.direction;
  const dvec3 above = (dvec3(box.hi) - ray.origin) / ray.direction;
  const dvec3 in = glm::min(below, above);
  const dvec3 out = glm::max(below, above);
  return std::max({in.x, in.y, in.z, 0.0}) <= std::min({out.x, out.y, out.z});
}

std::vector<uint32_t> find_met_boxes(const Bvh& bvh, const Boxes& boxes, const HostRay& ray) {
  std::vector<uint32_t> met;
  std::vector<uint32_t> open = {0};
  while (!open.empty()) {
    const BvhNode& node = bvh.nodes[open.back()];
    open.pop_back();
    if (!is_met(node.bounds, ray)) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
    }
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      if (is_met(boxes[bvh.references[k]], ray)) met.push_back(bvh.references[k]);
    }
  }
  std::sort(met.begin(), met.end());
  return met;
}

TEST_P(BvhTest, RaysMeetTheSameBoxesAsByBruteForce) {
  const Boxes input = boxes();
  const Bvh bvh = build_bvh(builder(), {input});
  const dvec3 size = dvec3(bvh.nodes[0].bounds.hi) - dvec3(bvh.nodes[0].bounds.lo);
  std::mt19937 random(3);
  size_t met_count = 0;
  for (int i = 0; i < 20; ++i) {
    const Bounds& target = input[random() % input.size()];
    const dvec3 origin = size * dvec3(random_point(random, -1.0F, 1.0F)) + dvec3(random_point(random, -1e-30F, 1e-30F));
    const HostRay ray = {origin, dvec3(target.center()) - origin};
    std::vector<uint32_t> expected;
    for (uint32_t k = 0; k < input.size(); ++k) {
      if (is_met(input[k], ray)) expected.push_back(k);
    }
    EXPECT_EQ(find_met_boxes(bvh, input, ray), expected);
    met_count += expected.size();
  }
  const bool is_flat = bvh.nodes[0].bounds.half_area() == 0.0;
  EXPECT_TRUE(met_count > 0 || is_flat);
}

std::string name_of(const testing::TestParamInfo<BvhTest::ParamType>& info) {
  return std::string(std::get<0>(info.param)) + "_" + std::get<1>(info.param).name;
}

INSTANTIATE_TEST_SUITE_P(Builders, BvhTest,
                         testing::Combine(testing::ValuesIn(builder_names().begin(), builder_names().end()),
                                          testing::ValuesIn(kBoxSets)),
                         name_of);

TEST(BvhBuilders, TellTheirProgress) {
  const Boxes boxes = make_random(100'000, 1.0F);
  for (const std::string_view builder : builder_names()) {
    for (const unsigned thread_count : {1U, 3U}) {
      std::vector<double> told = {0.0};
      build_bvh(builder, {boxes}, {thread_count, [&](double fraction) {
                                     told.push_back(fraction);
                                     return true;
                                   }});
      EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
      EXPECT_GT(told.size(), 5U) << builder;
      EXPECT_GT(told.back(), 0.7) << builder;
      EXPECT_LE(told.back(), 1.0) << builder;
    }
  }
}

TEST(BvhBuilders, NoBoxesMakeNoNodes) {
  for (const std::string_view builder : builder_names()) {
    const Bvh bvh = build_bvh(builder, {});
    EXPECT_TRUE(bvh.nodes.empty());
    EXPECT_TRUE(bvh.references.empty());
    EXPECT_EQ(measure_bvh(builder, bvh).depth, 0U);
  }
}

TEST(BvhBuilders, MedianStopsAtTwoObjectsAndHalvesTheRest) {
  const BvhStats stats = measure_bvh("median", build_bvh("median", {make_random(1024, 1.0F)}));
  EXPECT_EQ(stats.max_leaf_size, 2U);
  EXPECT_EQ(stats.leaves, 512U);
  EXPECT_EQ(stats.depth, 10U);
}

TEST(BvhBuilders, MedianSplitsTheLongestAxisAtHalfTheNumber) {
  Boxes boxes;
  for (const float x : {3.0F, 0.0F, 4.0F, 1.0F, 2.0F}) boxes.push_back(box_around({x, -x * 0.5F, 0.0F}, vec3(0.1F)));
  const Bvh bvh = build_bvh("median", {boxes});
  EXPECT_THAT(bvh.references, testing::ElementsAre(1, 3, 4, 0, 2));
  EXPECT_EQ(bvh.nodes[bvh.nodes[0].first].count, 2U);
}

TEST(BvhBuilders, SahCostsNoMoreThanMedian) {
  for (const Boxes& boxes : {make_clusters(), make_random(20'000, 1.0F), make_flat_grid()}) {
    const double sah = measure_bvh("sah", build_bvh("sah", {boxes})).sah_cost;
    const double median = measure_bvh("median", build_bvh("median", {boxes})).sah_cost;
    EXPECT_LE(sah, median);
  }
}

TEST(BvhBuilders, SahSplitsClustersApart) {
  Boxes boxes;
  for (int i = 0; i < 40; ++i) boxes.push_back(box_around({i < 8 ? 0.0F : 100.0F, i, 0.0F}, vec3(0.5F)));
  const Bvh bvh = build_bvh("sah", {boxes});
  const Bounds& left = bvh.nodes[bvh.nodes[0].first].bounds;
  EXPECT_EQ(left.hi.x, 0.5F);
}

TEST(BvhStats, CostIsTheExpectedWorkOfARay) {
  // The root has the two halves of a 2 x 1 x 1 box: its half area is 5, theirs is 3. One leaf has three references, the
  // other one.
  Bvh bvh;
  bvh.nodes = {
      {{vec3(0.0F), vec3(2, 1, 1)}, 1, 0}, {{vec3(0.0F), vec3(1.0F)}, 0, 3}, {{vec3(1, 0, 0), vec3(2, 1, 1)}, 3, 1}};
  const BvhStats stats = measure_bvh("any", bvh);
  EXPECT_DOUBLE_EQ(stats.sah_cost, kNodeCost + kTestCost * (3 * 3.0 + 1 * 3.0) / 5.0);
  EXPECT_EQ(stats.nodes, 3U);
  EXPECT_EQ(stats.leaves, 2U);
  EXPECT_EQ(stats.depth, 2U);
  EXPECT_EQ(stats.max_leaf_size, 3U);
}

TEST(BvhBuilders, AnUnknownNameIsAUsageErrorThatListsTheKnownOnes) {
  const auto message_for = [](std::string_view name) -> std::string {
    try {
      build_bvh(name, {});
    } catch (const UsageError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message_for("SHA"), "there is no BVH builder \"SHA\"; did you mean \"sah\"? Known: sah, median, spatial");
  EXPECT_EQ(message_for("medien"),
            "there is no BVH builder \"medien\"; did you mean \"median\"? Known: sah, median, spatial");
}

}  // namespace
}  // namespace promin
