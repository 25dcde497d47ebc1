// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check counts and lists of all crossings of a ray.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <tuple>

#include "bvh/bvh_file.h"
#include "device/device.h"
#include "device_scene/pack_scene.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "hard/random_shapes.h"
#include "measure/meshes.h"
#include "measure/ray_sets.h"
#include "oracle/distance.h"
#include "oracle/verdict.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "promin/setup_stats.h"
#include "support/temp_folder.h"
#include "support/thorough.h"
#include "trace/kernels/ray_kernel.h"
#include "trace/render/caster_access.h"

namespace promin {
namespace {

using measure::Random;
using measure::ray_towards;
using measure::scene_of;

constexpr float kNoEnd = std::numeric_limits<float>::infinity();

struct Lists {
  std::vector<uint64_t> offsets{0};
  std::vector<Hit> hits;

  std::span<const Hit> of_ray(size_t i) const {
    return std::span(hits).subspan(offsets[i], offsets[i + 1] - offsets[i]);
  }
  bool has_same_bits(const Lists& other) const {
    return offsets == other.offsets && hits.size() == other.hits.size() &&
           std::memcmp(hits.data(), other.hits.data(), std::span(hits).size_bytes()) == 0;
  }
};

Lists list_with(Caster& caster, std::span<const Ray> rays, uint64_t budget = Caster::kListBytes) {
  Lists lists;
  caster.list(
      rays,
      [&](const HitList& part) {
        EXPECT_EQ(part.first_ray + 1, lists.offsets.size()) << "rays that do not follow the last ones";
        EXPECT_EQ(part.offsets.front(), 0U);
        EXPECT_EQ(part.offsets.back(), part.hits.size());
        const uint64_t before = lists.hits.size();
        for (const uint64_t offset : part.offsets.subspan(1)) lists.offsets.push_back(before + offset);
        lists.hits.insert(lists.hits.end(), part.hits.begin(), part.hits.end());
      },
      budget);
  EXPECT_EQ(lists.offsets.size(), rays.size() + 1);
  return lists;
}

std::vector<int32_t> count_with(Caster& caster, std::span<const Ray> rays) {
  std::vector<int32_t> counts(rays.size(), -1);
  caster.count(rays, counts);
  return counts;
}

class CrossingsTest : public test::DeviceTest {
 protected:
  static std::vector<int32_t> count(const world::Scene& scene, std::span<const Ray> rays,
                                    const std::string& builder = "sah") {
    Caster caster = make_caster(device(), scene, CasterOptions{.builder = builder});
    return count_with(caster, rays);
  }
  static Lists list(const world::Scene& scene, std::span<const Ray> rays) {
    Caster caster = make_caster(device(), scene);
    return list_with(caster, rays);
  }
};

world::Scene make_scene_with_open_shapes() {
  world::Scene scene = test::make_scene_of_everything();
  for (world::Shape shape :
       {world::Shape(world::Cylinder{vec3(1.0F, 1.0F, 1.0F), vec3(0, 0.6F, 0.8F), 0.7F, 0.5F, true}),
        world::Shape(world::Cone{vec3(-1.0F, 1.0F, 1.0F), vec3(0.6F, 0, 0.8F), 0.7F, 0.5F, 0.2F, true})}) {
    scene.objects.push_back({"", shape, 0});
  }
  return scene;
}

// These rays are random, and none passes within a few u S of an edge. Therefore the lists are equal, crossing by
// crossing.
TEST_F(CrossingsTest, ListsAreTheOracles) {
  const world::Scene scene = make_scene_with_open_shapes();
  const std::vector<Ray> rays = test::make_rays(test::is_thorough() ? 10000 : 3000);
  Caster caster = make_caster(device(), scene);
  const Lists lists = list_with(caster, rays);
  const std::vector<int32_t> counts = count_with(caster, rays);
  std::vector<Hit> nearest(rays.size());
  caster.cast(rays, nearest);
  for (size_t i = 0; i < rays.size(); ++i) {
    const oracle::Ray ray{oracle::Vector(rays[i].origin), oracle::Vector(rays[i].direction)};
    std::vector<oracle::Hit> expected = oracle::find_all_hits(scene, ray);
    ASSERT_EQ(lists.of_ray(i).size(), expected.size()) << "ray " << i;
    const Hit first = expected.empty() ? Hit{} : lists.of_ray(i)[0];
    // The first crossing of the list equals the hit of cast(), bit for bit.
    ASSERT_EQ(std::memcmp(&first, &nearest[i], sizeof(Hit)), 0) << "ray " << i;
    const auto in_order = [](const auto& a, const auto& b) {
      return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
    };
    ASSERT_TRUE(std::ranges::is_sorted(lists.of_ray(i), in_order)) << "ray " << i;
    // If surfaces intersect, rounding may exchange their crossings; these lists are compared primitive by primitive.
    const auto by_primitive = [](const auto& a, const auto& b) {
      return std::tie(a.object, a.primitive, a.t) < std::tie(b.object, b.primitive, b.t);
    };
    std::vector<Hit> hits(lists.of_ray(i).begin(), lists.of_ray(i).end());
    std::ranges::sort(hits, by_primitive);
    std::ranges::sort(expected, by_primitive);
    ASSERT_EQ(counts[i], static_cast<int32_t>(expected.size())) << "ray " << i;
    for (size_t k = 0; k < hits.size(); ++k) {
      ASSERT_EQ(std::tie(hits[k].object, hits[k].primitive), std::tie(expected[k].object, expected[k].primitive))
          << "ray " << i << ", hit " << k;
      const world::Shape& shape = scene.objects[static_cast<size_t>(hits[k].object)].shape;
      const oracle::Real error = std::abs(hits[k].t - expected[k].t) *
                                 std::abs(glm::dot(ray.direction, expected[k].normal)) /
                                 oracle::scale_of(shape, hits[k].primitive, ray);
      ASSERT_LE(error, oracle::kB1) << "ray " << i << ", hit " << k;
      ASSERT_LE(glm::distance(oracle::Vector(hits[k].normal), expected[k].normal), 1e-4L) << "ray " << i;
      ASSERT_NEAR(hits[k].u, expected[k].u, 1e-4L) << "ray " << i;
      ASSERT_NEAR(hits[k].v, expected[k].v, 1e-4L) << "ray " << i;
    }
  }
  EXPECT_GT(2 * lists.hits.size(), 3 * rays.size());
}

/// Returns the triangles of a square of n x n cells at z = 0; all corners are at integers, and diagonals go both ways.
Mesh make_crossed_grid(uint32_t n) {
  Mesh mesh;
  for (uint32_t y = 0; y <= n; ++y) {
    for (uint32_t x = 0; x <= n; ++x) mesh.positions.emplace_back(x, y, 0.0F);
  }
  for (uint32_t y = 0; y < n; ++y) {
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t corner = y * (n + 1) + x;
      const uvec4 cell(corner, corner + 1, corner + n + 2, corner + n + 1);
      const uvec4 c = (x + y) % 2 == 0 ? cell : uvec4(cell.y, cell.z, cell.w, cell.x);
      mesh.triangles.push_back({c.x, c.y, c.z});
      mesh.triangles.push_back({c.x, c.z, c.w});
    }
  }
  return mesh;
}

// Numbers are exact here. If a ray crosses a corner or an edge, the triangle that it crosses is the one that it would
// cross after a small move: to the right and much less downwards, in the plane across its longest axis. The rim is half
// open.
TEST_F(CrossingsTest, AtEdgesTheOneIsCrossedBesideWhichTheRayWouldPass) {
  constexpr uint32_t kCells = 8;
  for (const int turn : {0, 1, 2}) {
    Mesh mesh = make_crossed_grid(kCells);
    const auto turned = [turn](vec3 v) {
      return turn == 0 ? v : turn == 1 ? vec3(v.z, v.x, v.y) : vec3(v.y, v.z, v.x);
    };
    for (vec3& position : mesh.positions) position = turned(position);
    const world::Scene scene = scene_of({mesh});
    std::vector<Ray> rays;
    for (const vec3 lean : {vec3(0.0F), vec3(0.5F, 0.25F, 0.0F), vec3(-0.25F, 0.5F, 0.0F)}) {
      for (const float side : {-1.0F, 1.0F}) {
        for (uint32_t i = 0; i < (2 * kCells + 1) * (2 * kCells + 1); ++i) {
          const vec3 target = 0.5F * vec3(i % (2 * kCells + 1), i / (2 * kCells + 1), 0);
          const vec3 direction = vec3(0, 0, side) + lean;
          rays.push_back({turned(target - 8.0F * direction), 0.0F, turned(direction), kNoEnd});
        }
      }
    }
    const Lists lists = list(scene, rays);
    const oracle::Vector step(turned(vec3(1, 0, 0)));
    const oracle::Vector smaller_step(turned(vec3(0, -1, 0)));
    size_t crossings = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const oracle::Ray moved{oracle::Vector(rays[i].origin) + 1e-6L * step + 1e-12L * smaller_step,
                              oracle::Vector(rays[i].direction)};
      const std::vector<oracle::Hit> expected = oracle::find_all_hits(scene, moved);
      ASSERT_LE(expected.size(), 1U);
      ASSERT_EQ(lists.of_ray(i).size(), expected.size()) << "turn " << turn << ", ray " << i;
      if (expected.empty()) continue;
      ASSERT_EQ(lists.of_ray(i)[0].primitive, expected[0].primitive) << "turn " << turn << ", ray " << i;
      ++crossings;
    }
    EXPECT_EQ(crossings, rays.size() * 256 / 289) << "two of the four sides are open";
  }
}

