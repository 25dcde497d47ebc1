// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/caster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "device/device.h"
#include "device_scene/pack_scene.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "measure/meshes.h"
#include "oracle/verdict.h"
#include "promin/error.h"
#include "promin/renderer.h"
#include "rays/ray_tiles.h"
#include "support/problems.h"
#include "support/thorough.h"
#include "trace/kernels/ray_kernel.h"
#include "trace/kernels/tracing_kernel.h"
#include "trace/render/caster_access.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

using measure::scene_of;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class CasterTest : public test::DeviceTest {
 protected:
  static std::vector<Hit> cast(const world::Scene& scene, std::span<const Ray> rays,
                               HitQuery query = HitQuery::kNearest) {
    std::vector<Hit> hits(rays.size());
    make_caster(device(), scene).cast(rays, hits, query);
    return hits;
  }
};

bool have_same_bits(std::span<const Hit> a, std::span<const Hit> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST_F(CasterTest, AnswersAsTheOracle) {
  const world::Scene scene = test::make_scene_of_everything();
  const std::vector<Ray> rays = test::make_rays(test::is_thorough() ? 20000 : 5000);
  const std::vector<Hit> hits = cast(scene, rays);
  const std::vector<Hit> any = cast(scene, rays, HitQuery::kAny);
  size_t hit_count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const oracle::Ray ray{oracle::Vector(rays[i].origin), oracle::Vector(rays[i].direction)};
    const oracle::Verdict verdict = oracle::judge(scene, ray, {hits[i].t, hits[i].object, hits[i].primitive});
    ASSERT_LE(verdict.margin, oracle::kB2) << "ray " << i;
    ASSERT_LE(verdict.t_error, oracle::kB1) << "ray " << i;
    ASSERT_EQ(any[i].t, hits[i].object >= 0 ? 0.0F : kInfinity) << "ray " << i;
    if (hits[i].object < 0 || !verdict.is_same) continue;
    ++hit_count;
    ASSERT_LE(glm::distance(oracle::Vector(hits[i].normal), verdict.exact.normal), 1e-4L) << "ray " << i;
    ASSERT_NEAR(hits[i].u, verdict.exact.u, 1e-4L) << "ray " << i;
    ASSERT_NEAR(hits[i].v, verdict.exact.v, 1e-4L) << "ray " << i;
  }
  EXPECT_GT(hit_count, rays.size() / 2);
}

/// Returns a camera's rays in pixel order, in rows of 64, towards the scene of everything.
std::vector<Ray> make_rows(uint32_t rows) {
  std::vector<Ray> rays;
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < 64; ++x) {
      const vec3 direction(0.02F * (static_cast<float>(x) - 31.5F), 0.02F * (31.5F - static_cast<float>(y)), -1.0F);
      rays.push_back({vec3(0.5F, 1.5F, 8.0F), 0.0F, direction, kInfinity});
    }
  }
  return rays;
}

// On lavapipe, rays in rows are traced in packets and tile by tile. The same rays in random order are sorted and traced
// one by one.
TEST_F(CasterTest, AnswersDoNotDependOnTheOrder) {
  const world::Scene scene = test::make_scene_of_everything();
  // The number of rays is not a multiple of the size of a packet. Some rays have no direction, and some have an empty
  // interval of t.
  std::vector<Ray> rays = make_rows(63);
  rays.pop_back();
  rays[77].direction = vec3(0.0F);
  rays[78].tmax = 0.0F;
  rays[500].direction.y = -rays[500].direction.y;
  rays[501].origin.x = std::numeric_limits<float>::quiet_NaN();
  ASSERT_FALSE(RayTiler().tile(rays, {vec3(0.0F), 1.0F}).empty());
  std::vector<size_t> order(rays.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::vector<Ray> shuffled(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) shuffled[i] = rays[order[i]];
  for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
    const std::vector<Hit> expected = cast(scene, rays, query);
    const std::vector<Hit> hits = cast(scene, shuffled, query);
    std::vector<Hit> restored(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) restored[order[i]] = hits[i];
    EXPECT_TRUE(have_same_bits(restored, expected));
    EXPECT_GT(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.t < kInfinity; }), 1000);
  }
}

