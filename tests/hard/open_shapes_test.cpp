// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check open cylinders and cones, which have a side but no disks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/device_fixture.h"
#include "hard/hard_case.h"
#include "hard/random_shapes.h"
#include "oracle/distance.h"
#include "scene/features.h"
#include "support/thorough.h"

namespace promin::hard {
namespace {

constexpr int kOpenShapeCount = 20;
/// Faults at a rim affect one ray in about ten thousand.
const int kRimShapeCount = test::is_thorough() ? 40 : 16;
const size_t kOpenRayCount = some_of(5000);
constexpr vec3 kOpenCenters[] = {vec3(0.0F), vec3(0.3F, -0.7F, 0.4F), vec3(1000.0F, -800.0F, 1200.0F)};

/// Gives both kinds of shape the same names.
struct Side {
  dvec3 center;
  dvec3 axis;
  double half_height;
  double radius_bottom;
  double radius_top;

  explicit Side(const world::Cylinder& c)
      : center(c.center),
        axis(glm::normalize(dvec3(c.axis))),
        half_height(c.half_height),
        radius_bottom(c.radius),
        radius_top(c.radius) {}
  explicit Side(const world::Cone& c)
      : center(c.center),
        axis(glm::normalize(dvec3(c.axis))),
        half_height(c.half_height),
        radius_bottom(c.radius_bottom),
        radius_top(c.radius_top) {}

  double widest() const { return std::max(radius_bottom, radius_top); }
  double size() const { return std::hypot(half_height, widest()); }
  double radius_at(double z) const {
    return 0.5 * (radius_bottom + radius_top) + z * (radius_top - radius_bottom) / (2.0 * half_height);
  }
  dvec3 at(double z, const dvec3& radial) const { return center + z * axis + radial; }
};

template <class Shape>
class OpenShapeTest : public test::DeviceTest {
 protected:
  Shape make(int i) {
    Shape shape = random_shape<Shape>(kOpenCenters[i % 3], random);
    shape.is_open = true;
    return shape;
  }

  void expect_bounds(const Lab& lab, const Tally& tally) {
    EXPECT_EQ(tally.malformed, 0U);
    EXPECT_LE(tally.max_surface_error, 8.0 * lab.rounding_factor());
    EXPECT_LE(tally.max_margin, 2.0);
  }

  Random random{47};
};
using OpenShapes = testing::Types<world::Cylinder, world::Cone>;
TYPED_TEST_SUITE(OpenShapeTest, OpenShapes);

TYPED_TEST(OpenShapeTest, TheOracleAgrees) {
  const Lab lab(this->device(), 0);
  uint64_t misses = 0;
  for (int i = 0; i < kOpenShapeCount; ++i) {
    const TypeParam shape = this->make(i);
    const Side side(shape);
    const double distance = side.size() * std::pow(10.0, this->random.uniform(0.2, 4.0));
    std::vector<Ray> rays;
    for (size_t k = 0; k < kOpenRayCount; ++k) {
      const double z = side.half_height * this->random.uniform(-1.1, 1.1);
      const dvec3 target = side.at(z, side.widest() * this->random.uniform() * this->random.perpendicular(side.axis));
      rays.push_back(ray_towards(side.center + distance * this->random.direction(), target));
    }
    const Tally tally = lab.cast_and_judge(scene_of({shape}), rays);
    EXPECT_GT(tally.hits, 0U);
    misses += tally.judged - tally.hits;
    this->expect_bounds(lab, tally);
  }
  EXPECT_GT(misses, 0U);
}

/// Rays go through the wide end to the wall beyond: they hit the inside, never a disk.
TYPED_TEST(OpenShapeTest, RaysEnterWhereADiskIsMissing) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < kOpenShapeCount; ++i) {
    const TypeParam shape = this->make(i);
    const Side side(shape);
    const double end = side.radius_bottom >= side.radius_top ? -1.0 : 1.0;
    std::vector<Ray> rays;
    for (size_t k = 0; k < kOpenRayCount; ++k) {
      const dvec3 gate = side.at(end * side.half_height, 0.9 * side.widest() * std::sqrt(this->random.uniform()) *
                                                             this->random.perpendicular(side.axis));
      const double z = side.half_height * this->random.uniform(-0.9, 0.9);
      const dvec3 wall = side.at(z, side.radius_at(z) * this->random.perpendicular(side.axis));
      // The rays start outside; every third starts in the missing disk itself.
      const dvec3 way = glm::normalize(wall - gate);
      rays.push_back(ray_towards(k % 3 == 0 ? gate : gate - side.size() * way, wall));
    }
    const world::Scene scene = scene_of({shape});
    const std::vector<Hit> hits = lab.cast(scene, rays);
    this->expect_bounds(lab, Lab::judge(scene, rays, hits));
    uint64_t lost = 0;
    uint64_t on_disks = 0;
    for (const Hit& hit : hits) {
      lost += hit.object < 0;
      const double across = glm::length(glm::cross(dvec3(hit.normal), side.axis));
      on_disks += hit.object >= 0 && across < 1e-6 && side.half_height > 1e-3 * side.widest();
    }
    EXPECT_EQ(lost, 0U) << "through the wall";
    EXPECT_EQ(on_disks, 0U);
  }
}

