// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "bvh/tree_view.h"
#include "core/mapped_file.h"

namespace promin {

/// A tree in a file that can be uploaded as it lies there; docs/bvh_file.md has the format.
class BvhFile {
 public:
  /// Maps the file and checks all of it: what tree() shows can be traversed, whoever wrote it, and its references are
  /// primitives. That the boxes hold the primitives is not checked (find_tree_faults does). Throws InputError.
  explicit BvhFile(const std::filesystem::path& file);

  /// The tree lives as long as this.
  const TreeView& tree() const { return tree_; }
  size_t size_bytes() const { return mapped_.bytes().size(); }

  /// Throws InputError unless the tree was built over this geometry (PackedScene).
  void check_scene(uint64_t geometry_hash, size_t bounded_count) const;

 private:
  std::filesystem::path file_;
  MappedFile mapped_;
  TreeView tree_;
};

/// Writes the file whole or not at all. Throws RunError.
void write_bvh_file(const std::filesystem::path& file, const TreeView& tree);

}  // namespace promin