// The rays of a packet belong to several octants, and some finish before others.
TEST_F(CasterTest, PacketsOfAnySizeGiveTheSameBits) {
  const world::Scene scene = test::make_scene_of_everything();
  const PackedScene packed = pack_scene(scene, "sah");
  const std::shared_ptr<const DeviceScene> device_scene = upload_scene(device(), packed);
  std::vector<layout::RayRecord> rays;
  for (const Ray& ray : test::make_rays(1001))
    rays.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
    std::vector<layout::HitRecord> expected;
    for (const uint32_t size : {1U, 2U, 4U}) {
      RayKernelOptions options;
      options.features = features_of(scene);
      options.query = query;
      options.packet_size = size;
      std::vector<layout::HitRecord> records(rays.size());
      RayKernel(device(), device_scene, options).run(rays, records);
      if (expected.empty()) expected = records;
      // An any-hit query only reports whether there is a hit. The packet may determine which hit the query finds.
      size_t differences = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        const bool is_same = query == HitQuery::kAny
                                 ? (records[i].a.y == layout::NO_ORDER) == (expected[i].a.y == layout::NO_ORDER)
                                 : std::memcmp(&records[i], &expected[i], sizeof(layout::HitRecord)) == 0;
        differences += is_same ? 0 : 1;
      }
      EXPECT_EQ(differences, 0U) << "packets of " << size;
    }
  }
}

// Forms that are chosen for one driver also run on others, so the test compares all forms on each driver.
TEST_F(CasterTest, EveryFormOfTraversalGivesTheSameBits) {
  const world::Scene scene = test::make_scene_of_everything();
  const std::shared_ptr<const DeviceScene> device_scene = upload_scene(device(), pack_scene(scene, "sah"));
  std::vector<layout::RayRecord> rays;
  for (const Ray& ray : test::make_rays(1001)) {
    rays.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  }
  for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
    for (const uint32_t packet_size : {1U, 4U}) {
      std::vector<layout::HitRecord> expected;
      const std::vector<gpu::TraversalForm> forms = {{0, false}, {2, true}, {0, true}, {1, false}, {1, true}};
      for (const gpu::TraversalForm form : query == HitQuery::kNearest ? forms : test::cases_of(forms, 2)) {
        RayKernelOptions options;
        options.features = features_of(scene) | layout::FEATURE_STEP_COUNTS;
        options.query = query;
        options.packet_size = packet_size;
        options.traversal = form;
        std::vector<layout::HitRecord> records(rays.size());
        RayKernel(device(), device_scene, options).run(rays, records);
        if (expected.empty()) expected = records;
        EXPECT_EQ(std::memcmp(records.data(), expected.data(), records.size() * sizeof(layout::HitRecord)), 0)
            << form.steps_together << " steps together, solids " << (form.waits_with_solids ? "wait" : "do not wait");
      }
    }
  }
}

TEST_F(CasterTest, SolidsWaitWhereTrianglesAreAtLeastAsMany) {
  gpu::DeviceProfile profile;
  profile.ray_traversal = {.steps_together = 2, .waits_with_solids = true};
  const auto form_of = [&](uint32_t sphere_count, const gpu::DeviceProfile& of) {
    const world::Scene scene = test::make_scene_of_everything(sphere_count);
    const PackedScene packed = pack_scene(scene, "sah");
    return std::pair(traversal_form(of, *upload_scene(device(), packed), 1), packed);
  };
  const auto [few, few_packed] = form_of(1, profile);
  EXPECT_GE(few_packed.bounded_count - few_packed.solid_count, few_packed.solid_count);
  EXPECT_TRUE(few.waits_with_solids);
  EXPECT_EQ(few.steps_together, 2U);
  const auto [many, many_packed] = form_of(few_packed.bounded_count, profile);
  EXPECT_FALSE(many.waits_with_solids);
  EXPECT_EQ(many.steps_together, 2U);
  EXPECT_FALSE(form_of(1, gpu::DeviceProfile{}).first.waits_with_solids);
}

TEST_F(CasterTest, CompilesOnceWhateverTheScene) {
  // The test opens its own device, on which nothing has been compiled.
  const gpu::DeviceHandle own = gpu::open_device();
  RayKernelOptions options;
  options.features = layout::FEATURE_SPHERES | layout::FEATURE_STEP_COUNTS;
  const auto compile = [&](uint32_t sphere_count) {
    const PackedScene packed = pack_scene(test::make_scene_of_everything(sphere_count), "sah");
    const RayKernel kernel(*own, upload_scene(*own, packed), options);
    return own->compiled_pipelines().size();
  };
  const size_t before = own->compiled_pipelines().size();
  EXPECT_EQ(compile(200), before + 1);
  EXPECT_EQ(compile(201), before + 1);
  options.query = HitQuery::kAny;
  EXPECT_EQ(compile(200), before + 2);
}

