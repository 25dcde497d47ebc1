// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/placed_bounds.h"

#include <gtest/gtest.h>

#include <bit>
#include <glm/gtc/quaternion.hpp>

#include "measure/random.h"
#include "promin/error.h"

namespace promin {
namespace {

using measure::Random;

Bounds bounds_of_all(const std::vector<vec3>& points, const dmat4& matrix) {
  Bounds bounds;
  for (const vec3& p : points) bounds.extend(matrix == dmat4(1.0) ? p : vec3(matrix * dvec4(p, 1.0)));
  return bounds;
}

void expect_same_bits(const Bounds& a, const Bounds& b) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(std::bit_cast<uint32_t>(a.lo[i]), std::bit_cast<uint32_t>(b.lo[i]));
    EXPECT_EQ(std::bit_cast<uint32_t>(a.hi[i]), std::bit_cast<uint32_t>(b.hi[i]));
  }
}

TEST(PlacedBoundsTest, HasTheBitsOfALoopOverAllPoints) {
  Random random(1);
  for (const size_t count : {1, 2, 16, 17, 1000, 5000}) {
    std::vector<vec3> points;
    for (size_t i = 0; i < count; ++i) points.emplace_back(random.direction());
    points.front() = vec3(-0.0F);
    const PlacedBounds placed(points);
    const PlacedBounds often_placed(points, 1'000'000);
    expect_same_bits(placed.of(dmat4(1.0)), bounds_of_all(points, dmat4(1.0)));
    expect_same_bits(often_placed.of(dmat4(1.0)), bounds_of_all(points, dmat4(1.0)));
    for (int i = 0; i < 100; ++i) {
      dmat4 matrix = glm::mat4_cast(glm::angleAxis(random.uniform(-3.0, 3.0), random.direction()));
      for (int axis = 0; axis < 3; ++axis) matrix[axis] *= std::pow(10.0, random.uniform(-3.0, 3.0));
      matrix[3] = dvec4(std::pow(10.0, random.uniform(-6.0, 6.0)) * random.direction(), 1.0);
      expect_same_bits(placed.of(matrix), bounds_of_all(points, matrix));
      expect_same_bits(often_placed.of(matrix), bounds_of_all(points, matrix));
    }
  }
}

TEST(PlacedBoundsTest, ObjectsThatShareAMeshHaveTheirOwnBounds) {
  Random random(2);
  Mesh mesh;
  for (int i = 0; i < 300; ++i) mesh.positions.emplace_back(random.direction());
  for (uint32_t i = 0; i + 3 < 300; i += 3) mesh.triangles.emplace_back(i, i + 1, i + 2);
  // The last position is in no triangle, so it does not count.
  mesh.positions.back() = vec3(100.0F);
  Scene scene;
  scene.materials.emplace_back();
  scene.add("", mesh);
  for (int i = 1; i < 5; ++i) {
    scene.objects.push_back(scene.objects.front());
    scene.objects.back().world_from_object[3] = dvec4(10.0 * i, 0.0, 0.0, 1.0);
  }
  scene.objects.push_back({});
  const std::vector<Bounds> bounds = bounds_of_objects(scene);
  ASSERT_EQ(bounds.size(), 6U);
  std::vector<vec3> corners = mesh.positions;
  corners.pop_back();
  corners.pop_back();
  corners.pop_back();
  for (size_t i = 0; i < 5; ++i) {
    expect_same_bits(bounds[i], bounds_of_all(corners, scene.objects[i].world_from_object));
  }
  EXPECT_TRUE(bounds[5].is_empty());
  std::get<Mesh>(scene.geometries[0]).triangles.emplace_back(0, 1, 300);
  EXPECT_THROW(bounds_of_objects(scene), InputError);
}

}  // namespace
}  // namespace promin