/// Returns the surface of the cube from -1 to 1; each face has n x n cells.
Mesh make_box_mesh(uint32_t n) {
  Mesh mesh;
  for (uint32_t face = 0; face < 6; ++face) {
    const Mesh grid = make_crossed_grid(n);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const float side = face % 2 == 0 ? 1.0F : -1.0F;
    for (const vec3& p : grid.positions) {
      // Two faces compute equal coordinates at their common edge.
      const float a = 2.0F * p.x / static_cast<float>(n) - 1.0F;
      const float b = 2.0F * p.y / static_cast<float>(n) - 1.0F;
      const vec3 local = side > 0.0F ? vec3(a, b, 1) : vec3(b, a, -1);
      mesh.positions.push_back(face / 2 == 0   ? local
                               : face / 2 == 1 ? vec3(local.z, local.x, local.y)
                                               : vec3(local.y, local.z, local.x));
    }
    for (const uvec3& t : grid.triangles) mesh.triangles.push_back(t + first);
  }
  return mesh;
}

Mesh make_icosphere(int subdivisions) {
  const double phi = (1.0 + std::sqrt(5.0)) / 2.0;
  std::vector<dvec3> points = {{-1, phi, 0},  {1, phi, 0},  {-1, -phi, 0}, {1, -phi, 0}, {0, -1, phi},  {0, 1, phi},
                               {0, -1, -phi}, {0, 1, -phi}, {phi, 0, -1},  {phi, 0, 1},  {-phi, 0, -1}, {-phi, 0, 1}};
  std::vector<uvec3> triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < subdivisions; ++i) {
    std::map<std::array<uint32_t, 2>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<uint32_t>(points.size()));
      if (is_new) points.push_back(points[a] + points[b]);
      if (is_new) points.back() = points.back() * (glm::length(points[a]) / glm::length(points.back()));
      return at->second;
    };
    std::vector<uvec3> finer;
    for (const uvec3& t : triangles) {
      const uvec3 m(middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x));
      finer.insert(finer.end(), {{t.x, m.x, m.z}, {t.y, m.y, m.x}, {t.z, m.z, m.y}, m});
    }
    triangles = finer;
  }
  Mesh mesh;
  for (const dvec3& point : points) mesh.positions.emplace_back(glm::normalize(point));
  mesh.triangles = triangles;
  return mesh;
}