// Returns the triangles of a square of 32 x 32 cells; all corners are at integers, with z = 0.
Mesh make_grid() {
  constexpr uint32_t kSide = 32;
  Mesh mesh;
  for (uint32_t y = 0; y <= kSide; ++y) {
    for (uint32_t x = 0; x <= kSide; ++x) mesh.positions.emplace_back(x, y, 0.0F);
  }
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t corner = y * (kSide + 1) + x;
      mesh.triangles.push_back({corner, corner + 1, corner + kSide + 2});
      mesh.triangles.push_back({corner, corner + kSide + 2, corner + kSide + 1});
    }
  }
  return mesh;
}

class AnyHitTest : public CasterTest {
 protected:
  /// Expects that any-hit queries hit exactly when nearest-hit queries do. Returns the fraction of rays that hit.
  static double part_of_hits(const world::Scene& scene, std::span<const Ray> rays) {
    const std::vector<Hit> nearest = cast(scene, rays);
    const std::vector<Hit> any = cast(scene, rays, HitQuery::kAny);
    size_t hit_count = 0;
    size_t difference_count = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const bool is_hit = nearest[i].object >= 0;
      difference_count += any[i].t == (is_hit ? 0.0F : kInfinity) ? 0 : 1;
      hit_count += is_hit ? 1 : 0;
    }
    EXPECT_EQ(difference_count, 0U);
    return static_cast<double>(hit_count) / static_cast<double>(rays.size());
  }
};

// The fast test is uncertain for these rays, because they hit edges and corners, or end on the triangle.
TEST_F(AnyHitTest, IsFoundAtEdgesAndEnds) {
  std::vector<Ray> rays;
  for (const float z : {8.0F, 7.3F, 1024.0F, 1.0e6F}) {
    // The rays go straight down or at an angle, through multiples of 1/2, which are corners, edges and diagonals, and
    // through other points.
    for (const vec3 lean : {vec3(0.0F), vec3(0.5F, 0.25F, 0.0F), vec3(-0.3F, 0.7F, 0.0F)}) {
      for (int i = 0; i < 65 * 65; ++i) {
        const int column = i % 65;
        const int row = i / 65;
        const vec3 nudge = i % 3 == 0 ? vec3(0.1F, 0.2F, 0.0F) : vec3(0.0F);
        const vec3 target = 0.5F * vec3(column, row, 0) + nudge;
        const vec3 direction = vec3(0, 0, -1) + lean;
        for (const float tmax : {z, std::nextafter(z, kInfinity), kInfinity}) {
          rays.push_back({target - z * direction, 0.0F, direction, tmax});
        }
        rays.push_back({target, 0.0F, direction, kInfinity});
      }
    }
  }
  const double part = part_of_hits(scene_of({make_grid()}), rays);
  EXPECT_GT(part, 0.25);
  EXPECT_LT(part, 0.75);
}

TEST_F(AnyHitTest, IsFoundOnSlivers) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  const auto random = [&] { return vec3(uniform(generator), uniform(generator), uniform(generator)); };
  Mesh mesh;
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < 20000; ++i) {
    const vec3 a = random();
    const vec3 b = a + 0.1F * random();
    const float middle = 0.5F + 0.5F * uniform(generator);
    const vec3 c = a + middle * (b - a) + std::pow(10.0F, -3.5F + 3.0F * uniform(generator)) * random();
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    const vec3 target = (a + b + c) / 3.0F;
    const vec3 origin = 3.0F * random();
    // Of three rays, one goes through the point, one ends there, and one starts there.
    rays.push_back({origin, 0.0F, target - origin, kInfinity});
    rays.push_back({origin, 0.0F, target - origin, 1.0F});
    rays.push_back({target, 0.0F, target - origin, kInfinity});
    // This ray lies in the triangle's plane, as exactly as fp32 allows.
    rays.push_back({a + 3.0F * (b - a), 0.0F, target - (a + 3.0F * (b - a)), kInfinity});
  }
  const double part = part_of_hits(scene_of({mesh}), rays);
  EXPECT_GT(part, 0.1);
  EXPECT_LT(part, 0.9);
}

