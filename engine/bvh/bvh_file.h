// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <unordered_map>
#include <vector>

#include "bvh/tree_view.h"
#include "core/mapped_file.h"

namespace promin {

/// Trees in a file whose bytes can be uploaded directly; docs/bvh_file.md describes the format. A file has a section
/// with a tree for each geometry: for the primitives of the scene that belong to no instance, and for each mesh that
/// instances share.
class BvhFile {
 public:
  /// Maps the file and checks it completely: afterwards the trees can be traversed and their references are valid, no
  /// matter which program wrote the file. The constructor does not check that the boxes contain the primitives;
  /// find_tree_faults() does. Throws InputError.
  explicit BvhFile(const std::filesystem::path& file);

  /// Returns the trees; at least one. The views are valid as long as this object exists.
  const std::vector<TreeView>& trees() const { return trees_; }
  size_t size_bytes() const { return mapped_.bytes().size(); }

  /// Returns the tree that was built from this geometry (hash_geometry). Throws InputError if the file does not have
  /// it.
  const TreeView& find(uint64_t geometry_hash, size_t bounded_count) const;

 private:
  std::filesystem::path file_;
  MappedFile mapped_;
  std::vector<TreeView> trees_;
  /// The index of a geometry's tree, by the hash of the geometry.
  std::unordered_map<uint64_t, size_t> places_;
};

/// Writes trees to a file, completely or not at all. Throws RunError.
void write_bvh_file(const std::filesystem::path& file, std::span<const TreeView> trees);
inline void write_bvh_file(const std::filesystem::path& file, const TreeView& tree) {
  write_bvh_file(file, {&tree, 1});
}

}  // namespace promin
