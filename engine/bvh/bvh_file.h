// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "bvh/builder.h"
#include "core/mapped_file.h"
#include "layout.h"

namespace promin {

/// A tree over the primitives of a scene, as the device takes it: pack_tree's nodes, and what its leaves hold. Keeps
/// nothing alive.
struct TreeView {
  /// At least one. A node comes after its parent.
  std::span<const layout::Node> nodes;
  /// What the leaves' ranges are of: primitives by their place in (object, primitive) order, planes and degenerate
  /// triangles left out. Sorted by kind in each leaf. A primitive may be in several leaves.
  std::span<const uint32_t> references;
  uint32_t primitive_count = 0;
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// PackedScene::geometry_hash of the scene that it was built over.
  uint64_t geometry_hash = 0;
  BvhStats stats;
};

/// A tree in a file that can be uploaded as it lies there; docs/bvh_file.md has the format.
class BvhFile {
 public:
  /// Maps the file and checks all of it: what tree() shows can be traversed, whoever wrote it, and its references are
  /// primitives. That the boxes hold the primitives is not checked (find_tree_faults does). Throws InputError.
  explicit BvhFile(const std::filesystem::path& file);

  /// Lives as long as this.
  const TreeView& tree() const { return tree_; }
  size_t size_bytes() const { return mapped_.bytes().size(); }

  /// Throws InputError unless the tree was built over this geometry (PackedScene).
  void check_scene(uint64_t geometry_hash, size_t solid_count) const;

 private:
  std::filesystem::path file_;
  MappedFile mapped_;
  TreeView tree_;
};

/// Writes the file whole or not at all. Throws RunError.
void write_bvh_file(const std::filesystem::path& file, const TreeView& tree);

}  // namespace promin
