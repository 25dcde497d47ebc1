// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "bvh/builder.h"
#include "bvh/clip_triangle.h"
#include "support/expect_tree.h"
#include "support/pipes.h"

namespace promin {
namespace {

using TriangleOfInput = std::array<vec3, 3>;

std::vector<TriangleOfInput> triangles_of(const Mesh& mesh) {
  std::vector<TriangleOfInput> triangles;
  for (const uvec3& corners : mesh.triangles) {
    triangles.push_back({mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]});
  }
  return triangles;
}

std::vector<Bounds> boxes_of(const std::vector<TriangleOfInput>& triangles) {
  std::vector<Bounds> boxes(triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (const vec3& corner : triangles[i]) boxes[i].extend(corner);
  }
  return boxes;
}

/// The input of a builder, with the object that holds its data.
struct Input {
  std::vector<TriangleOfInput> triangles;
  std::vector<Bounds> boxes = boxes_of(triangles);

  BuildInput get() const {
    return {boxes, [this](uint32_t i, const Bounds& window) { return clip_triangle(triangles[i], window); }};
  }
};

using Polygon = std::vector<dvec3>;

double area_of(const Polygon& polygon) {
  dvec3 sum(0.0);
  for (size_t i = 2; i < polygon.size(); ++i) {
    sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return 0.5 * glm::length(sum);
}

/// Returns the parts of a convex polygon on the two sides of a plane perpendicular to an axis.
std::pair<Polygon, Polygon> cut(const Polygon& polygon, int axis, double plane) {
  std::pair<Polygon, Polygon> parts;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec3& p = polygon[i];
    const dvec3& q = polygon[(i + 1) % polygon.size()];
    if (p[axis] <= plane) parts.first.push_back(p);
    if (p[axis] >= plane) parts.second.push_back(p);
    if ((p[axis] < plane) == (q[axis] < plane) || p[axis] == plane || q[axis] == plane) continue;
    dvec3 crossing = glm::mix(p, q, (plane - p[axis]) / (q[axis] - p[axis]));
    crossing[axis] = plane;
    parts.first.push_back(crossing);
    parts.second.push_back(crossing);
  }
  return parts;
}

/// Returns the parts of convex polygons outside a box, again as convex polygons.
std::vector<Polygon> subtract(const std::vector<Polygon>& polygons, const Bounds& box) {
  std::vector<Polygon> outside;
  const auto add = [&](Polygon part, int axis, double plane) {
    // A polygon in a side of the box counts as inside the box.
    const bool has_area = std::any_of(part.begin(), part.end(), [&](const dvec3& p) { return p[axis] != plane; });
    if (part.size() >= 3 && has_area) outside.push_back(std::move(part));
  };
  for (Polygon rest : polygons) {
    for (int axis = 0; axis < 3 && !rest.empty(); ++axis) {
      auto [below, from_lo] = cut(rest, axis, box.lo[axis]);
      auto [inside, above] = cut(from_lo, axis, box.hi[axis]);
      add(std::move(below), axis, box.lo[axis]);
      add(std::move(above), axis, box.hi[axis]);
      rest = std::move(inside);
    }
  }
  return outside;
}

/// Adds two well-shaped triangles that extend over all other triangles. The builder cuts them along all axes.
Input make_input(uint32_t pipes) {
  Input input{triangles_of(test::make_pipes(pipes))};
  input.triangles.push_back({vec3(-1, -1, -0.5F), vec3(2, -0.5F, 1), vec3(0, 2, 1.5F)});
  input.triangles.push_back({vec3(-1, 0.5F, -1), vec3(2, 0.5F, -1), vec3(0, 0.5F, 2)});
  input.boxes = boxes_of(input.triangles);
  return input;
}

TEST(SpatialBuilder, IsATreeWhosePartsCoverEveryTriangle) {
  const Input input = make_input(100);
  const Bvh bvh = build_bvh("spatial", input.get());
  test::expect_tree(bvh);
  ASSERT_GT(bvh.references.size(), input.boxes.size() * 5 / 4) << "nothing to test";
  ASSERT_LE(bvh.references.size(), input.boxes.size() * kMaxReferencesPerPrimitive);

  std::vector<std::vector<Polygon>> uncovered;
  for (const TriangleOfInput& t : input.triangles) uncovered.push_back({{dvec3(t[0]), dvec3(t[1]), dvec3(t[2])}});
  for (const BvhNode& node : bvh.nodes) {
    for (uint32_t k = node.first; k < node.first + node.count; ++k) {
      std::vector<Polygon>& left = uncovered[bvh.references[k]];
      left = subtract(left, node.bounds);
    }
  }
  for (size_t i = 0; i < uncovered.size(); ++i) {
    const TriangleOfInput& t = input.triangles[i];
    const double whole = area_of({dvec3(t[0]), dvec3(t[1]), dvec3(t[2])});
    double area = 0.0;
    for (const Polygon& polygon : uncovered[i]) area += area_of(polygon);
    // If a box were too small by one float's rounding, an area of about 1e-8 would be uncovered.
    EXPECT_LE(area, 1e-12 * whole) << "triangle " << i;
  }
}

TEST(SpatialBuilder, IsTheSameForAnyNumberOfThreads) {
  // The input is larger than one that is built on one thread.
  const Input input = make_input(650);
  const Bvh expected = build_bvh("spatial", input.get(), {.thread_count = 1});
  for (const unsigned thread_count : {2U, 7U}) {
    const Bvh bvh = build_bvh("spatial", input.get(), {.thread_count = thread_count});
    EXPECT_EQ(bvh.references, expected.references);
    ASSERT_EQ(bvh.nodes.size(), expected.nodes.size());
    EXPECT_EQ(std::memcmp(bvh.nodes.data(), expected.nodes.data(), bvh.nodes.size() * sizeof(BvhNode)), 0);
  }
}

TEST(SpatialBuilder, CostsLessThanSahOnPipes) {
  const Input input = make_input(100);
  const double spatial = measure_bvh("spatial", build_bvh("spatial", input.get())).sah_cost;
  EXPECT_LT(spatial, 0.8 * measure_bvh("sah", build_bvh("sah", input.get())).sah_cost);
}

}  // namespace
}  // namespace promin
