// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_instances.h"

#include <gmock/gmock.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "bvh/read_node.h"
#include "device_scene/pack_scene.h"
#include "measure/meshes.h"
#include "measure/random.h"
#include "support/problems.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

using measure::Random;
using namespace layout;

/// Returns a scene with this number of instances of a mesh, and a ball.
Scene make_instanced(const Mesh& mesh, size_t instances) {
  Random random(7);
  Scene scene;
  scene.materials.resize(2);
  scene.add("mesh", mesh, 1);
  scene.add("ball", Sphere());
  std::vector<dmat4> maps;
  for (size_t i = 1; i < instances; ++i) {
    dmat4 map = glm::mat4_cast(glm::angleAxis(random.uniform(-3.0, 3.0), random.direction()));
    map[0] *= i % 3 == 0 ? -1.0 : 2.0;
    map[3] = dvec4(100.0 * random.direction(), 1.0);
    maps.push_back(map);
  }
  add_instances(scene, 0, maps);
  return scene;
}

Mesh make_wavy_mesh(uint32_t triangles) {
  return std::get<Mesh>(measure::make_wavy_sphere(triangles).objects[0].shape);
}

PackedScene pack_instanced(const Scene& scene, unsigned threads = 0) {
  return pack_scene(world::flatten(scene, world::Purpose::kHits, Instancing::kAll), "sah", {.thread_count = threads});
}

TEST(PackInstancesTest, AnInstanceTakesFewBytes) {
  const Mesh mesh = make_wavy_mesh(1000);
  const uint64_t one = pack_instanced(make_instanced(mesh, 2)).size_bytes();
  const uint64_t many = pack_instanced(make_instanced(mesh, 2002)).size_bytes();
  EXPECT_LE(many - one, 2000U * 160U);
  const PackedScene packed = pack_instanced(make_instanced(mesh, 2002));
  EXPECT_EQ(packed.instance_count, 2002U);
  EXPECT_EQ(packed.shared_triangle_count, mesh.triangles.size());
  EXPECT_EQ(packed.primitive_count(), 2002U * mesh.triangles.size() + 1);
}

TEST(PackInstancesTest, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene = make_instanced(make_wavy_mesh(500), 1000);
  const PackedScene one = pack_instanced(scene, 1);
  const PackedScene two = pack_instanced(scene, 2);
  ASSERT_EQ(one.nodes.size(), two.nodes.size());
  EXPECT_EQ(std::memcmp(one.nodes.data(), two.nodes.data(), one.nodes.size() * sizeof(Node)), 0);
}

/// Every corner of each instance lies in the boxes of the upper level that lead to it.
TEST(PackInstancesTest, BoxesContainTheInstances) {
  const Mesh mesh = make_wavy_mesh(500);
  const Scene scene = make_instanced(mesh, 40);
  const world::Scene flat = world::flatten(scene, world::Purpose::kHits, Instancing::kAll);
  const PackedScene packed = pack_instanced(scene);
  std::map<uint32_t, world::InstanceMap> map_of_order;
  for (const world::Instance& instance : flat.instances) {
    map_of_order[packed.numbers.first_order[instance.object]] = world::map_of(instance);
  }
  size_t found = 0;
  std::vector<std::pair<uint32_t, ExactBounds>> open = {{0, ExactBounds()}};
  while (!open.empty()) {
    const auto [node, outer] = open.back();
    open.pop_back();
    for (uint32_t i = 0; i < child_count(packed.nodes[node]); ++i) {
      const uint32_t child = packed.nodes[node].children[static_cast<int>(i)];
      ExactBounds box = child_box(packed.nodes[node], i);
      box.lo = glm::max(box.lo, outer.lo);
      box.hi = glm::min(box.hi, outer.hi);
      if ((child & CHILD_IS_LEAF) == 0) {
        open.emplace_back(child, box);
      } else if ((child & CHILD_INSTANCE_MASK) == CHILD_IS_INSTANCE) {
        ++found;
        const Node& record = packed.nodes[child & CHILD_INSTANCE_INDEX];
        const world::InstanceMap& map = map_of_order.at(record.children.z);
        const dmat3 turn = glm::inverse(dmat3(map.object_from_world));
        for (const vec3& p : mesh.positions) {
          const dvec3 placed = dvec3(map.origin) + turn * dvec3(p);
          EXPECT_TRUE(glm::all(glm::lessThanEqual(box.lo, placed)) && glm::all(glm::lessThanEqual(placed, box.hi)));
        }
      }
    }
  }
  EXPECT_EQ(found, 40U);
}