/// Returns two flat cones of many slivers, base to base, around the z axis.
Mesh make_bipyramid(uint32_t sides, double height) {
  Mesh mesh;
  mesh.positions = {vec3(0, 0, height), vec3(0, 0, -height)};
  for (uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / sides;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  for (uint32_t i = 0; i < sides; ++i) {
    const uint32_t a = 2 + i;
    const uint32_t b = 2 + (i + 1) % sides;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({1, b, a});
  }
  return mesh;
}

/// Returns the coarse box with an additional corner in the middle of an edge. Only the triangles of one face use this
/// corner. A triangle without area connects it to the edge.
Mesh make_stitched_box() {
  Mesh mesh = make_box_mesh(1);
  // The first triangle is cut in two: its side from the first corner to the second is halved.
  const uvec3 whole = mesh.triangles[0];
  const auto middle = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back(0.5F * (mesh.positions[whole.x] + mesh.positions[whole.y]));
  mesh.triangles[0] = {whole.x, middle, whole.z};
  mesh.triangles.push_back({middle, whole.y, whole.z});
  mesh.triangles.push_back({whole.x, whole.y, middle});
  return mesh;
}

Mesh moved(Mesh mesh, const vec3& offset) {
  for (vec3& position : mesh.positions) position += offset;
  return mesh;
}

/// Returns rays at corners, at the middles of sides and of faces, and along sides. If `is_inside` is true, they start
/// within 0.3 of the centre, else at 2.5 to 5 from it.
std::vector<Ray> make_aimed_rays(const Mesh& mesh, const vec3& center, bool is_inside, size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const auto triangle = static_cast<size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()));
    std::array<dvec3, 3> corners;
    for (int i = 0; i < 3; ++i) corners[static_cast<size_t>(i)] = mesh.positions[mesh.triangles[triangle][i]];
    const dvec3 targets[] = {corners[0], 0.5 * (corners[1] + corners[2]), (corners[0] + corners[1] + corners[2]) / 3.0};
    const dvec3 target = targets[rays.size() % 3];
    const double distance = is_inside ? 0.3 * random.uniform() : random.uniform(2.5, 5.0);
    const vec3 origin = center + vec3(distance * random.direction());
    const vec3 at(target);
    const size_t kind = rays.size() / 3 % 8;
    if (!is_inside && kind == 0) {
      // This ray lies in the planes of faces and along sides.
      const dvec3 way = glm::normalize(corners[1] - corners[0]);
      rays.push_back({vec3(target - 6.0 * way), 0.0F, vec3(way), kNoEnd});
    } else if (!is_inside && kind == 1) {
      // This ray is parallel to a coordinate axis. Its other coordinates are those of vertices.
      const int axis = static_cast<int>(rays.size() % 9 / 3);
      vec3 from = at;
      from[axis] -= 6.0F;
      vec3 direction(0.0F);
      direction[axis] = 1.0F;
      rays.push_back({from, 0.0F, direction, kNoEnd});
    } else {
      // The direction is computed from the rounded origin, so that it is as exact as possible.
      rays.push_back({origin, 0.0F, vec3(target - dvec3(origin)), kNoEnd});
    }
  }
  return rays;
}

/// Returns the total number of rays. It is large for a test with the label `long`.
size_t aimed_ray_count() {
  const char* word = std::getenv("PROMIN_TEST_AIMED_RAYS");
  return word == nullptr ? 150'000 : static_cast<size_t>(std::strtoull(word, nullptr, 10));
}

size_t count_wrong(std::span<const int32_t> counts, bool is_inside) {
  return static_cast<size_t>(std::count_if(
      counts.begin(), counts.end(), [&](int32_t count) { return count < 0 || count % 2 != (is_inside ? 1 : 0); }));
}

TEST_F(CrossingsTest, ParityTellsInsideFromOutside) {
  const std::vector<std::pair<const char*, Mesh>> meshes = {{"box", make_box_mesh(1)},
                                                            {"gridded box", make_box_mesh(7)},
                                                            {"stitched box", make_stitched_box()},
                                                            {"icosphere", make_icosphere(3)}};
  const vec3 centers[] = {vec3(0.0F), vec3(1000.0F, -800.0F, 1200.0F), vec3(0.3F, 1e5F, -7e4F)};
  const size_t share = aimed_ray_count() / (2 * std::size(meshes) * std::size(centers));
  size_t builder = 0;
  for (const auto& [name, mesh] : meshes) {
    for (const vec3& center : centers) {
      const Mesh placed = moved(mesh, center);
      const std::string chosen(builder_names()[builder++ % builder_names().size()]);
      Caster caster = make_caster(device(), scene_of({placed}), CasterOptions{.builder = chosen});
      for (const bool is_inside : {false, true}) {
        const std::vector<Ray> rays = make_aimed_rays(placed, center, is_inside, share, builder);
        const std::vector<int32_t> counts = count_with(caster, rays);
        EXPECT_EQ(count_wrong(counts, is_inside), 0U)
            << name << " at " << center.x << ", " << (is_inside ? "inside, " : "outside, ") << chosen;
        EXPECT_GT(std::count_if(counts.begin(), counts.end(), [](int32_t n) { return n > 0; }),
                  static_cast<ptrdiff_t>(rays.size() / 4));
      }
    }
  }
}

