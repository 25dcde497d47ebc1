// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/bvh_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "bvh/pack_tree.h"
#include "bvh/read_node.h"
#include "core/divide_up.h"
#include "core/file.h"
#include "core/hash.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

using layout::Node;

static_assert(std::endian::native == std::endian::little, "the file is little-endian and used as it lies in memory");

// The magic number has a byte beyond ASCII and both line ends, so that a transfer in text mode is detected.
constexpr std::array<char, 8> kMagic = {'\x89', 'P', 'B', 'V', 'H', '\r', '\n', '\x1A'};
constexpr uint32_t kByteOrder = 0x01020304;
constexpr uint32_t kVersion = 1;

/// The head of a section; docs/bvh_file.md describes it.
struct Header {
  std::array<char, 8> magic = kMagic;
  uint32_t byte_order = kByteOrder;
  uint32_t version = kVersion;
  /// The checksum of the section, computed while this member is 0.
  uint64_t checksum = 0;
  uint64_t layout_hash = 0;
  uint64_t geometry_hash = 0;
  uint32_t node_count = 0;
  uint32_t reference_count = 0;
  uint32_t primitive_count = 0;
  uint32_t stack_size = 0;
  // The following members are the members of BvhStats.
  uint64_t tree_nodes = 0;
  uint64_t leaves = 0;
  double sah_cost = 0.0;
  uint32_t depth = 0;
  uint32_t max_leaf_size = 0;
  /// The builder's name, filled up with zeros; there is at least one zero.
  std::array<char, 36> builder{};
  /// The kinds of primitive in the tree with numbers from kFirstKinds on, as bits 1 << KIND_*.
  uint32_t further_kinds = 0;
};
/// A section begins at a multiple of this.
constexpr uint64_t kSectionAlignment = sizeof(Node);
static_assert(sizeof(Header) == 128 && sizeof(Header) % alignof(Node) == 0 && std::is_trivially_copyable_v<Header>);

/// The largest stack that the traversal of a tree of kMaxBvhDepth can need: an entry for each node above the deepest
/// node.
constexpr uint32_t kMaxStackSize = kMaxBvhDepth - 1;

/// The number of kinds in the first version of the format: triangles, spheres, cylinders and cones. The hash of every
/// file includes their numbers. It includes the numbers of further kinds only if the tree contains them, so that a new
/// kind does not invalidate older files.
constexpr uint32_t kFirstKinds = 4;

/// The kinds of primitive that a tree may contain, as bits 1 << KIND_*.
constexpr uint32_t kTreeKinds = 0
#define PROMIN_TREE_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) | 1U << (NUMBER)
#include "promin/kinds/primitives.def"
    ;
constexpr uint32_t kFirstKindBits = (1U << kFirstKinds) - 1;
static_assert((kTreeKinds & kFirstKindBits) == kFirstKindBits);

/// Returns a hash of the result of pack_tree for a small tree, and of the tree's kinds. The hash changes if the meaning
/// of a node's bits or the number of stack entries changes.
uint64_t hash_layout(uint32_t further_kinds) {
  Bvh probe;
  // Five leaves are one more than a node can hold, so the nodes have inner, leaf and absent children.
  for (uint32_t i = 0; i < 5; ++i) {
    const auto x = static_cast<float>(i);
    const Bounds box{{x, -0.3F * x, 1e-3F * x}, {5.3F, 0.7F + x, 2e3F}};
    const uint32_t node = 2 * i;
    if (i < 4) {
      probe.nodes.push_back({{{x, -2.0F, 0.0F}, {6.0F, 5.0F, 2e3F}}, node + 1, 0});
      probe.nodes.push_back({box, 3 * i, i + 1});
    } else {
      probe.nodes.push_back({box, 3 * i, kMaxLeafSize});
    }
  }
  // The children of an inner node are neighbours: node 2i + 1 is a leaf, node 2i + 2 the next inner one.
  const PackedTree packed = pack_tree(probe);
  Hash64 hash;
  hash.add(std::as_bytes(std::span(packed.nodes)));
  hash.add(packed.stack_size);
  for (uint32_t kind = 0; kind < 32; ++kind) {
    if (((kFirstKindBits | further_kinds) >> kind & 1) != 0) hash.add(kind);
  }
  return hash.value();
}

