// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_instances.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <random>

#include "bvh/bvh_file.h"
#include "bvh/read_node.h"
#include "core/file.h"
#include "device_scene/pack_scene.h"
#include "measure/meshes.h"
#include "measure/random.h"
#include "support/bvh_bytes.h"
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
  const UnsetVector<Node> records = packed.upper->make_records(packed.instance_order);
  std::map<uint32_t, world::InstanceMap> map_of_order;
  for (const world::Instance& instance : flat.instances) {
    map_of_order[packed.numbers.first_order[instance.object]] = instance.map;
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
        const Node& record = records[(child & CHILD_INSTANCE_INDEX) - packed.first_instance];
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
  const auto records_of = [](const PackedScene& from, const UpperNodes& nodes) {
    std::vector<Node> records(nodes.record_count());
    from.upper->put_records(nodes.order, records);
    return records;
  };
  EXPECT_TRUE(are_equal(records_of(packed, upper), records_of(fresh, same)));
  EXPECT_EQ(upper.nodes.size(), same.nodes.size());
  EXPECT_EQ(center_and_radius(upper.bounds), fresh.tree_bounds);
  EXPECT_NE(fresh.tree_bounds, packed.tree_bounds);
  EXPECT_EQ(upper.stats.sah_cost, same.stats.sah_cost);
  EXPECT_EQ(packed.upper->instance_count(), 300U);
}

/// The records contain everything that is needed to move instances.
TEST(PackInstancesTest, InstancesAreRestoredFromTheirRecords) {
  Scene scene = make_instanced(make_wavy_mesh(500), 300);
  scene.objects.insert(scene.objects.begin() + 5, Object());
  scene.objects[9].world_from_object[0] *= -1.0;
  const PackedScene packed = pack_instanced(scene);
  const UnsetVector<Node> records = packed.upper->make_records(packed.instance_order);
  const UpperNodes before = packed.upper->build();
  packed.upper->forget();
  EXPECT_TRUE(packed.upper->is_forgotten());
  EXPECT_EQ(packed.upper->instance_count(), 0U);
  packed.upper->restore(records, packed.numbers.first_order);
  EXPECT_FALSE(packed.upper->is_forgotten());
  const UpperNodes after = packed.upper->build();
  EXPECT_EQ(after.order, before.order);
  EXPECT_EQ(std::memcmp(&after.root, &before.root, sizeof(Node)), 0);
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(after.nodes)), std::as_bytes(std::span(before.nodes))));
  const UnsetVector<Node> again = packed.upper->make_records(after.order);
  EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(again)), std::as_bytes(std::span(records))));
  EXPECT_FALSE(packed.upper->mesh_box(299).is_empty());
  EXPECT_TRUE(packed.upper->mesh_box(5).is_empty());
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

/// Returns the end of the section that begins at `at`, by the counts of its header.
size_t end_of_section(const Bytes& bytes, size_t at) {
  uint32_t nodes = 0;
  uint32_t references = 0;
  std::memcpy(&nodes, bytes.data() + at + kNodeCountPlace, sizeof nodes);
  std::memcpy(&references, bytes.data() + at + kReferenceCountPlace, sizeof references);
  return at + kHeaderSize + nodes * sizeof(Node) + references * sizeof(uint32_t);
}

class InstancesFileTest : public TempFolder {
 protected:
  static world::Scene flatten(const Scene& scene, Instancing instancing = Instancing::kAll) {
    return world::flatten(scene, world::Purpose::kHits, instancing);
  }
  void build(const Scene& scene, std::string_view builder, Instancing instancing = Instancing::kAll) const {
    std::vector<TreeView> views;
    const std::vector<GeometryTree> trees = build_scene_trees(flatten(scene, instancing), builder, {});
    for (const GeometryTree& tree : trees) views.push_back(tree.view());
    write_bvh_file(file_, views);
  }

  /// Returns a scene with balls beside instances of two meshes.
  static Scene make_mixed(float size = 1.0F) {
    Scene scene = make_instanced(make_wavy_mesh(500), 20);
    for (int i = 0; i < 30; ++i) {
      scene.add("ball", Sphere{}, 0).world_from_object[3] = dvec4(3.0 * i, 50.0, 0.0, 1.0);
    }
    Mesh other = make_wavy_mesh(300);
    other.positions[0] *= size;
    scene.add("other", other, 0);
    add_instances(scene, static_cast<uint32_t>(scene.objects.size() - 1), std::vector<dmat4>(3, dmat4(1.0)));
    return scene;
  }