// Many slivers share a corner. Rounding reverses the orientation of some of them if the ray sees them edge-on. Areas
// without rounding distinguish the sides of the corner.
TEST_F(CrossingsTest, ParityHoldsAmongSliversSeenEdgeOn) {
  for (const double height : {0.3, 1e-3, 1e-6, 1e-8}) {
    const Mesh mesh = make_bipyramid(3000, height);
    std::vector<Ray> rays;
    Random random(7);
    for (size_t i = 0; i < aimed_ray_count() / 60; ++i) {
      const double tilt = std::pow(10.0, random.uniform(-9.0, 0.0));
      dvec3 way = random.perpendicular(dvec3(0, 0, 1));
      way.z = tilt;
      const dvec3 target =
          i % 4 == 3 ? 0.5 * random.perpendicular(dvec3(0, 0, 1)) : dvec3(0, 0, i % 2 == 0 ? height : -height);
      const vec3 origin(target - 5.0 * glm::normalize(way));
      rays.push_back({origin, 0.0F, vec3(target - dvec3(origin)), kNoEnd});
    }
    EXPECT_EQ(count_wrong(count(scene_of({mesh}), rays), false), 0U) << height;
  }
}

// Slivers lie on a line through the ray; their rounded areas are 0 or have the sign of their neighbours'. They form
// closed surfaces one below the other, each between an apex near the ray, a ring around it and a point below.
TEST_F(CrossingsTest, ParityHoldsWhereAreasDrownInRounding) {
  constexpr uint32_t kSurfaces = 4000;
  constexpr float kGap = 16.0F;
  Random random(17);
  Mesh mesh;
  std::vector<Ray> rays;
  for (uint32_t surface = 0; surface < kSurfaces; ++surface) {
    const float z = -kGap * static_cast<float>(surface);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    const vec2 apex(random.uniform(0.1, 0.9), random.uniform(-0.9, 0.9));
    mesh.positions.emplace_back(apex, z + 1.0F);
    mesh.positions.emplace_back(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), z - 1.0F);
    for (int i = 0; i < 6; ++i) {
      // The corner lies on the line through apex and ray, on either side, up to some steps between floats.
      const auto scale = static_cast<float>((random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(1.1, 1.9));
      const auto jitter = [&] { return static_cast<float>(1.0 + 0x1p-23 * std::floor(random.uniform(-2.0, 3.0))); };
      mesh.positions.emplace_back(scale * apex.x * jitter(), scale * apex.y * jitter(), z);
    }
    mesh.positions.insert(mesh.positions.end(), {vec3(-3, 0.1F, z), vec3(0.2F, -3, z), vec3(3, 2.5F, z)});
    constexpr uint32_t kRing = 9;
    for (uint32_t i = 0; i < kRing; ++i) {
      const uint32_t a = first + 2 + i;
      const uint32_t b = first + 2 + (i + 1) % kRing;
      mesh.triangles.push_back({first, a, b});
      mesh.triangles.push_back({first + 1, b, a});
    }
    rays.push_back({vec3(0, 0, z + 4), 0.0F, vec3(0, 0, -1), 8.0F});
  }
  const std::vector<int32_t> counts = count(scene_of({mesh}), rays);
  EXPECT_EQ(count_wrong(counts, false), 0U);
  EXPECT_GT(std::accumulate(counts.begin(), counts.end(), 0), static_cast<int32_t>(kSurfaces));
}

// The origin is so far away that all corners of a triangle coincide after rounding, although the triangle has an area.
TEST_F(CrossingsTest, WhatIsSeenAsAPointIsNotCrossedTwice) {
  Mesh mesh = make_icosphere(2);
  for (vec3& position : mesh.positions) position *= 0.02F;
  // The other shape makes the scene so large that the shader does not move the origins of rays nearer.
  const world::Scene scene = scene_of({mesh, world::Sphere{vec3(0, 0, -1e5F), 1.0F}});
  Random random(31);
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i) {
    const vec3 origin(1e6 * random.direction());
    rays.push_back({origin, 0.0F, -origin + vec3(0.02 * random.direction()), kNoEnd});
  }
  EXPECT_EQ(count_wrong(count(scene, rays), false), 0U);
}

// Along a ray through a closed mesh, the entries minus the exits must be 0.
TEST_F(CrossingsTest, RaysEnterAsOftenAsTheyLeave) {
  const Mesh mesh = make_icosphere(3);
  for (const bool is_inside : {false, true}) {
    const std::vector<Ray> rays = make_aimed_rays(mesh, vec3(0.0F), is_inside, 20000, 3);
    const Lists lists = list(scene_of({mesh}), rays);
    size_t wrong = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      int sum = 0;
      bool is_clear = true;
      for (const Hit& hit : lists.of_ray(i)) {
        const double cosine = glm::dot(dvec3(hit.normal), glm::normalize(dvec3(rays[i].direction)));
        is_clear = is_clear && std::abs(cosine) > 1e-5;
        sum += cosine < 0.0 ? 1 : -1;
      }
      wrong += is_clear && sum != (is_inside ? -1 : 0);
    }
    EXPECT_EQ(wrong, 0U);
  }
}

/// Points on creases, as exact as fp64 allows, and unit vectors. A ray through a point in the direction of its vector
/// touches the shape.
struct Aim {
  dvec3 target{0.0};
  dvec3 graze{0.0};
};

