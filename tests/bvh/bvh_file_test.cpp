// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/bvh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "bvh/read_node.h"
#include "core/file.h"
#include "core/hash.h"
#include "device_scene/pack_scene.h"
#include "gpu/test_scenes.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "support/bvh_bytes.h"
#include "support/scene_files.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using layout::Node;
using testing::HasSubstr;

/// A tree that owns its data, so that tests can put faults into it.
struct Tree {
  std::vector<Node> nodes;
  std::vector<uint32_t> references;
  TreeView view;

  explicit Tree(const TreeView& source)
      : nodes(source.nodes.begin(), source.nodes.end()),
        references(source.references.begin(), source.references.end()),
        view(source) {}

  TreeView show() {
    view.nodes = nodes;
    view.references = references;
    return view;
  }
};

uint32_t leaf_of(uint32_t first, uint32_t count) {
  return layout::CHILD_IS_LEAF | ((count - 1) << layout::CHILD_COUNT_SHIFT) | first;
}

void set_child_count(Node& node, uint32_t count) {
  node.frame.w = (node.frame.w & 0x00FFFFFF) | (count << 24);
}

/// Visits everything that is reachable from the nodes, as a device does in the worst case. Fails the test if an access
/// lies outside a buffer or the stack.
void expect_traversable(const TreeView& tree) {
  struct Open {
    uint32_t node;
    uint32_t nodes_above;
  };
  std::vector<Open> open = {{0, 0}};
  for (size_t steps = 0; !open.empty(); ++steps) {
    ASSERT_LE(steps, tree.nodes.size()) << "runs in a circle";
    const auto [index, nodes_above] = open.back();
    open.pop_back();
    ASSERT_LT(index, tree.nodes.size());
    ASSERT_LE(nodes_above, tree.stack_size);
    for (uint32_t i = 0; i < layout::NODE_WIDTH; ++i) {
      const NodeChild child = child_of(tree.nodes[index], i);
      if (child.kind == ChildKind::kNode) open.push_back({child.first, nodes_above + 1});
      if (child.kind != ChildKind::kLeaf) continue;
      for (uint32_t slot = child.first; slot < child.first + child.count; ++slot) {
        ASSERT_LT(slot, tree.references.size());
        ASSERT_LT(tree.references[slot], tree.primitive_count);
      }
    }
  }
}

class BvhFileTest : public TempFolder {
 protected:
  BvhFileTest() { write_bvh_file(file_, packed_.tree()); }

  std::string refusal() const {
    return message_of([&] { const BvhFile file(file_); });
  }
  std::string refusal(const Bytes& bytes) const {
    // The file is new each time, because some file systems flush when a file is truncated.
    fs::remove(file_);
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return refusal();
  }
  std::string refusal(Tree& tree) const {
    write_bvh_file(file_, tree.show());
    return refusal();
  }

  fs::path file_ = folder_ / "tree.pbvh";
  world::Scene scene_ = test::make_scene_of_everything(30);
  PackedScene packed_ = pack_scene(scene_, "median");
};

template <typename T>
bool has_same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

void expect_same(const PackedScene& a, const PackedScene& b) {
  EXPECT_TRUE(has_same_bytes(a.tree().nodes, b.tree().nodes));
  EXPECT_TRUE(has_same_bytes<layout::Primitive>(a.primitives, b.primitives));
  EXPECT_EQ(a.references, b.references);
  EXPECT_TRUE(has_same_bytes<layout::SurfaceRecord>(a.surfaces.surfaces, b.surfaces.surfaces));
  EXPECT_EQ(a.surfaces.vertices.normals, b.surfaces.vertices.normals);
  EXPECT_EQ(a.surfaces.vertices.colors, b.surfaces.vertices.colors);
  EXPECT_EQ(a.stack_size, b.stack_size);
  EXPECT_EQ(a.size_bytes(), b.size_bytes());
  EXPECT_EQ(a.bvh.builder, b.bvh.builder);
  EXPECT_EQ(a.bvh.nodes, b.bvh.nodes);
  EXPECT_EQ(a.bvh.leaves, b.bvh.leaves);
  EXPECT_EQ(a.bvh.depth, b.bvh.depth);
  EXPECT_EQ(a.bvh.max_leaf_size, b.bvh.max_leaf_size);
  EXPECT_EQ(a.bvh.sah_cost, b.bvh.sah_cost);
  EXPECT_EQ(a.bvh.bytes, b.bvh.bytes);
}