uint64_t hash_section(Header header, std::span<const std::byte> nodes, std::span<const std::byte> references) {
  header.checksum = 0;
  Hash64 hash;
  hash.add(std::as_bytes(std::span(&header, 1)));
  hash.add(nodes);
  hash.add(references);
  return hash.value();
}

[[noreturn]] void refuse(ProblemCode code, const fs::path& file, const std::string& what) {
  throw InputError({code, what, file.string(), "build it again with promin-bvh build"});
}

Header read_header(std::span<const std::byte> bytes, const fs::path& file) {
  if (std::memcmp(bytes.data(), kMagic.data(), std::min(bytes.size(), kMagic.size())) != 0) {
    throw InputError(
        {"bvh.file.kind", "the file is not a BVH file", file.string(), "use a file that promin-bvh build has written"});
  }
  if (bytes.size() < sizeof(Header)) refuse("bvh.file.short", file, "the BVH file ends within its header");
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(Header));
  if (header.byte_order != kByteOrder)
    refuse("bvh.file.version", file, "the BVH file has a different byte order than this machine");
  if (header.version != kVersion) {
    refuse("bvh.file.version", file,
           "the BVH file has version " + std::to_string(header.version) + " and this promin reads version " +
               std::to_string(kVersion));
  }
  const bool has_known_kinds = (header.further_kinds & ~kTreeKinds) == 0;
  if (!has_known_kinds || header.layout_hash != hash_layout(header.further_kinds)) {
    refuse("bvh.file.version", file, "the BVH file has nodes of a different layout than this promin's");
  }
  return header;
}

std::string read_builder(const Header& header, const fs::path& file) {
  const auto end = std::find(header.builder.begin(), header.builder.end(), '\0');
  // Programs print the name, so it must not contain control characters.
  const bool is_name = end != header.builder.end() && std::all_of(header.builder.begin(), end, [](char c) {
                         return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
                       });
  if (!is_name) refuse("bvh.file.header", file, "the BVH file does not name its builder");
  return {header.builder.begin(), end};
}

/// Checks an untrusted tree in one pass, in the order of the nodes.
class TreeCheck {
 public:
  TreeCheck(const TreeView& tree, const fs::path& file)
      : tree_(tree),
        file_(file),
        entries_(tree.nodes.size(), kUnreached),
        is_slot_taken_(tree.references.size()),
        is_referred_to_(tree.primitive_count) {}

  /// Checks the whole tree. Throws InputError.
  void run() {
    if (tree_.references.size() > layout::CHILD_FIRST_MASK)
      refuse("bvh.file.tree", file_, "the BVH file has too many references");
    if (tree_.nodes.empty()) refuse("bvh.file.tree", file_, "the BVH file has no nodes");
    if (tree_.nodes.size() > layout::MAX_NODES) refuse("bvh.file.tree", file_, "the BVH file has too many nodes");
    entries_[0] = 0;
    // A child comes after its parent, so the tree has no cycle, and each node is marked as reached before the loop
    // visits it.
    for (uint32_t i = 0; i < tree_.nodes.size(); ++i) visit(i);
    if (most_entries_ != tree_.stack_size) {
      refuse("bvh.file.tree", file_,
             "the BVH file's tree needs a stack of " + std::to_string(most_entries_) + " but declares " +
                 std::to_string(tree_.stack_size));
    }
    if (slots_taken_ != tree_.references.size())
      refuse("bvh.file.tree", file_, "the BVH file has references that belong to no leaf");
    check_stats();
    for (const uint32_t primitive : tree_.references) {
      if (primitive >= tree_.primitive_count) {
        refuse("bvh.file.tree", file_,
               "the BVH file refers to primitive " + std::to_string(primitive) + " of " +
                   std::to_string(tree_.primitive_count));
      }
      is_referred_to_[primitive] = true;
    }
    const auto missing = std::find(is_referred_to_.begin(), is_referred_to_.end(), false);
    if (missing != is_referred_to_.end()) {
      refuse("bvh.file.tree", file_,
             "the BVH file's tree lacks primitive " + std::to_string(missing - is_referred_to_.begin()));
    }
  }

 private:
  static constexpr uint32_t kUnreached = std::numeric_limits<uint32_t>::max();