Aim aim_at_rim(const dvec3& center, const dvec3& given_axis, double height, double radius, Random& random) {
  const dvec3 axis = glm::normalize(given_axis);
  const dvec3 radial = random.perpendicular(axis);
  return {center + height * axis + radius * radial, random.uniform() < 0.5 ? glm::cross(axis, radial) : axis};
}
Aim aim_at(const world::Sphere& s, Random& random) {
  return aim_at_rim(s.center, random.direction(), 0.0, s.radius, random);
}
Aim aim_at(const world::Cylinder& c, Random& random) {
  return aim_at_rim(c.center, c.axis, random.uniform() < 0.5 ? c.half_height : -c.half_height, c.radius, random);
}
Aim aim_at(const world::Cone& c, Random& random) {
  const bool is_top = random.uniform() < 0.5;
  Aim aim = aim_at_rim(c.center, c.axis, is_top ? c.half_height : -c.half_height,
                       is_top ? c.radius_top : c.radius_bottom, random);
  // Some rays also go along a generator.
  if (random.uniform() < 0.5) {
    const dvec3 axis = glm::normalize(dvec3(c.axis));
    const dvec3 radial = random.perpendicular(axis);
    aim.target = dvec3(c.center) + dvec3(c.half_height * c.axis) + double{c.radius_top} * radial;
    aim.graze = glm::normalize(2.0 * c.half_height * axis + double{c.radius_top - c.radius_bottom} * radial);
  }
  return aim;
}
Aim aim_at(const world::Capsule& c, Random& random) {
  const double s =
      std::clamp((double{c.radius_bottom} - c.radius_top) / std::max(2.0 * c.half_height, 1e-30), -1.0, 1.0);
  // If one sphere contains the other, the point is on the large one's silhouette.
  const bool is_top = std::abs(s) < 1.0 ? random.uniform() < 0.5 : s < 0.0;
  const double radius = is_top ? c.radius_top : c.radius_bottom;
  const double along = std::abs(s) < 1.0 ? s : 0.0;
  return aim_at_rim(c.center, c.axis, (is_top ? 1.0 : -1.0) * double{c.half_height} + along * radius,
                    std::sqrt(1.0 - along * along) * radius, random);
}
Aim aim_at(const world::Box& box, Random& random) {
  dvec3 local(box.half_size);
  for (int i = 0; i < 3; ++i) local[i] *= random.uniform() < 0.5 ? -1.0 : 1.0;
  const int along = static_cast<int>(random.uniform(0.0, 3.0));
  // Corners are aimed at, too.
  if (random.uniform() < 0.7) local[along] *= random.uniform();
  dvec3 target(box.center);
  for (int i = 0; i < 3; ++i) target += local[i] * dvec3(oracle::axis_of(box, i));
  return {target, dvec3(oracle::axis_of(box, along))};
}

template <class Shape>
void expect_two_ends(const gpu::Device& device, const char* name) {
  Random random(29);
  const vec3 centers[] = {vec3(0.0F), vec3(0.3F, -0.7F, 0.4F), vec3(1000.0F, -800.0F, 1200.0F)};
  constexpr int kShapes = 12;
  const size_t share = aimed_ray_count() / (5 * kShapes * 2);
  for (int i = 0; i < kShapes; ++i) {
    const Shape shape = hard::random_shape<Shape>(centers[i % 3], random);
    const oracle::BoundingSphere bound = oracle::bounding_sphere(shape, 0);
    const double size = static_cast<double>(bound.radius);
    std::vector<Ray> outside;
    std::vector<Ray> inside;
    for (size_t k = 0; k < share; ++k) {
      const Aim aim = aim_at(shape, random);
      dvec3 way = random.direction();
      if (k % 3 == 0) way = aim.graze;
      if (k % 6 == 1) way = random.perpendicular(aim.graze);
      const dvec3 origin = aim.target - 3.0 * size * std::pow(10.0, random.uniform(0.0, 2.0)) * way;
      outside.push_back(ray_towards(origin, aim.target));
      inside.push_back(ray_towards(dvec3(shape.center), aim.target));
    }
    Caster caster = make_caster(device, scene_of({shape}));
    const Lists lists = list_with(caster, outside);
    size_t wrong = 0;
    size_t through = 0;
    for (size_t k = 0; k < outside.size(); ++k) {
      const std::span<const Hit> hits = lists.of_ray(k);
      wrong += !(hits.empty() || (hits.size() == 2 && hits[0].t <= hits[1].t));
      through += hits.size() == 2 ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U) << name << " " << i;
    EXPECT_GT(through, share / 10) << name << " " << i;
    EXPECT_LT(through, share) << name << " " << i;
    const std::vector<int32_t> counts = count_with(caster, inside);
    EXPECT_EQ(std::count_if(counts.begin(), counts.end(), [](int32_t n) { return n != 1; }), 0) << name << " " << i;
  }
}

TEST_F(CrossingsTest, ASolidIsEnteredAndLeftOnceOrNotAtAll) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) expect_two_ends<world::TYPE>(device(), NAME);
#include "promin/kinds/primitives.def"
}

// Shapes are exact here. A ray that touches one has a hit of cast() but no crossing. A ray crosses a plane once, and
// never if it is parallel to the plane.
TEST_F(CrossingsTest, WhatIsTouchedIsNotCrossed) {
  const auto expect = [&](const world::Shape& shape, const Ray& ray, int32_t expected, bool is_cast) {
    const world::Scene scene = scene_of({shape});
    const std::vector<Ray> rays = {ray};
    EXPECT_EQ(count(scene, rays)[0], expected) << shape.index();
    std::vector<Hit> hits(1);
    make_caster(device(), scene).cast(rays, hits);
    EXPECT_EQ(hits[0].object >= 0, is_cast) << shape.index();
  };
  const auto along_z = [](float x, float y) { return Ray{vec3(x, y, 8), 0.0F, vec3(0, 0, -1), kNoEnd}; };
  expect(world::Sphere{vec3(0.0F), 1.0F}, along_z(1, 0), 0, true);
  expect(world::Sphere{vec3(0.0F), 1.0F}, along_z(0.5F, 0), 2, true);
  expect(world::Cylinder{vec3(0.0F), vec3(0, 1, 0), 1.0F, 1.0F}, along_z(1, 0), 0, true);
  expect(world::Cylinder{vec3(0.0F), vec3(0, 1, 0), 1.0F, 1.0F}, along_z(0.5F, 0), 2, true);
  expect(world::Capsule{vec3(0.0F), vec3(0, 1, 0), 1.0F, 1.0F, 1.0F}, along_z(1, 0.5F), 0, true);
  expect(world::Plane{vec3(0.0F), vec3(0, 0, 1)}, along_z(1, 0), 1, true);
  expect(world::Plane{vec3(0.0F), vec3(0, 1, 0)}, along_z(1, 0), 0, false);
  // Rays through the side of a tube cross it once or twice; a ray along the axis never does.
  const world::Cylinder tube{vec3(0.0F), vec3(0, 1, 0), 1.0F, 1.0F, true};
  expect(tube, along_z(0, 0), 2, true);
  expect(tube, {vec3(0, 2, 0), 0.0F, vec3(0, -1, 0), kNoEnd}, 0, false);
  expect(tube, {vec3(0, 2, 0), 0.0F, vec3(0.5F, -1, 0), kNoEnd}, 1, true);
  expect(tube, {vec3(0, 0, 0), 0.0F, vec3(1, 0, 0), kNoEnd}, 1, true);
}