TEST_F(BvhFileTest, HoldsWhatWasBuilt) {
  const std::vector<fs::path> files = scene_files(PROMIN_SCENES_DIR);
  EXPECT_GT(files.size(), 10U);
  for (const fs::path& scene_file : files) {
    const world::Scene scene = world::flatten(load_scene(scene_file));
    for (const std::string_view builder : builder_names()) {
      SCOPED_TRACE(scene_file.string() + " " + std::string(builder));
      const PackedScene built = pack_scene(scene, builder);
      write_bvh_file(file_, built.tree());
      expect_same(pack_scene_with(file_, scene), built);
    }
  }
}

TEST_F(BvhFileTest, ATreeOfNothingIsATree) {
  world::Scene planes;
  planes.materials.resize(1);
  planes.objects = {{"", world::Plane{}, 0}};
  const PackedScene built = pack_scene(planes, "sah");
  write_bvh_file(file_, built.tree());
  expect_same(pack_scene_with(file_, planes), built);
}

TEST_F(BvhFileTest, EveryFlippedBitIsRefused) {
  const Bytes bytes = read_file(file_);
  ASSERT_LT(bytes.size(), 4000U);
  for (size_t i = 0; i < 8 * bytes.size(); ++i) {
    Bytes flipped = bytes;
    flipped[i / 8] ^= std::byte{1} << (i % 8);
    ASSERT_NE(refusal(flipped), "") << "bit " << i % 8 << " of byte " << i / 8;
  }
}

TEST_F(BvhFileTest, EveryOtherLengthIsRefused) {
  Bytes bytes = read_file(file_);
  bytes.push_back(std::byte{0});
  EXPECT_THAT(refusal(bytes), HasProblem("bvh.file.short"));
  bytes.pop_back();
  while (!bytes.empty()) {
    bytes.pop_back();
    ASSERT_NE(refusal(bytes), "") << "length " << bytes.size();
  }
}

TEST_F(BvhFileTest, ForeignFilesAreRefusedInASentenceThatHelps) {
  const Bytes good = read_file(file_);
  EXPECT_THAT(refusal(with(good, 0, 'P')), HasProblem("bvh.file.kind " + file_.string() + ":"));
  EXPECT_THAT(refusal(sealed(with(good, kByteOrderPlace, 0x04030201))), HasProblem("bvh.file.version"));
  EXPECT_THAT(refusal(sealed(with(good, kVersionPlace, 7))), HasProblem("bvh.file.version 7"));
  EXPECT_THAT(refusal(sealed(with(good, kLayoutHashPlace, uint64_t{5}))), HasProblem("bvh.file.version layout"));
  EXPECT_THAT(refusal(with(good, kHeaderSize + 3, '!')), HasProblem("bvh.file.damaged"));
  EXPECT_THAT(refusal(Bytes(good.begin(), good.begin() + 100)), HasProblem("bvh.file.short"));
  EXPECT_THAT(refusal(sealed(with(good, kBuilderPlace, '\x1B'))), HasProblem("bvh.file.header"));
  EXPECT_THAT(refusal(sealed(with(good, kBuilderPlace, std::array<uint64_t, 5>{~0U, ~0U, ~0U, ~0U, ~0U}))),
              HasProblem("bvh.file.header"));
  EXPECT_THAT(refusal(Bytes()), HasProblem("file.empty"));
  EXPECT_THAT(message_of([&] { const BvhFile file(folder_); }), HasProblem("file.kind"));
  EXPECT_THAT(message_of([&] { const BvhFile file(folder_ / "none"); }), HasProblem("file.missing"));
}

