// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests are the same for every shape of promin/kinds/primitives.def.
#include <gtest/gtest.h>

#include <cstring>

#include "gpu/device_fixture.h"
#include "hard/hard_case.h"
#include "hard/random_shapes.h"
#include "hard/self_hits.h"
#include "oracle/distance.h"
#include "shapes/shapes.h"

namespace promin::hard {
namespace {

/// A list of types that may begin with a comma.
template <class Nothing, class... Shape>
struct ListOf {
  using Types = testing::Types<Shape...>;
};
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , world::TYPE
using Shapes = ListOf<void
#include "promin/kinds/primitives.def"
                      >::Types;
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , world::TYPE
using Solids = ListOf<void
#include "promin/kinds/primitives.def"
                      >::Types;

/// Returns a shape's name in the names of tests.
struct ShapeName {
  template <class Shape>
  static std::string GetName(int) {
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (std::is_same_v<Shape, world::TYPE>) return #TYPE;
#include "promin/kinds/primitives.def"
    return "";
  }
};

constexpr int kShapeCount = 20;
const size_t kRayCount = some_of(5000);
/// Centres near the origin, and so far from it that a unit in the last place is a thousandth of a shape.
constexpr vec3 kCenters[] = {vec3(0.0F), vec3(0.3F, -0.7F, 0.4F), vec3(1000.0F, -800.0F, 1200.0F)};

oracle::Vector random_point(const Bounds& bounds, Random& random) {
  oracle::Vector point;
  for (int i = 0; i < 3; ++i) point[i] = random.uniform(bounds.lo[i], bounds.hi[i]);
  return point;
}

template <class Shape>
class ShapeTest : public test::DeviceTest {
 protected:
  static Shape make(const vec3& center) { return random_shape<Shape>(center, random()); }
  static Random& random() {
    static Random random(7);
    return random;
  }
};
TYPED_TEST_SUITE(ShapeTest, Shapes, ShapeName);

template <class Shape>
class SolidTest : public ShapeTest<Shape> {};
TYPED_TEST_SUITE(SolidTest, Solids, ShapeName);

TYPED_TEST(ShapeTest, PackingRoundTrips) {
  for (int i = 0; i < kShapeCount; ++i) {
    const TypeParam shape = this->make(kCenters[i % 3]);
    const layout::Primitive packed = pack(shape);
    const TypeParam unpacked = unpack<TypeParam>(packed);
    if constexpr (requires { shape == unpacked; }) {
      EXPECT_EQ(shape, unpacked);
    } else {
      EXPECT_EQ(std::memcmp(&shape, &unpacked, sizeof shape), 0);
    }
    // The caller fills the words that do not belong to the shape.
    EXPECT_EQ(uvec3(packed.c.y, packed.c.z, packed.c.w), uvec3(0));
  }
}

/// Rays from all around have errors within B1, B2 and BK of docs/accuracy.md, compared with the oracle.
TYPED_TEST(ShapeTest, TheOracleAgrees) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < kShapeCount; ++i) {
    const vec3 center = kCenters[i % 3];
    const TypeParam shape = this->make(center);
    const oracle::BoundingSphere around = oracle::bounding_sphere(shape, 0);
    const double radius = around.radius > 0 ? static_cast<double>(around.radius) : 1.0;
    std::vector<Ray> rays;
    for (size_t k = 0; k < kRayCount; ++k) {
      const dvec3 origin = dvec3(center) + 5.0 * radius * this->random().direction();
      rays.push_back(
          ray_towards(origin, dvec3(center) + radius * this->random().uniform() * this->random().direction()));
    }
    const Tally tally = lab.cast_and_judge(scene_of({shape}), rays);
    EXPECT_GT(tally.hits, 0U);
    EXPECT_EQ(tally.malformed, 0U);
    EXPECT_LE(tally.max_surface_error, 8.0 * lab.rounding_factor());
    EXPECT_LE(tally.max_margin, 2.0);
  }
}

/// Every point of the shape is within its bounds, and each of the bounds' six sides is near a point.
TYPED_TEST(SolidTest, BoundsAreTight) {
  for (int i = 0; i < kShapeCount; ++i) {
    const TypeParam shape = this->make(kCenters[i % 3]);
    const Bounds bounds = bounds_of(shape);
    const oracle::BoundingSphere around = oracle::bounding_sphere(shape, 0);
    const world::Scene scene = scene_of({shape});
    const vec3 margin(static_cast<float>(0.1L * around.radius));
    dvec3 lo(bounds.hi);
    dvec3 hi(bounds.lo);
    for (int k = 0; k < 20'000; ++k) {
      // Finds the point where a line through the bounds enters the shape.
      const oracle::Vector inside = random_point({bounds.lo - margin, bounds.hi + margin}, this->random());
      const oracle::Vector direction(this->random().direction());
      const oracle::Ray line{inside - 4 * around.radius * direction, direction};
      const oracle::Hit hit = oracle::find_nearest_hit(scene, line);
      if (!hit.exists()) continue;
      const dvec3 point(line.origin + hit.t * line.direction);
      lo = glm::min(lo, point);
      hi = glm::max(hi, point);
    }
    const auto least = static_cast<double>(0.1L * around.radius);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(bounds.lo[axis], lo[axis]);
      EXPECT_GE(bounds.hi[axis], hi[axis]);
      EXPECT_LE(lo[axis] - bounds.lo[axis], least);
      EXPECT_LE(bounds.hi[axis] - hi[axis], least);
    }
  }
}

TYPED_TEST(SolidTest, DoesNotLeak) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < kShapeCount; ++i) {
    const TypeParam shape = this->make(kCenters[i % 3]);
    const Bounds bounds = bounds_of(shape);
    std::vector<Ray> rays;
    while (rays.size() < kRayCount) {
      const dvec3 origin(random_point(bounds, this->random()));
      const Ray ray = ray_towards(origin, origin + this->random().direction());
      // The ray is inside also after rounding, by more than B2 allows as an error.
      const oracle::Ray exact{oracle::Vector(ray.origin), oracle::Vector(ray.direction)};
      const oracle::Real least = 4 * oracle::kRoundoff * oracle::scale_of(shape, 0, exact);
      if (oracle::signed_distance(shape, 0, exact.origin) < -least) rays.push_back(ray);
    }
    uint64_t lost = 0;
    for (const Hit& hit : lab.cast(scene_of({shape}), rays)) lost += hit.object < 0;
    EXPECT_EQ(lost, 0U);
  }
}

TYPED_TEST(SolidTest, SecondaryRaysLeave) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < 6; ++i) {
    const vec3 center = kCenters[i % 3];
    const TypeParam shape = this->make(center);
    const auto size = static_cast<double>(oracle::bounding_sphere(shape, 0).radius);
    EXPECT_EQ(count_self_hits(lab, shape, size, dvec3(center), this->random()), 0U);
  }
}

}  // namespace
}  // namespace promin::hard