TEST_F(CrossingsTest, TheIntervalIsOpen) {
  const world::Scene scene = scene_of({make_crossed_grid(4), world::Box{vec3(2, 2, 4), vec3(0.5F)}});
  const auto ray = [](float tmin, float tmax) { return Ray{vec3(1.75F, 2.25F, 8), tmin, vec3(0, 0, -1), tmax}; };
  // The crossings are at t = 3.5, 4.5 and 8.
  const std::vector<Ray> rays = {ray(0, kNoEnd),
                                 ray(3.5F, 8),
                                 ray(3.4F, 4.5F),
                                 ray(-kNoEnd, 8.001F),
                                 ray(5, 4),
                                 ray(0, 0),
                                 ray(std::nextafter(4.5F, 0.0F), kNoEnd),
                                 ray(std::numeric_limits<float>::quiet_NaN(), 9)};
  EXPECT_THAT(count(scene, rays), testing::ElementsAre(3, 1, 1, 3, 0, 0, 2, 0));
  const Lists lists = list(scene, rays);
  EXPECT_THAT(lists.offsets, testing::ElementsAre(0, 3, 4, 5, 8, 8, 8, 10, 10));
  EXPECT_THAT(std::vector(lists.hits.begin(), lists.hits.begin() + 3),
              testing::ElementsAre(testing::Field(&Hit::t, 3.5F), testing::Field(&Hit::t, 4.5F),
                                   testing::Field(&Hit::t, 8.0F)));
  EXPECT_EQ(lists.hits[0].normal, vec3(0, 0, 1));
  EXPECT_EQ(lists.hits[1].normal, vec3(0, 0, -1));
}

// The ray's unit, its start beyond 1024 radii, and its t are at the limits of floats.
TEST_F(CrossingsTest, DirectionsHaveAnyLengthAndOriginsAnyDistance) {
  // The mesh's size is a thousandth of a world unit.
  Mesh mesh = make_icosphere(2);
  for (vec3& position : mesh.positions) position *= 1e-3F;
  const world::Scene scene = scene_of({mesh, world::Sphere{vec3(0.0F), 5e-4F}});
  const vec3 aside(1e-4F, 2e-4F, 0.0F);
  std::vector<Ray> rays;
  for (const float length : {1e-40F, 1e-37F, 1.2e-38F, 1e-10F, 1.0F, 1e10F, 1e36F, 1.7e38F, 3e38F}) {
    rays.push_back({aside + vec3(0, 0, 2.5e-3F), 0.0F, vec3(0, 0, -length), kNoEnd});
  }
  for (const float distance : {10.0F, 1000.0F}) {
    const vec3 origin = aside + vec3(0, 0, distance);
    rays.push_back({origin, 0.0F, vec3(0, 0, -2), kNoEnd});
    rays.push_back({origin, 0.6F * distance, vec3(0, 0, -2), kNoEnd});
    rays.push_back({origin, 0.0F, vec3(0, 0, -2), 0.4F * distance});
  }
  // t would be 10^39.
  rays.push_back({aside + vec3(0, 0, 10), 0.0F, vec3(0, 0, -1e-38F), kNoEnd});
  const std::vector<int32_t> counts = count(scene, rays);
  EXPECT_THAT(counts, testing::ElementsAre(4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 0, 0, 4, 0, 0, 0));
  const Lists lists = list(scene, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(lists.of_ray(i).size(), static_cast<size_t>(counts[i])) << i;
    ASSERT_TRUE(std::ranges::is_sorted(lists.of_ray(i), {}, &Hit::t)) << i;
  }
  // The test divides the ray at each hit. Parts begin or end at the hit. Units may be denormal.
  std::vector<Ray> parts;
  std::vector<int32_t> expected;
  for (const float length : {1.1e37F, 3.3e37F, 0.7e38F, 0.9e38F, 1.3e38F, 1.6e38F}) {
    rays.push_back({aside + vec3(0, 0, 2.5e-3F), 0.0F, vec3(0, 0, -length), kNoEnd});
  }
  const Lists more_lists = list(scene, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    for (const Hit& hit : more_lists.of_ray(i)) {
      const auto before = std::ranges::count_if(more_lists.of_ray(i), [&](const Hit& h) { return h.t < hit.t; });
      const auto after = std::ranges::count_if(more_lists.of_ray(i), [&](const Hit& h) { return h.t > hit.t; });
      parts.push_back(rays[i]);
      parts.back().tmin = std::max(rays[i].tmin, hit.t);
      expected.push_back(static_cast<int32_t>(after));
      parts.push_back(rays[i]);
      parts.back().tmax = std::min(rays[i].tmax, hit.t);
      expected.push_back(static_cast<int32_t>(before));
    }
  }
  EXPECT_EQ(parts.size(), 2 * 4 * 17U);
  // Rays whose directions the host scales are counted separately.
  std::vector<Ray> alone(1);
  for (size_t i = 0; i < parts.size(); ++i) {
    alone[0] = parts[i];
    EXPECT_EQ(count(scene, alone)[0], expected[i]) << "part " << i << ", length " << -parts[i].direction.z;
  }
}