  [[noreturn]] void refuse_node(uint32_t index, const std::string& what) const {
    refuse("bvh.file.tree", file_, "the BVH file's node " + std::to_string(index) + " " + what);
  }

  void visit(uint32_t index) {
    if (entries_[index] == kUnreached) refuse_node(index, "has no parent before it");
    const Node& node = tree_.nodes[index];
    const uint32_t count = child_count(node);
    if (count > layout::NODE_WIDTH) refuse_node(index, "declares " + std::to_string(count) + " children");
    // Only the node of an empty tree has no children.
    if (count == 0 && tree_.nodes.size() > 1) refuse_node(index, "has no children");
    const uint32_t entries = entries_[index];
    if (entries > kMaxStackSize) refuse_node(index, "lies deeper than in the tree of any builder");
    most_entries_ = std::max(most_entries_, entries);
    for (uint32_t i = 0; i < count; ++i) {
      const NodeChild child = child_of(node, i);
      if (child.kind == ChildKind::kLeaf) {
        take_slots(index, child);
      } else if (child.first <= index || child.first >= tree_.nodes.size()) {
        refuse_node(index, "has a child out of range");
      } else if (entries_[child.first] != kUnreached) {
        refuse_node(child.first, "has two parents");
      } else {
        entries_[child.first] = entries + 1;
      }
    }
  }

  /// Checks the statistics, because the programs print them and --stats writes them.
  void check_stats() const {
    const BvhStats& stats = tree_.stats;
    const uint64_t binary_nodes = leaf_count_ > 0 ? 2 * leaf_count_ - 1 : 0;
    const bool is_so = stats.leaves == leaf_count_ && stats.max_leaf_size == max_leaf_size_ &&
                       stats.nodes == binary_nodes && stats.depth <= kMaxBvhDepth && stats.sah_cost >= 0.0 &&
                       std::isfinite(stats.sah_cost);
    if (!is_so) refuse("bvh.file.tree", file_, "the BVH file describes another tree than it holds");
  }

  void take_slots(uint32_t index, const NodeChild& leaf) {
    if (uint64_t{leaf.first} + leaf.count > is_slot_taken_.size()) refuse_node(index, "has a leaf out of range");
    for (uint32_t slot = leaf.first; slot < leaf.first + leaf.count; ++slot) {
      if (is_slot_taken_[slot]) refuse_node(index, "shares a reference with another leaf");
      is_slot_taken_[slot] = true;
    }
    slots_taken_ += leaf.count;
    ++leaf_count_;
    max_leaf_size_ = std::max(max_leaf_size_, leaf.count);
  }

  const TreeView& tree_;
  const fs::path& file_;
  /// Number of entries on the traversal stack when a ray leaves a node: one for each node above it.
  std::vector<uint32_t> entries_;
  uint32_t most_entries_ = 1;
  std::vector<bool> is_slot_taken_;
  size_t slots_taken_ = 0;
  uint64_t leaf_count_ = 0;
  uint32_t max_leaf_size_ = 0;
  std::vector<bool> is_referred_to_;
};

/// Reads and checks the section that begins at `at`. Sets `end` to its end.
TreeView read_section(std::span<const std::byte> all, uint64_t at, const fs::path& file, uint64_t& end) {
  const std::span<const std::byte> bytes = all.subspan(at);
  const Header header = read_header(bytes, file);
  const uint64_t node_bytes = uint64_t{header.node_count} * sizeof(Node);
  const uint64_t reference_bytes = uint64_t{header.reference_count} * sizeof(uint32_t);
  end = at + sizeof(Header) + node_bytes + reference_bytes;
  if (all.size() != end && all.size() < next_multiple(end, kSectionAlignment) + sizeof(Header)) {
    refuse("bvh.file.short", file,
           "the BVH file has " + std::to_string(all.size()) + " bytes, but its header declares " + std::to_string(end));
  }
  const auto nodes = bytes.subspan(sizeof(Header), node_bytes);
  const auto references = bytes.subspan(sizeof(Header) + node_bytes, reference_bytes);
  if (hash_section(header, nodes, references) != header.checksum) {
    refuse("bvh.file.damaged", file, "the BVH file is damaged, because its checksum does not match its contents");
  }
  TreeView tree;
  // Both pointers are aligned: the mapping begins at a page, and the nodes begin 128 bytes after a multiple of 64.
  tree.nodes = {reinterpret_cast<const Node*>(nodes.data()), header.node_count};
  tree.references = {reinterpret_cast<const uint32_t*>(references.data()), header.reference_count};
  tree.primitive_count = header.primitive_count;
  tree.stack_size = header.stack_size;
  tree.kinds = header.further_kinds;
  tree.geometry_hash = header.geometry_hash;
  tree.stats = {.builder = read_builder(header, file),
                .nodes = header.tree_nodes,
                .leaves = header.leaves,
                .depth = header.depth,
                .max_leaf_size = header.max_leaf_size,
                .sah_cost = header.sah_cost,
                .bytes = node_bytes};
  // This is checked before memory is allocated for the counts.
  if (header.primitive_count > header.reference_count)
    refuse("bvh.file.tree", file, "the BVH file has fewer references than primitives");
  TreeCheck(tree, file).run();
  return tree;
}

