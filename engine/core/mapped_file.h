// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace promin {

/// A regular file, mapped read-only into memory. The file must not be changed in place while it is mapped. If another
/// file replaces it (AtomicFile), the mapping does not change.
class MappedFile {
 public:
  /// Maps the file. Throws InputError if it is missing, not a regular file, not readable or empty.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Returns the bytes of the file, which begin at a page boundary.
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace promin
