// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "bvh/tree_view.h"
#include "core/mapped_file.h"

namespace promin {

/// A tree in a file whose bytes can be uploaded directly; docs/bvh_file.md describes the format.
class BvhFile {
 public:
  /// Maps the file and checks it completely: afterwards tree() can be traversed and its references are valid, no matter
  /// which program wrote the file. The constructor does not check that the boxes contain the primitives;
  /// find_tree_faults() does. Throws InputError.
  explicit BvhFile(const std::filesystem::path& file);

  /// Returns the tree. The view is valid as long as this object exists.
  const TreeView& tree() const { return tree_; }
  size_t size_bytes() const { return mapped_.bytes().size(); }

  /// Throws InputError unless the tree was built from this geometry (PackedScene).
  void check_scene(uint64_t geometry_hash, size_t bounded_count) const;

 private:
  std::filesystem::path file_;
  MappedFile mapped_;
  TreeView tree_;
};

/// Writes the tree to a file, completely or not at all. Throws RunError.
void write_bvh_file(const std::filesystem::path& file, const TreeView& tree);

}  // namespace promin