  std::filesystem::path file_ = folder_ / "scene.pbvh";
};

/// The nodes of meshes, the primitives and the numbers are the same, whether trees are built or read.
TEST_F(InstancesFileTest, HasATreeForEachGeometry) {
  const Scene scene = make_mixed();
  for (const std::string_view builder : builder_names()) {
    build(scene, builder);
    EXPECT_EQ(BvhFile(file_).trees().size(), 3U);
    const PackedScene built = pack_scene(flatten(scene), builder);
    const PackedScene read = pack_scene_with(file_, flatten(scene));
    ASSERT_EQ(read.primitives.size(), built.primitives.size()) << builder;
    EXPECT_EQ(std::memcmp(read.primitives.data(), built.primitives.data(), built.primitives.size() * sizeof(Primitive)),
              0);
    EXPECT_EQ(read.numbers.first_order, built.numbers.first_order);
    EXPECT_EQ(read.tree_bounds, built.tree_bounds);
    EXPECT_EQ(read.instance_count, 24U);
    EXPECT_EQ(read.bvh.builder, builder);
    EXPECT_EQ(read.bvh.leaves, built.bvh.leaves);
    EXPECT_TRUE(built.is_tree_built);
    EXPECT_FALSE(read.is_tree_built);
    const TreeFaults faults = find_tree_faults(BvhFile(file_), flatten(scene));
    EXPECT_EQ(faults.count, 0U) << faults.first;
  }
}

TEST_F(InstancesFileTest, BelongsToGeometriesAndNotToInstances) {
  build(make_mixed(), "sah");
  Scene more = make_mixed();
  add_instances(more, 0, std::vector<dmat4>(40, dmat4(2.0)));
  EXPECT_EQ(pack_scene_with(file_, flatten(more)).instance_count, 64U);
  const auto fails_with = [&](const Scene& scene, Instancing instancing = Instancing::kAll) {
    return message_of([&] { static_cast<void>(pack_scene_with(file_, flatten(scene, instancing))); });
  };
  EXPECT_THAT(fails_with(make_mixed(1.5F)), HasProblem("bvh.file.stale"));
  EXPECT_THAT(fails_with(make_mixed(), Instancing::kNone), HasProblem("bvh.file.stale"));
  build(make_mixed(), "sah", Instancing::kNone);
  EXPECT_THAT(fails_with(make_mixed()), HasProblem("bvh.file.stale"));
  EXPECT_EQ(fails_with(make_mixed(), Instancing::kNone), "");
}

TEST_F(InstancesFileTest, FaultsOfAnySectionAreFound) {
  const Scene scene = make_mixed();
  std::vector<GeometryTree> trees = build_scene_trees(flatten(scene), "sah", {});
  // A box of the last mesh becomes smaller.
  trees[2].nodes[0].hi.x -= 1;
  trees[2].nodes[0].lo.w -= 1;
  std::vector<TreeView> views;
  for (const GeometryTree& tree : trees) views.push_back(tree.view());
  write_bvh_file(file_, views);
  const TreeFaults faults = find_tree_faults(BvhFile(file_), flatten(scene));
  EXPECT_GT(faults.count, 0U);
  EXPECT_THAT(faults.first, testing::StartsWith("in the mesh of object 51, "));
}