// The second test checks the uncertain triangle and not the next triangle of the leaf.
TEST_F(AnyHitTest, IsFoundBesideSolids) {
  Mesh mesh;
  mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  // All shapes are in one leaf.
  const world::Scene scene = scene_of({mesh, world::Sphere{vec3(0.5F, 0.5F, 0.0F), 0.01F},
                                       world::Cylinder{vec3(0.5F, 0.5F, 0.1F), vec3(0, 0, 1), 0.01F, 0.02F}});
  std::vector<Ray> rays;
  for (const float z : {4.0F, 4.0e3F, 4.0e6F}) {
    for (int i = 0; i <= 64; ++i) {
      const float x = static_cast<float>(i) / 64.0F;
      // The rays go along the sides, and inside up to the triangle and a little beyond.
      rays.push_back({vec3(x, 0, z), 0.0F, vec3(0, 0, -1), kInfinity});
      rays.push_back({vec3(0, x, z), 0.0F, vec3(0, 0, -1), kInfinity});
      rays.push_back({vec3(0.3F * x, 0.3F, z), 0.0F, vec3(0, 0, -1), z});
      rays.push_back({vec3(0.3F * x, 0.3F, z), 0.0F, vec3(0, 0, -1), std::nextafter(z, kInfinity)});
    }
  }
  EXPECT_NEAR(part_of_hits(scene, rays), 0.75, 0.01);
}

// Products that the fast test computes overflow here. The products of the complete test do not.
TEST_F(AnyHitTest, IsFoundInVastScenes) {
  const float size = 6.0e12F;
  Mesh mesh;
  mesh.positions = {size * vec3(0, 1, -1), size * vec3(-1, -1, 1.1F), size * vec3(1, -1, 1.1F)};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<Ray> rays = {{vec3(0.0F), 0.0F, vec3(0, 0, 1), kInfinity},
                                 {vec3(0.0F), 0.0F, vec3(0, 0, -1), kInfinity}};
  EXPECT_DOUBLE_EQ(part_of_hits(scene_of({mesh}), rays), 0.5);
}

// The direction is the unit of t. It is so short that t would be 10^40.
TEST_F(CasterTest, HitsWithoutATAreNone) {
  Mesh mesh;
  mesh.positions = {vec3(-1, -1, 0), vec3(1, -1, 0), vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 2}};
  const world::Scene scene = scene_of({mesh});
  const std::vector<Ray> rays = {{vec3(0, 0, 1e10F), 0.0F, vec3(0, 0, -1e-30F), kInfinity},
                                 {vec3(0, 0, 1e7F), 0.0F, vec3(0, 0, -1e-30F), kInfinity},
                                 {vec3(0, 0, 100), 0.0F, vec3(0, 0, -1e-37F), kInfinity},
                                 {vec3(0, 0, 10), 0.0F, vec3(0, 0, -1e-37F), kInfinity}};
  for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
    const std::vector<Hit> hits = cast(scene, rays, query);
    EXPECT_EQ(hits[0].t, kInfinity);
    EXPECT_LT(hits[1].t, kInfinity);
    EXPECT_EQ(hits[2].t, kInfinity);
    EXPECT_LT(hits[3].t, kInfinity);
  }
}

