// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/cut_triangles.h"

#include <gtest/gtest.h>

#include "device_scene/pack_scene.h"

namespace promin {
namespace {

/// The corners of triangle 0 lie in a line. Triangles 1 and 2 share its short sides. The corner in the middle of its
/// long side lies on the edge of triangle 3. Triangle 4 touches no other triangle.
Mesh make_mesh() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {1, 2, 0}, {1, -2, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 4, 1}, {1, 4, 2}, {2, 3, 0}, {3, 4, 5}};
  return mesh;
}

world::Scene scene_from(std::initializer_list<world::Shape> shapes) {
  world::Scene scene;
  scene.materials.resize(1);
  for (const world::Shape& shape : shapes) scene.objects.push_back({"", shape, 0});
  return scene;
}

std::vector<TrianglePart> parts_of(const world::Scene& scene, const Mesh& mesh, uint32_t triangle) {
  std::vector<TrianglePart> parts;
  CutTriangles(scene).cut(mesh, triangle, parts);
  return parts;
}

TEST(CutTriangles, CutsTheNeighbourAtTheCornerOnItsEdge) {
  const Mesh mesh = make_mesh();
  const world::Scene scene = scene_from({mesh});
  for (const uint32_t whole : {1U, 2U, 4U}) EXPECT_EQ(parts_of(scene, mesh, whole).size(), 1U);
  const std::vector<TrianglePart> parts = parts_of(scene, mesh, 3);
  ASSERT_EQ(parts.size(), 2U);
  for (const TrianglePart& part : parts) {
    const vec3 normal = glm::cross(part[1].position - part[0].position, part[2].position - part[0].position);
    EXPECT_GT(normal.z, 0.0F) << "wound as the whole";
    for (const PartCorner& corner : part) {
      const dvec2 w = corner.weights;
      const dvec3 place = (1.0 - w.x - w.y) * dvec3(4, 0, 0) + w.x * dvec3(1, 2, 0);
      EXPECT_LE(glm::distance(place, dvec3(corner.position)), 1e-15);
    }
  }
}

TEST(CutTriangles, CutsAcrossTrianglesInOneLine) {
  // Two triangles whose corners lie in a line share their long side; the middle corner of each lies on an edge of a
  // neighbour.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 2, 0}, {1, -2, 0}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 1}, {1, 4, 3}, {0, 2, 5}, {2, 3, 5}};
  const world::Scene scene = scene_from({mesh});
  EXPECT_EQ(parts_of(scene, mesh, 2).size(), 1U);
  EXPECT_EQ(parts_of(scene, mesh, 3).size(), 2U) << "from 1 to 4 past 2";
  EXPECT_EQ(parts_of(scene, mesh, 4).size(), 2U) << "from 0 to 2 past 1";
  EXPECT_EQ(parts_of(scene, mesh, 5).size(), 1U);
}

TEST(CutTriangles, NumbersStayThoseOfTheScene) {
  Mesh mesh = make_mesh();
  mesh.normals.assign(mesh.positions.size(), vec3(0, 0, 1));
  const PackedScene packed =
      pack_scene(scene_from({world::Sphere(), mesh, world::NotDrawn(), mesh, world::Plane()}), "sah");
  // The scene has one sphere, two objects of five triangles and a plane. In each object one triangle is cut in two and
  // one is not packed.
  ASSERT_EQ(packed.primitives.size(), 12U);
  const std::vector<PrimitiveId> expected = {{0, 0}, {1, 0}, {1, 1}, {1, 2}, {1, 3}, {1, 3}, {1, 4},
                                             {3, 0}, {3, 1}, {3, 2}, {3, 3}, {3, 3}, {3, 4}, {4, 0}};
  for (uint32_t order = 0; order < expected.size(); ++order) {
    const PrimitiveId id = primitive_of_order(packed.numbers, order);
    EXPECT_EQ(id.object, expected[order].object) << order;
    EXPECT_EQ(id.primitive, expected[order].primitive) << order;
  }
  // The first part keeps the third corner. The third corner of the second part is the cut, 1/4 of the way from the
  // third corner to the first.
  EXPECT_EQ(weights_of_triangle(packed.numbers, 2, 1, vec2(0.25F, 0.5F)), vec2(0.25F, 0.5F));
  for (const uint32_t order : {4U, 5U, 10U, 11U}) {
    const vec2 third = weights_of_triangle(packed.numbers, order, expected[order].object, vec2(0, 1));
    EXPECT_EQ(third, order % 2 == 0 ? vec2(0, 1) : vec2(0, 0.75F)) << order;
  }
}

}  // namespace
}  // namespace promin