TEST_F(InstancesFileTest, FlippedBitsAndOtherLengthsAreRefused) {
  build(make_instanced(make_wavy_mesh(20), 3), "sah");
  const std::vector<std::byte> good = read_file(file_);
  const auto refusal = [&](const std::vector<std::byte>& bytes) {
    std::filesystem::remove(file_);
    write_file(file_, {bytes});
    return message_of([&] { const BvhFile file(file_); });
  };
  ASSERT_EQ(refusal(good), "");
  for (size_t i = 0; i < 8 * good.size(); i += 61) {
    std::vector<std::byte> flipped = good;
    flipped[i / 8] ^= std::byte{1} << (i % 8);
    ASSERT_NE(refusal(flipped), "") << "bit " << i;
  }
  const size_t end = end_of_section(good, 0);
  ASSERT_LT(end, good.size());
  for (const size_t size : {size_t{1}, kHeaderSize, end - 1, end + 1, end + 100, good.size() - 1}) {
    EXPECT_THAT(refusal({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), HasProblem("bvh.file.short"))
        << size;
  }
  EXPECT_EQ(refusal({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(end)}), "")
      << "the first section alone is a file, which has too few trees for the scene";
  std::vector<std::byte> foreign = good;
  foreign[(end + 63) / 64 * 64] = std::byte{0};
  EXPECT_THAT(refusal(foreign), HasProblem("bvh.file.damaged"));
  std::vector<std::byte> longer = good;
  longer.insert(longer.end(), 100, std::byte{0});
  EXPECT_THAT(refusal(longer), HasProblem("bvh.file.short"));
}

/// Expects that a traversal finds everything within the buffers, and that no box of the upper level is NaN.
void expect_scene_is_traversable(const PackedScene& packed) {
  size_t steps = 0;
  std::vector<uint32_t> open = {0};
  for (const MeshRange& range : packed.mesh_ranges) open.push_back(range.root);
  while (!open.empty()) {
    ASSERT_LE(++steps, packed.nodes.size()) << "runs in a circle";
    const Node& node = packed.nodes[open.back()];
    open.pop_back();
    for (uint32_t i = 0; i < child_count(node); ++i) {
      const uint32_t word = node.children[static_cast<int>(i)];
      const NodeChild child = child_of(node, i);
      if ((word & CHILD_INSTANCE_MASK) == CHILD_IS_INSTANCE) {
        ASSERT_LE((word & CHILD_INSTANCE_INDEX) + INSTANCE_RECORDS,
                  packed.nodes.size() + INSTANCE_RECORDS * packed.instance_order.size());
      } else if (child.kind == ChildKind::kLeaf) {
        ASSERT_LE(child.first + child.count, packed.references.size());
      } else {
        ASSERT_LT(child.first, packed.nodes.size());
        open.push_back(child.first);
      }
    }
  }
  for (const float value : {packed.tree_bounds.x, packed.tree_bounds.y, packed.tree_bounds.z, packed.tree_bounds.w}) {
    ASSERT_TRUE(std::isfinite(value));
  }
}

/// A file whose sections have correct checksums is either refused or harmless, for any contents.
TEST_F(InstancesFileTest, RandomFaultsOfSectionsAreRefusedOrHarmless) {
  const world::Scene scene = flatten(make_mixed());
  build(make_mixed(), "sah");
  const Bytes good = read_file(file_);
  std::vector<std::pair<size_t, size_t>> sections;
  for (size_t at = 0; at < good.size(); at = (sections.back().second + 63) / 64 * 64) {
    sections.emplace_back(at, end_of_section(good, at));
  }
  ASSERT_EQ(sections.size(), 3U);
  ASSERT_EQ(sections.back().second, good.size());
  std::mt19937 random(1);
  std::map<std::string, size_t> codes;
  for (int run = 0; run < 700; ++run) {
    Bytes bytes = good;
    const auto [at, end] = sections[random() % sections.size()];
    const size_t nodes = (end - at - kHeaderSize) / (sizeof(Node) + sizeof(uint32_t));
    // A third of the changes affects the header, a third the frames and the children of nodes, and a third any byte.
    const size_t place = run % 3 == 0   ? random() % kHeaderSize
                         : run % 3 == 1 ? kHeaderSize + sizeof(Node) * (random() % nodes) + (48 + random() % 32) % 64
                                        : random() % (end - at);
    // All bits of a byte make an exponent of infinity or NaN, and counts that are much too large.
    bytes[at + place] = run % 2 == 0 ? std::byte{0xFF} : bytes[at + place] ^ (std::byte{1} << (random() % 8));
    // If the counts are different and possible, the checksum covers the bytes that they declare.
    const size_t declared = end_of_section(bytes, at);
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto to = bytes.begin() + static_cast<std::ptrdiff_t>(declared <= bytes.size() ? declared : end);
    std::ranges::copy(sealed(Bytes(from, to)), from);
    std::filesystem::remove(file_);
    write_file(file_, {bytes});
    PackedScene packed;
    const std::string refusal = message_of([&] { packed = pack_scene_with(file_, scene); });
    ++codes[refusal.substr(0, refusal.find(' '))];
    if (refusal.empty()) expect_scene_is_traversable(packed);
    if (HasFatalFailure()) return;
  }
  // Every check is reached.
  for (const char* code : {"", "bvh.file.short", "bvh.file.damaged", "bvh.file.version", "bvh.file.header",
                           "bvh.file.tree", "bvh.file.stale"}) {
    EXPECT_GT(codes[code], 3U) << code;
  }
}

/// A tree whose boxes are NaN in a file with a correct checksum leads to no box of the upper level that is NaN.
TEST_F(InstancesFileTest, BoxesThatAreNoNumbersBecomeThoseOfThePrimitives) {
  const Scene scene = make_mixed();
  std::vector<GeometryTree> trees = build_scene_trees(flatten(scene), "sah", {});
  std::vector<TreeView> views;
  for (GeometryTree& tree : trees) {
    for (Node& node : tree.nodes) node.frame = uvec4(uvec3(0x7FC00000U), node.frame.w);
    views.push_back(tree.view());
  }
  write_bvh_file(file_, views);
  const PackedScene packed = pack_scene_with(file_, flatten(scene));
  expect_scene_is_traversable(packed);
  const UpperNodes upper = packed.upper->build();
  const auto check = [](const Node& node) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(std::isfinite(std::bit_cast<float>(node.frame[axis])));
  };
  check(upper.root);
  for (const Node& node : upper.nodes) check(node);
  EXPECT_EQ(packed.tree_bounds, pack_scene(flatten(scene), "sah").tree_bounds);
}