// llvmpipe ends the loops of a lane after 65535 iterations. The result at that point is incomplete.
TEST_F(CasterTest, TooManyTurnsAreRefusedOrTraced) {
  constexpr int kSlivers = 40000;
  Mesh mesh;
  // The slivers lie along a diagonal. The ray hits their boxes, but not the slivers. A triangle is behind them.
  for (int i = 0; i < kSlivers; ++i) {
    const auto z = static_cast<float>(i + 1);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {vec3(-1, -1, z), vec3(1, 1, z), vec3(1, 0.99F, z)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const auto last = static_cast<uint32_t>(mesh.positions.size());
  const float back = kSlivers + 1;
  mesh.positions.insert(mesh.positions.end(), {vec3(-9, -9, back), vec3(9, -9, back), vec3(0, 9, back)});
  mesh.triangles.push_back({last, last + 1, last + 2});
  const world::Scene scene = scene_of({mesh});
  const std::vector<Ray> rays = {{vec3(-0.5F, 0.5F, 0), 0.0F, vec3(0, 0, 1), kInfinity}};
  try {
    EXPECT_EQ(cast(scene, rays)[0].primitive, kSlivers);
  } catch (const RunError& error) {
    EXPECT_TRUE(device().profile().may_cut_loops);
    EXPECT_THAT(list_problems(error), HasProblem("device.loops.cut"));
  }
}

TEST_F(CasterTest, AnswersDoNotDependOnTheCompany) {
  const world::Scene scene = test::make_scene_of_everything();
  const std::vector<Ray> rays = test::make_rays(3000);
  Caster caster = make_caster(device(), scene);
  std::vector<Hit> together(rays.size());
  caster.cast(rays, together);
  std::vector<Hit> apart(rays.size());
  for (size_t first = 0; first < rays.size(); first += 777) {
    const size_t count = std::min<size_t>(777, rays.size() - first);
    caster.cast(std::span(rays).subspan(first, count), std::span(apart).subspan(first, count));
  }
  EXPECT_TRUE(have_same_bits(apart, together));
}

// fp32 arithmetic alone would underflow or overflow for these directions. They are denormal, or near the largest
// number.
TEST_F(CasterTest, DirectionsHaveAnyLength) {
  const world::Scene scene = scene_of({world::Sphere{vec3(0.0F), 1e-3F}});
  const vec3 origin(0, 0, 2e-3F);
  for (const float length : {1e-40F, 1e-37F, 1.2e-38F, 1.0F, 1e37F, 1.7e38F, 3e38F}) {
    const std::vector<Ray> rays = {{origin, 0.0F, vec3(0, 0, -length), kInfinity},
                                   {origin, 0.0F, vec3(0, 0, length), kInfinity}};
    const std::vector<Hit> hits = cast(scene, rays);
    EXPECT_EQ(hits[0].object, 0) << length;
    // The step between denormal values of t; the longest directions have such a t.
    const double step = 0x1p-149 * static_cast<double>(length);
    EXPECT_NEAR(static_cast<double>(hits[0].t) * static_cast<double>(length), 1e-3, 1e-9 + step) << length;
    EXPECT_EQ(hits[1].object, -1) << length;
  }
  // t would be 1e42, which no float holds; the ray misses, because tmax is at most infinite.
  world::Scene far = scene;
  far.objects[0].shape = world::Sphere{vec3(0, 0, -1e4F), 1.0F};
  EXPECT_EQ(cast(far, std::vector<Ray>{{origin, 0.0F, vec3(0, 0, -1e-38F), kInfinity}})[0].object, -1);
}

TEST_F(CasterTest, ObjectsWithoutPrimitivesTakeANumber) {
  world::Scene scene;
  scene.materials.resize(1);
  Mesh mesh;
  mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
  mesh.triangles = {{0, 1, 1}, {0, 1, 2}};  // the first triangle is degenerate
  scene.objects = {
      {"", world::NotDrawn{}, 0}, {"", Mesh{}, 0}, {"", mesh, 0}, {"", world::NotDrawn{}, 0}, {"", world::Sphere{}, 0}};
  scene.objects[4].shape = world::Sphere{vec3(0, 0, 9), 1.0F};
  const std::vector<Ray> rays = {{vec3(0.2F, 0.2F, 4), 0, vec3(0, 0, -1), kInfinity},
                                 {vec3(0.2F, 0.2F, 4), 0, vec3(0, 0, 1), kInfinity}};
  const std::vector<Hit> hits = cast(scene, rays);
  EXPECT_EQ(hits[0].object, 2);
  EXPECT_EQ(hits[0].primitive, 1);
  EXPECT_EQ(hits[1].object, 4);
  EXPECT_EQ(hits[1].primitive, 0);
}

// The same memory can be read in two ways: as words of a storage buffer, and as texels.
TEST_F(CasterTest, TexelsAndStorageBuffersGiveTheSameBits) {
  const PackedScene packed = pack_scene(test::make_scene_of_everything(2000), "sah");
  const std::shared_ptr<const DeviceScene> scene = upload_scene(device(), packed);
  std::vector<layout::RayRecord> requests;
  for (const Ray& ray : test::make_rays(20000)) {
    requests.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  }
  std::vector<layout::HitRecord> by_texels(requests.size());
  std::vector<layout::HitRecord> by_words(requests.size());
  RayKernelOptions options;
  RayKernel(device(), scene, options).run(requests, by_texels);
  options.avoids_texels = true;
  RayKernel(device(), scene, options).run(requests, by_words);
  EXPECT_EQ(std::memcmp(by_texels.data(), by_words.data(), by_texels.size() * sizeof(layout::HitRecord)), 0);
}

TEST_F(CasterTest, UnknownBuildersAreRefused) {
  EXPECT_THROW(make_caster(device(), test::make_scene_of_everything(), CasterOptions{.builder = "shah"}), UsageError);
}

// AOVs have the values of a cast of the pixel's ray, and do not change the picture's bits.
TEST_F(CasterTest, AovsAreTheHitsOfThePixels) {
  const world::Scene scene = test::make_scene_of_everything();
  View view = test::make_view(uvec2(150, 100));
  TunedRendererOptions options;
  options.with_aovs = true;
  options.blocks_per_dispatch = 7;
  Renderer renderer = make_renderer(device(), scene, options);
  const RenderResult with = renderer.render(view);
  EXPECT_TRUE(test::has_same_bits(with.image, make_renderer(device(), scene).render(view).image));

  std::vector<Ray> rays;
  const dvec3 look(view.camera.look);
  const dvec3 up(view.camera.up);
  const dvec3 right = glm::cross(look, up);
  const double pixel = 2.0 * std::tan(0.5 * static_cast<double>(view.camera.yfov)) / view.size.y;
  for (uint32_t y = 0; y < view.size.y; ++y) {
    for (uint32_t x = 0; x < view.size.x; ++x) {
      const dvec3 on_film = pixel * ((x + 0.5 - 0.5 * view.size.x) * right + (0.5 * view.size.y - y - 0.5) * up);
      rays.push_back({view.camera.eye, 0.0F, vec3(look + on_film), kInfinity});
    }
  }
  const std::vector<Hit> hits = cast(scene, rays);
  size_t other_ids = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (static_cast<int32_t>(with.aovs.object[i]) != hits[i].object ||
        static_cast<int32_t>(with.aovs.primitive[i]) != hits[i].primitive) {
      ++other_ids;
      continue;
    }
    if (hits[i].object < 0) {
      EXPECT_EQ(with.aovs.depth[i], kInfinity);
      EXPECT_EQ(with.aovs.normal[i], vec3(0.0F));
      continue;
    }
    const double distance = static_cast<double>(hits[i].t) * glm::length(dvec3(rays[i].direction));
    EXPECT_NEAR(with.aovs.depth[i], distance, 1e-5 * distance) << "pixel " << i;
    EXPECT_LE(glm::distance(with.aovs.normal[i], hits[i].normal), 2e-4F) << "pixel " << i;
  }
  EXPECT_LE(other_ids, 3U);

  // If the number of samples is odd, the middle one is the centre; a crop has the values of the whole picture.
  view.samples_per_pixel = 3;
  EXPECT_EQ(renderer.render(view).aovs.depth, with.aovs.depth);
  view.crop = PixelWindow{uvec2(13, 29), uvec2(14, 71)};
  const RenderResult crop = renderer.render(view);
  ASSERT_EQ(crop.aovs.object.size(), 42U);
  for (uint32_t y = 0; y < 42; ++y) {
    EXPECT_EQ(crop.aovs.object[y], with.aovs.object[(y + 29) * 150 + 13]);
    EXPECT_EQ(crop.aovs.normal[y], with.aovs.normal[(y + 29) * 150 + 13]);
  }
}

TEST(PrimitiveOfOrder, FindsTheObject) {
  const PrimitiveNumbers numbers{.first_order = {0, 0, 2, 3, 3, 5}, .is_rewound = {}, .parts = {}};
  const auto id = [&](uint32_t order) {
    const PrimitiveId found = primitive_of_order(numbers, order);
    return std::pair(found.object, found.primitive);
  };
  EXPECT_EQ(id(0), std::pair(1U, 0U));
  EXPECT_EQ(id(1), std::pair(1U, 1U));
  EXPECT_EQ(id(2), std::pair(2U, 0U));
  EXPECT_EQ(id(3), std::pair(4U, 0U));
  EXPECT_EQ(id(4), std::pair(4U, 1U));
}

}  // namespace
}  // namespace promin