// Crossings at the same t are in the order of object and primitive, whatever the tree, and all are listed.
TEST_F(CrossingsTest, CoincidentTrianglesAreAllListedInOrder) {
  Mesh mesh;
  mesh.positions = {vec3(-1, -1, 0), vec3(2, -1, 0), vec3(-1, 2, 0)};
  for (int i = 0; i < 300; ++i) mesh.triangles.push_back({0, 1, 2});
  const world::Scene scene = scene_of({mesh, mesh});
  const std::vector<Ray> rays = {{vec3(0, 0, 3), 0.0F, vec3(0.01F, 0.02F, -1), kNoEnd}};
  const Lists lists = list(scene, rays);
  ASSERT_EQ(lists.hits.size(), 600U);
  for (int i = 0; i < 600; ++i) {
    ASSERT_EQ(lists.hits[static_cast<size_t>(i)].object, i / 300);
    ASSERT_EQ(lists.hits[static_cast<size_t>(i)].primitive, i % 300);
  }
}

/// Returns triangles one behind the other, and a ray through all of them.
std::pair<world::Scene, Ray> make_stack(uint32_t count) {
  Mesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const auto z = static_cast<float>(i + 1);
    mesh.positions.insert(mesh.positions.end(), {vec3(-1, -1, z), vec3(1, -1, z), vec3(0, 1, z)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return {scene_of({mesh}), {vec3(0.1F, 0.1F, 0), 0.0F, vec3(0, 0, 1), kNoEnd}};
}

// There are more crossings than the budget allows. The hits of one ray stay together.
TEST_F(CrossingsTest, RaysMayHaveManyHits) {
  constexpr uint32_t kCount = 4000;
  const auto [scene, ray] = make_stack(kCount);
  const std::vector<Ray> rays(3, ray);
  Caster caster = make_caster(device(), scene);
  EXPECT_THAT(count_with(caster, rays), testing::Each(kCount));
  size_t parts = 0;
  caster.list(
      rays,
      [&](const HitList& part) {
        ++parts;
        ASSERT_EQ(part.hits.size(), kCount);
        for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(part.hits[i].primitive, static_cast<int32_t>(i));
      },
      1000);
  EXPECT_EQ(parts, 3U);
}

// llvmpipe ends the loops of a lane after 65535 iterations. The result at that point is incomplete.
TEST_F(CrossingsTest, TooManyHitsAreRefusedOrTraced) {
  constexpr uint32_t kCount = 100'000;
  const auto [scene, ray] = make_stack(kCount);
  const std::vector<Ray> rays = {ray};
  Caster caster = make_caster(device(), scene);
  try {
    EXPECT_EQ(count_with(caster, rays)[0], static_cast<int32_t>(kCount));
  } catch (const RunError& error) {
    EXPECT_TRUE(device().profile().may_cut_loops);
    EXPECT_THAT(list_problems(error), HasProblem("device.loops.cut"));
  }
  // Every device can make the list in parts.
  size_t total = 0;
  for (float begin = 0.5F; begin < 100'000.0F; begin += 1000.0F) {
    const std::vector<Ray> part = {{ray.origin, begin, ray.direction, begin + 1000.0F}};
    total += list_with(caster, part).hits.size();
  }
  EXPECT_EQ(total, kCount);
}

class SameCrossingsTest : public TempFolder {
 protected:
  static const gpu::Device& device() { return test::SharedDevice::open({.pixel_packet_size = 1}); }

  /// Returns rays towards a closed mesh, and rays towards all other objects.
  static std::vector<Ray> make_rays() {
    std::vector<Ray> rays = test::make_rays(3001);
    const std::vector<Ray> aimed = make_aimed_rays(make_icosphere(2), vec3(0.0F), false, 2000, 5);
    rays.insert(rays.end(), aimed.begin(), aimed.end());
    return rays;
  }
  static world::Scene make_scene() {
    world::Scene scene = make_scene_with_open_shapes();
    scene.objects.push_back({"", make_icosphere(2), 0});
    // The mesh has long thin triangles, so that a builder splits them.
    scene.objects.push_back({"", measure::make_needles(2000).objects[0].shape, 0});
    return scene;
  }
};

TEST_F(SameCrossingsTest, WhateverTheTreeAndItsFile) {
  const world::Scene scene = make_scene();
  const std::vector<Ray> rays = make_rays();
  std::optional<Lists> expected;
  const auto expect_same = [&](const std::string& name, const CasterOptions& options) {
    Caster caster = make_caster(device(), scene, options);
    const Lists lists = list_with(caster, rays);
    if (!expected) expected = lists;
    EXPECT_TRUE(lists.has_same_bits(*expected)) << name;
    const std::vector<int32_t> counts = count_with(caster, rays);
    size_t differences = 0;
    for (size_t i = 0; i < rays.size(); ++i) differences += counts[i] != static_cast<int32_t>(lists.of_ray(i).size());
    EXPECT_EQ(differences, 0U) << name;
  };
  for (const std::string_view builder : builder_names()) {
    expect_same(std::string(builder), {.builder = std::string(builder)});
    const std::filesystem::path file = folder_ / (std::string(builder) + ".pbvh");
    write_bvh_file(file, pack_scene(scene, builder).tree());
    expect_same("file of " + std::string(builder), {.bvh = file});
  }
  // One of the trees refers to some primitives more than once. Otherwise the test would find no duplicates to remove.
  const PackedScene split = pack_scene(scene, "spatial");
  EXPECT_GT(split.references.size(), split.bounded_count);
  EXPECT_GT(expected->hits.size(), 2 * rays.size());
}

TEST_F(SameCrossingsTest, WhateverTheBudgetTheOrderAndTheCompany) {
  const world::Scene scene = make_scene();
  const std::vector<Ray> rays = make_rays();
  Caster caster = make_caster(device(), scene);
  const Lists expected = list_with(caster, rays);
  for (const uint64_t budget : {uint64_t{3000}, uint64_t{1000000}}) {
    EXPECT_TRUE(list_with(caster, rays, budget).has_same_bits(expected)) << budget;
  }
  std::vector<size_t> order(rays.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::vector<Ray> shuffled;
  for (const size_t i : order) shuffled.push_back(rays[i]);
  const Lists lists = list_with(caster, shuffled);
  size_t differences = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const std::span<const Hit> a = lists.of_ray(i);
    const std::span<const Hit> b = expected.of_ray(order[i]);
    differences += a.size() != b.size() || std::memcmp(a.data(), b.data(), a.size_bytes()) != 0;
  }
  EXPECT_EQ(differences, 0U);
}

// Rays in rows are traced in packets. If a tree refers to a primitive twice, a packet visits it in a different order
// than single rays do, and some rays may be listed as single rays.
TEST_F(SameCrossingsTest, WhateverHangsTogetherInPackets) {
  const world::Scene scene = measure::make_needles(20000);
  const Bounds bounds = world::bounds_of(scene);
  const vec3 center = bounds.center();
  const float size = glm::length(bounds.hi - center);
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < 64 * 64; ++i) {
    const vec3 aside = 0.015F * size * vec3(static_cast<float>(i % 64) - 31.5F, 31.5F - static_cast<float>(i / 64), 0);
    rays.push_back({center + aside + vec3(0, 0, 2.0F * size), 0.0F, vec3(0.01F, 0.02F, -1), kNoEnd});
  }
  Caster whole = make_caster(device(), scene, CasterOptions{.builder = "sah"});
  Caster split = make_caster(device(), scene, CasterOptions{.builder = "spatial"});
  const Lists expected = list_with(whole, rays);
  EXPECT_GT(expected.hits.size(), rays.size() / 4);
  for (const uint64_t budget : {Caster::kListBytes, uint64_t{10000}, uint64_t{1}}) {
    EXPECT_TRUE(list_with(split, rays, budget).has_same_bits(expected)) << budget;
    EXPECT_TRUE(list_with(whole, rays, budget).has_same_bits(expected)) << budget;
  }
}

// The test varies packets, forms of traversal, and the two ways to read the same memory.
TEST_F(SameCrossingsTest, WhateverTheKernel) {
  const world::Scene scene = make_scene();
  const std::shared_ptr<const DeviceScene> device_scene = upload_scene(device(), pack_scene(scene, "sah"));
  std::vector<layout::RayRecord> rays;
  for (const Ray& ray : make_rays()) rays.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  std::vector<uint32_t> expected_counts;
  std::vector<layout::HitRecord> expected;
  const auto expect_same = [&](const std::string& name, RayKernelOptions options) {
    options.features = features_of(scene);
    options.query = HitQuery::kCount;
    std::vector<layout::HitRecord> heads(rays.size());
    RayKernel(device(), device_scene, options).run(rays, heads);
    std::vector<uint32_t> counts;
    for (const layout::HitRecord& head : heads) counts.push_back(head.a.x);
    if (expected_counts.empty()) expected_counts = counts;
    ASSERT_EQ(counts, expected_counts) << name;
    options.query = HitQuery::kAll;
    std::vector<layout::HitRecord> crossings(std::accumulate(counts.begin(), counts.end(), size_t{0}));
    RayKernel(device(), device_scene, options).list(rays, counts, crossings);
    for (size_t i = 0, first = 0; i < counts.size(); first += counts[i++]) {
      const auto begin = crossings.begin() + static_cast<ptrdiff_t>(first);
      std::sort(begin, begin + counts[i], [](const layout::HitRecord& a, const layout::HitRecord& b) {
        return std::tie(a.a.x, a.a.y, a.b.w) < std::tie(b.a.x, b.a.y, b.b.w);
      });
    }
    if (expected.empty()) expected = crossings;
    ASSERT_EQ(crossings.size(), expected.size());
    EXPECT_EQ(std::memcmp(crossings.data(), expected.data(), std::span(crossings).size_bytes()), 0) << name;
  };
  expect_same("plain", {});
  expect_same("packets of 4", {.packet_size = 4});
  expect_same("storage buffers", {.avoids_texels = true});
  expect_same("few rays a dispatch", {.packet_size = 2, .rays_per_dispatch = 321});
  for (const gpu::TraversalForm form : {gpu::TraversalForm{0, false}, gpu::TraversalForm{1, true}}) {
    expect_same("form " + std::to_string(form.steps_together), {.packet_size = 4, .traversal = form});
  }
}

TEST_F(CrossingsTest, WrongUseIsRefusedAndTheCasterStaysUsable) {
  const world::Scene scene = scene_of({world::Sphere{vec3(0.0F), 1.0F}});
  Caster caster = make_caster(device(), scene);
  const std::vector<Ray> rays(10, {vec3(0.1F, 0, 3), 0.0F, vec3(0, 0, -1), kNoEnd});
  std::vector<int32_t> counts(9);
  EXPECT_THROW(caster.count(rays, counts), UsageError);
  std::vector<Hit> hits(10);
  EXPECT_THROW(caster.cast(rays, hits, HitQuery::kCount), UsageError);
  EXPECT_THROW(caster.cast(rays, hits, HitQuery::kAll), UsageError);
  const auto refuse = [](const HitList&) { throw std::domain_error("the sink's own"); };
  EXPECT_THROW(caster.list(rays, refuse), std::domain_error);
  counts.resize(10);
  EXPECT_THROW(caster.count(rays, counts, [](double) { return false; }), Cancelled);
  EXPECT_THROW(caster.list(
                   rays, [](const HitList&) {}, Caster::kListBytes, [](double) { return false; }),
               Cancelled);
  EXPECT_THAT(count_with(caster, rays), testing::Each(2));
  EXPECT_TRUE(count_with(caster, {}).empty());
  EXPECT_TRUE(list_with(caster, {}).hits.empty());
}

}  // namespace
}  // namespace promin