/// Rays exactly along the axis go through the tube, onto the wall where it narrows, or past the tube.
TYPED_TEST(OpenShapeTest, RaysAlongTheAxisPassThroughTheTube) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < kOpenShapeCount; ++i) {
    const TypeParam shape = this->make(i);
    const Side side(shape);
    const double narrow = std::min(side.radius_bottom, side.radius_top);
    const float sign = i % 2 == 0 ? 1.0F : -1.0F;
    const double distance = 3.0 * side.size();
    const double gap = 8.0 * static_cast<double>(oracle::kRoundoff) *
                       (glm::length(dvec3(kOpenCenters[i % 3])) + 2.0 * distance + side.size());
    std::vector<Ray> through;
    std::vector<Ray> at_wall;
    for (size_t k = 0; k < kOpenRayCount; ++k) {
      const auto ray_at = [&](double impact) {
        const dvec3 foot = side.at(0.0, impact * this->random.perpendicular(side.axis));
        Ray ray = ray_towards(foot - static_cast<double>(sign) * distance * side.axis, foot);
        ray.direction = sign * shape.axis;
        return ray;
      };
      if (narrow > gap) through.push_back(ray_at((narrow - gap) * std::sqrt(this->random.uniform())));
      through.push_back(ray_at(side.widest() * this->random.uniform(1.0, 2.0) + gap));
      if (side.widest() - narrow > 3.0 * gap) {
        at_wall.push_back(ray_at(this->random.uniform(narrow + gap, side.widest() - gap)));
      }
    }
    uint64_t stopped = 0;
    uint64_t lost = 0;
    for (const Hit& hit : lab.cast(scene_of({shape}), through)) stopped += hit.object >= 0;
    for (const Hit& hit : lab.cast(scene_of({shape}), at_wall)) lost += hit.object < 0;
    EXPECT_EQ(stopped, 0U);
    EXPECT_EQ(lost, 0U);
  }
}

/// Rays aim at rims from all around. Many go along the missing disk, and many go through apexes in the plane of the
/// apex.
TYPED_TEST(OpenShapeTest, RimsAreWhereTheSideEnds) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < kRimShapeCount; ++i) {
    const TypeParam shape = this->make(i);
    const Side side(shape);
    std::vector<Ray> rays;
    for (size_t k = 0; k < kOpenRayCount / 4; ++k) {
      const double end = k % 2 == 0 ? -1.0 : 1.0;
      const dvec3 radial = this->random.perpendicular(side.axis);
      const dvec3 rim = side.at(end * side.half_height, side.radius_at(end * side.half_height) * radial);
      const dvec3 direction = k % 3 == 0 ? this->random.perpendicular(side.axis) : this->random.direction();
      rays.push_back(ray_towards(rim - side.size() * std::pow(10.0, this->random.uniform(0.3, 3.0)) * direction, rim));
    }
    const Tally tally = lab.cast_and_judge(scene_of({shape}), rays);
    EXPECT_GT(tally.hits, 0U);
    this->expect_bounds(lab, tally);
  }
}

/// Rays from points inside go to the wall and out of the ends.
TYPED_TEST(OpenShapeTest, FromInsideTheWallIsMetAndTheEndsAreNot) {
  const Lab lab(this->device(), 0);
  uint64_t misses = 0;
  for (int i = 0; i < kOpenShapeCount; ++i) {
    const TypeParam shape = this->make(i);
    const Side side(shape);
    std::vector<Ray> rays;
    for (size_t k = 0; k < kOpenRayCount; ++k) {
      const double z = side.half_height * this->random.uniform(-1.0, 1.0);
      const double radius = side.radius_at(z) * std::sqrt(this->random.uniform());
      const dvec3 origin = side.at(z, radius * this->random.perpendicular(side.axis));
      rays.push_back(ray_towards(origin, origin + this->random.direction()));
    }
    const Tally tally = lab.cast_and_judge(scene_of({shape}), rays);
    EXPECT_GT(tally.hits, 0U);
    misses += tally.judged - tally.hits;
    this->expect_bounds(lab, tally);
  }
  EXPECT_GT(misses, 0U);
}

/// For a closed shape, a pipeline with open shapes gives the same bits as one without.
TYPED_TEST(OpenShapeTest, ClosedShapesKeepTheirBits) {
  const Lab lab(this->device(), 0);
  for (int i = 0; i < 6; ++i) {
    TypeParam shape = this->make(i);
    shape.is_open = false;
    const Side side(shape);
    TypeParam far_away = shape;
    far_away.center += vec3(1e4F * static_cast<float>(side.size()), 0.0F, 0.0F);
    TypeParam far_open = far_away;
    far_open.is_open = true;
    std::vector<Ray> rays;
    for (size_t k = 0; k < kOpenRayCount; ++k) {
      const dvec3 origin = side.center + 5.0 * side.size() * this->random.direction();
      rays.push_back(
          ray_towards(origin, side.center + side.size() * this->random.uniform() * this->random.direction()));
    }
    const std::vector<Hit> closed = lab.cast(scene_of({shape, far_away}), rays);
    const std::vector<Hit> beside_open = lab.cast(scene_of({shape, far_open}), rays);
    uint64_t differences = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
      differences += std::memcmp(&closed[k], &beside_open[k], sizeof(Hit)) != 0;
    }
    EXPECT_EQ(differences, 0U);
  }
}

TEST(OpenShapeFeatures, OnlyOpenShapesAskForTheirFeature) {
  world::Cylinder cylinder;
  world::Cone cone;
  EXPECT_FALSE(features_of(scene_of({cylinder, cone})).has_any(layout::FEATURE_OPEN_SHAPES));
  cone.is_open = true;
  EXPECT_TRUE(features_of(scene_of({cylinder, cone})).has_any(layout::FEATURE_OPEN_SHAPES));
}

}  // namespace
}  // namespace promin::hard