/// A file may have more trees than the scene needs, in any order. A file that ends before a tree of the scene belongs
/// to another scene.
TEST_F(InstancesFileTest, TreesAreFoundByTheirGeometry) {
  const world::Scene scene = flatten(make_mixed());
  const std::vector<GeometryTree> trees = build_scene_trees(scene, "sah", {});
  const std::vector<GeometryTree> others = build_scene_trees(flatten(make_mixed(1.5F)), "sah", {});
  const auto refusal = [&](const std::vector<TreeView>& views) {
    write_bvh_file(file_, views);
    return message_of([&] { static_cast<void>(pack_scene_with(file_, scene)); });
  };
  EXPECT_EQ(refusal({trees[2].view(), others[2].view(), trees[0].view(), trees[1].view()}), "");
  for (size_t missing = 0; missing < trees.size(); ++missing) {
    std::vector<TreeView> views = {others[2].view()};
    for (size_t i = 0; i < trees.size(); ++i) {
      if (i != missing) views.push_back(trees[i].view());
    }
    EXPECT_THAT(refusal(views), HasProblem("bvh.file.stale")) << missing;
  }
}

/// Meshes count for the decision to share trees.
TEST_F(InstancesFileTest, ProcessesShareTheTreesOfMeshes) {
  const world::Scene flat = flatten(make_instanced(make_wavy_mesh(kLeastShared + 10000), 3));
  const PackedScene first = pack_scene_sharing(file_, flat, "median");
  ASSERT_EQ(BvhFile(file_).trees().size(), 2U);
  const std::filesystem::file_time_type stamp = std::filesystem::last_write_time(file_);
  const PackedScene second = pack_scene_sharing(file_, flat, "median");
  EXPECT_EQ(std::filesystem::last_write_time(file_), stamp);
  ASSERT_EQ(second.primitives.size(), first.primitives.size());
  EXPECT_EQ(std::memcmp(second.primitives.data(), first.primitives.data(), first.primitives.size() * sizeof(Primitive)),
            0);
  EXPECT_TRUE(second.warnings.empty());
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 4);
  const PackedScene third = pack_scene_sharing(file_, flat, "median");
  ASSERT_EQ(third.warnings.size(), 1U);
  EXPECT_EQ(BvhFile(file_).trees().size(), 2U);
}

}  // namespace
}  // namespace promin