/// Moved instances have the records, the nodes and the bounds of a new tree.
TEST(PackInstancesTest, MovedInstancesHaveANewUpperLevel) {
  Scene scene = make_instanced(make_wavy_mesh(500), 300);
  for (int i = 0; i < 400; ++i) scene.add("", Sphere{.radius = 0.1F}, 0, glm::translate(dmat4(1.0), dvec3(i, 3, 0)));
  const PackedScene packed = pack_instanced(scene);
  std::vector<std::pair<uint32_t, dmat4>> moved;
  for (const uint32_t object : {7U, 0U, 250U}) {
    scene.objects[object].world_from_object[3] += dvec4(0.0, 500.0, 0.0, 0.0);
    moved.emplace_back(object, scene.objects[object].world_from_object);
  }
  packed.upper->move(moved);
  const UpperNodes upper = packed.upper->build();
  const PackedScene fresh = pack_instanced(scene);
  const UpperNodes same = fresh.upper->build();
  const auto are_equal = [](std::span<const Node> a, std::span<const Node> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
  };
  EXPECT_TRUE(are_equal(upper.records, same.records));
  EXPECT_EQ(upper.nodes.size(), same.nodes.size());
  EXPECT_EQ(center_and_radius(upper.bounds), fresh.tree_bounds);
  EXPECT_NE(fresh.tree_bounds, packed.tree_bounds);
  EXPECT_EQ(upper.stats.sah_cost, same.stats.sah_cost);
  EXPECT_EQ(packed.upper->instance_count(), 300U);
}

/// Numbers of parts count within the mesh of an instance.
TEST(PackInstancesTest, PartsOfTrianglesBelongToTheirTriangle) {
  // The middle corner of the second triangle, whose corners lie on a line, cuts the first one.
  Mesh mesh;
  mesh.positions = {vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, -1, 0)};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {4, 3, 0}};
  const PackedScene packed = pack_instanced(make_instanced(mesh, 3));
  const PrimitiveNumbers& numbers = packed.numbers;
  ASSERT_EQ(numbers.mesh_parts.at(0).size(), 2U);
  for (const uint32_t object : {0U, 2U, 3U}) {
    const uint32_t first = numbers.first_order[object];
    std::vector<uint32_t> primitives;
    for (uint32_t order = first; order < numbers.first_order[object + 1]; ++order) {
      const PrimitiveId id = primitive_of_order(numbers, order);
      EXPECT_EQ(id.object, object);
      primitives.push_back(id.primitive);
    }
    EXPECT_THAT(primitives, testing::ElementsAre(0, 0, 1, 2));
    EXPECT_EQ(weights_of_triangle(numbers, first + 3, object, vec2(0.25F, 0.5F)), vec2(0.25F, 0.5F));
    EXPECT_NE(weights_of_triangle(numbers, first + 1, object, vec2(0.25F, 0.5F)), vec2(0.25F, 0.5F));
  }
}

TEST(PackInstancesTest, SceneWithMorePrimitivesThanNumbersHasOneNumberForEachInstance) {
  const PackedScene packed = pack_instanced(make_instanced(make_wavy_mesh(50000), 90000));
  EXPECT_TRUE(packed.numbers.are_instances_whole);
  EXPECT_EQ(packed.numbers.first_order.back(), 90001U);
  const PrimitiveId id = primitive_of_order(packed.numbers, 1234);
  EXPECT_EQ(id.object, 1234U);
  EXPECT_EQ(id.primitive, 0U);
}

TEST(PackInstancesTest, AFileOfATreeIsRefused) {
  const world::Scene flat =
      world::flatten(make_instanced(make_wavy_mesh(100), 3), world::Purpose::kHits, Instancing::kAll);
  EXPECT_THAT([&] { static_cast<void>(pack_scene_with("a.pbvh", flat)); }, FailsWith("bvh.instances"));
}

}  // namespace
}  // namespace promin