TEST_F(BvhFileTest, CountsBeyondTheFileAreRefused) {
  const Bytes good = read_file(file_);
  for (const size_t place : {kNodeCountPlace, kReferenceCountPlace, kPrimitiveCountPlace}) {
    for (const uint32_t count : {0U, 1U, 0x02000000U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
      EXPECT_NE(refusal(sealed(with(good, place, count))), "") << place << " " << count;
    }
  }
}

/// A fault in a tree, and a part of the sentence with which a file with this fault and the right checksum is refused.
struct HostileTree {
  const char* name;
  void (*spoil)(Tree& tree);
  const char* sentence;
};

std::ostream& operator<<(std::ostream& out, const HostileTree& tree) {
  return out << tree.name;
}

/// Returns the first child of the root of this kind.
uint32_t& child_word(Tree& tree, ChildKind kind) {
  uint32_t i = 0;
  while (child_of(tree.nodes[0], i).kind != kind) ++i;
  return tree.nodes[0].children[static_cast<int>(i)];
}

/// Makes a chain of nodes of two children, a leaf and the next node; the last node has two leaves.
void make_chain(Tree& tree, uint32_t length) {
  tree.nodes.assign(length, tree.nodes[0]);
  tree.references.clear();
  for (uint32_t i = 0; i < length; ++i) {
    const uint32_t next = i + 1 < length ? i + 1 : leaf_of(length, 1);
    tree.nodes[i].children = uvec4(leaf_of(i, 1), next, 0, 0);
    set_child_count(tree.nodes[i], 2);
    tree.references.push_back(i);
  }
  tree.references.push_back(length);
  tree.view.primitive_count = length + 1;
  tree.view.stack_size = length - 1;
  tree.view.stats.leaves = length + 1;
  tree.view.stats.nodes = 2 * length + 1;
  tree.view.stats.max_leaf_size = 1;
}

const HostileTree kHostileTrees[] = {
    {"a_cycle", [](Tree& t) { t.nodes.back().children.x = 0; }, "has a child out of range"},
    {"a_node_is_its_own_child", [](Tree& t) { t.nodes.back().children.x = static_cast<uint32_t>(t.nodes.size() - 1); },
     "has a child out of range"},
    {"child_beyond_the_nodes", [](Tree& t) { child_word(t, ChildKind::kNode) = static_cast<uint32_t>(t.nodes.size()); },
     "node 0 has a child out of range"},
    {"child_far_beyond", [](Tree& t) { child_word(t, ChildKind::kNode) = 0x7FFFFFFF; },
     "node 0 has a child out of range"},
    {"two_parents",
     [](Tree& t) {
       const uint32_t child = child_word(t, ChildKind::kNode);
       t.nodes[0].children = uvec4(child, child, 0, 0);
       set_child_count(t.nodes[0], 2);
     },
     "has two parents"},
    {"no_parent", [](Tree& t) { t.nodes.push_back(t.nodes.back()); }, "has no parent before it"},
    {"no_children", [](Tree& t) { set_child_count(t.nodes.back(), 0); }, "has no children"},
    {"too_many_children", [](Tree& t) { set_child_count(t.nodes.back(), 5); }, "declares 5 children"},
    {"leaf_beyond_the_references",
     [](Tree& t) { t.nodes.back().children.x = leaf_of(static_cast<uint32_t>(t.references.size()) - 1, 16); },
     "has a leaf out of range"},
    {"leaf_far_beyond", [](Tree& t) { t.nodes.back().children.x = leaf_of(layout::CHILD_FIRST_MASK - 1, 16); },
     "has a leaf out of range"},
    {"one_leaf_twice", [](Tree& t) { t.nodes.back().children.x = t.nodes.back().children.y; },
     "shares a reference with another leaf"},
    {"a_reference_in_no_leaf", [](Tree& t) { t.references.push_back(0); }, "has references that belong to no leaf"},
    {"reference_beyond_the_primitives", [](Tree& t) { t.references[3] = t.view.primitive_count; },
     "refers to primitive "},
    {"reference_far_beyond", [](Tree& t) { t.references[3] = 0xFFFFFFFF; }, "refers to primitive 4294967295"},
    {"missing_primitive", [](Tree& t) { t.references[4] = t.references[3]; }, "'s tree lacks primitive "},
    {"more_primitives_than_references", [](Tree& t) { t.view.primitive_count = 0xFFFFFFFF; },
     "has fewer references than primitives"},
    {"stack_too_small", [](Tree& t) { --t.view.stack_size; }, "but declares "},
    {"stack_too_large", [](Tree& t) { ++t.view.stack_size; }, "but declares "},
    {"another_leaf_count", [](Tree& t) { ++t.view.stats.leaves; }, "describes another tree"},
    {"another_node_count", [](Tree& t) { t.view.stats.nodes = 0; }, "describes another tree"},
    {"another_leaf_size", [](Tree& t) { ++t.view.stats.max_leaf_size; }, "describes another tree"},
    {"too_deep", [](Tree& t) { t.view.stats.depth = kMaxBvhDepth + 1; }, "describes another tree"},
    {"cost_is_no_number", [](Tree& t) { t.view.stats.sah_cost = std::nan(""); }, "describes another tree"},
    {"stack_of_nothing", [](Tree& t) { t.view.stack_size = 0; }, "but declares 0"},
    {"deep_chain", [](Tree& t) { make_chain(t, 100'000); }, "lies deeper than in the tree of any builder"},
    {"no_nodes",
     [](Tree& t) {
       t.nodes.clear();
       t.references.clear();
       t.view.primitive_count = 0;
     },
     "has no nodes"},
};

class HostileBvhFile : public BvhFileTest, public testing::WithParamInterface<HostileTree> {};

TEST_P(HostileBvhFile, IsRefusedThoughItsChecksumIsRight) {
  Tree tree(packed_.tree());
  ASSERT_GT(tree.nodes.size(), 3U);
  ASSERT_EQ(refusal(tree), "");
  GetParam().spoil(tree);
  EXPECT_THAT(refusal(tree), testing::AllOf(HasProblem("bvh.file.tree"), HasSubstr(GetParam().sentence)));
}

INSTANTIATE_TEST_SUITE_P(Trees, HostileBvhFile, testing::ValuesIn(kHostileTrees),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST_F(BvhFileTest, ADeepTreeIsTaken) {
  Tree tree(packed_.tree());
  make_chain(tree, kMaxBvhDepth);
  EXPECT_EQ(refusal(tree), "");
}

/// A file with a correct checksum is either refused, or a traversal stays within the buffers, for any contents.
TEST_F(BvhFileTest, RandomFaultsAreRefusedOrHarmless) {
  const Bytes good = read_file(file_);
  std::mt19937 random(1);
  size_t taken = 0;
  for (int run = 0; run < 8000; ++run) {
    Bytes bytes = good;
    // Most changes affect the words that refer to other data: counts, children, references.
    const size_t place = run % 4 == 0 ? random() % bytes.size()
                         : run % 4 == 1
                             ? 40 + random() % 16
                             : kHeaderSize + sizeof(Node) * (random() % packed_.nodes.size()) + 48 + random() % 16;
    bytes[place] = run % 3 == 0 ? static_cast<std::byte>(random()) : bytes[place] ^ (std::byte{1} << (random() % 8));
    bytes = sealed(std::move(bytes));
    if (!refusal(bytes).empty()) continue;
    ++taken;
    expect_traversable(BvhFile(file_).trees().front());
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(taken, 100U);
  EXPECT_LT(taken, 6000U);
}

TEST_F(BvhFileTest, OtherGeometryMakesItStale) {
  const auto refusal_for = [&](const world::Scene& scene) {
    return message_of([&] { pack_scene_with(file_, scene); });
  };
  EXPECT_EQ(refusal_for(scene_), "");

  const std::string stale = "bvh.file.stale " + file_.string() +
                            ": the BVH file does not belong to this scene, because its geometry differs; build it "
                            "again with promin-bvh build";
  for (size_t vertex = 0; vertex < 6; ++vertex) {
    for (int axis = 0; axis < 3; ++axis) {
      world::Scene moved = scene_;
      std::get<Mesh>(moved.objects[5].shape).positions[vertex][axis] += 1e-6F;
      EXPECT_EQ(refusal_for(moved), stale) << "vertex " << vertex << ", axis " << axis;
    }
  }
  world::Scene turned = scene_;
  std::get<world::Cylinder>(turned.objects[2].shape).axis.x += 1e-6F;
  EXPECT_EQ(refusal_for(turned), stale);
  world::Scene smaller = scene_;
  std::get<world::Cone>(smaller.objects[4].shape).radius_top *= 0.99F;
  EXPECT_EQ(refusal_for(smaller), stale);
  world::Scene swapped = scene_;
  std::swap(swapped.objects[10], swapped.objects[11]);
  EXPECT_EQ(refusal_for(swapped), stale);
  world::Scene fewer = scene_;
  fewer.objects.pop_back();
  EXPECT_EQ(refusal_for(fewer), stale);
}

TEST_F(BvhFileTest, WhatTheTreeDoesNotDependOnDoesNot) {
  world::Scene other = scene_;
  other.file = "renamed.gltf";
  other.materials[1].phong().diffuse = vec3(0.5F);
  other.lights.clear();
  other.environment.ambient = vec3(1.0F);
  other.objects[1].name = "renamed";
  other.objects[1].material = 2;
  // A tree contains no planes. A degenerate triangle only occupies a number.
  other.objects.insert(other.objects.begin(), {"", world::Plane{vec3(0, -1, 0), vec3(0, 1, 0)}, 0});
  std::get<Mesh>(other.objects[6].shape)
      .triangles.insert(std::get<Mesh>(other.objects[6].shape).triangles.begin(), uvec3(0, 0, 1));
  expect_same(pack_scene_with(file_, other), pack_scene(other, "median"));
}

/// Anyone can read the scene's hash from a valid file and use it to forge a file.
TEST_F(BvhFileTest, MorePrimitivesThanTheSceneAreRefused) {
  Tree tree(packed_.tree());
  make_chain(tree, 90);
  ASSERT_GT(tree.references.size(), packed_.references.size());
  write_bvh_file(file_, tree.show());
  EXPECT_THAT(message_of([&] { pack_scene_with(file_, scene_); }), HasProblem("bvh.file.stale"));
}

TEST_F(BvhFileTest, AWriteThatFailsLeavesTheOldFile) {
  const Bytes old = read_file(file_);
  fs::create_directory(folder_ / "folder.pbvh");
  EXPECT_THROW(write_bvh_file(folder_ / "none" / "tree.pbvh", packed_.tree()), RunError);
  EXPECT_THROW(write_bvh_file(folder_ / "folder.pbvh", packed_.tree()), RunError);
  EXPECT_EQ(read_file(file_), old);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

TEST_F(BvhFileTest, AReplacedFileStaysAsItWas) {
  const BvhFile file(file_);
  const Bytes before(std::as_bytes(file.trees().front().nodes).begin(),
                     std::as_bytes(file.trees().front().nodes).end());
  write_bvh_file(file_, pack_scene(test::make_scene_of_everything(2), "sah").tree());
  EXPECT_TRUE(has_same_bytes<std::byte>(std::as_bytes(file.trees().front().nodes), before));
}

TEST(Hash64, EveryBitCounts) {
  const Bytes bytes(21, std::byte{0x5A});
  const auto hash_of = [](const Bytes& data) {
    Hash64 hash;
    hash.add(data);
    return hash.value();
  };
  for (size_t i = 0; i < 8 * bytes.size(); ++i) {
    Bytes flipped = bytes;
    flipped[i / 8] ^= std::byte{1} << (i % 8);
    EXPECT_NE(hash_of(flipped), hash_of(bytes)) << i;
  }
}

}  // namespace
}  // namespace promin