Header make_header(const TreeView& tree) {
  Header header;
  header.further_kinds = tree.kinds & ~kFirstKindBits;
  header.layout_hash = hash_layout(header.further_kinds);
  header.geometry_hash = tree.geometry_hash;
  header.node_count = static_cast<uint32_t>(tree.nodes.size());
  header.reference_count = static_cast<uint32_t>(tree.references.size());
  header.primitive_count = tree.primitive_count;
  header.stack_size = tree.stack_size;
  header.tree_nodes = tree.stats.nodes;
  header.leaves = tree.stats.leaves;
  header.sah_cost = tree.stats.sah_cost;
  header.depth = tree.stats.depth;
  header.max_leaf_size = tree.stats.max_leaf_size;
  tree.stats.builder.copy(header.builder.data(), header.builder.size() - 1);
  header.checksum = hash_section(header, std::as_bytes(tree.nodes), std::as_bytes(tree.references));
  return header;
}

}  // namespace

BvhFile::BvhFile(const fs::path& file) : file_(file), mapped_(file) {
  const std::span<const std::byte> bytes = mapped_.bytes();
  uint64_t end = 0;
  trees_.push_back(read_section(bytes, 0, file, end));
  while (end < bytes.size()) {
    const uint64_t next = next_multiple(end, kSectionAlignment);
    const auto filling = bytes.subspan(end, next - end);
    const bool is_filled = std::ranges::all_of(filling, [](std::byte byte) { return byte == std::byte{0}; });
    if (!is_filled || std::memcmp(bytes.data() + next, kMagic.data(), kMagic.size()) != 0) {
      refuse("bvh.file.damaged", file,
             "the BVH file is damaged, because no tree begins at byte " + std::to_string(next));
    }
    trees_.push_back(read_section(bytes, next, file, end));
  }
  for (size_t i = 0; i < trees_.size(); ++i) places_.try_emplace(trees_[i].geometry_hash, i);
}

const TreeView& BvhFile::find(uint64_t geometry_hash, size_t bounded_count) const {
  const auto found = places_.find(geometry_hash);
  if (found != places_.end() && trees_[found->second].primitive_count == bounded_count) return trees_[found->second];
  refuse("bvh.file.stale", file_, "the BVH file does not belong to this scene, because its geometry differs");
}

void write_bvh_file(const fs::path& file, std::span<const TreeView> trees) {
  static constexpr std::array<std::byte, kSectionAlignment> kFilling{};
  std::vector<Header> headers;
  for (const TreeView& tree : trees) headers.push_back(make_header(tree));
  std::vector<std::span<const std::byte>> parts;
  uint64_t size = 0;
  for (size_t i = 0; i < trees.size(); ++i) {
    const auto nodes = std::as_bytes(trees[i].nodes);
    const auto references = std::as_bytes(trees[i].references);
    parts.push_back(std::span(kFilling).first(next_multiple(size, kSectionAlignment) - size));
    parts.insert(parts.end(), {std::as_bytes(std::span(&headers[i], 1)), nodes, references});
    size = next_multiple(size, kSectionAlignment) + sizeof(Header) + nodes.size() + references.size();
  }
  write_file(file, parts);
}

}  // namespace promin
