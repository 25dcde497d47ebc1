// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace promin {

/// The bytes of a picture file that is being encoded. They are buffered, because encoders write many small pieces.
class PictureBytes {
 public:
  /// Creates a buffer that writes to `file`. `target` is the final name of the file, for messages. Throws RunError.
  PictureBytes(const std::filesystem::path& file, std::filesystem::path target);
  ~PictureBytes();
  PictureBytes(const PictureBytes&) = delete;
  PictureBytes& operator=(const PictureBytes&) = delete;

  /// Writes bytes at the current position. Returns false after a failure, also in all later calls.
  bool write(std::span<const std::byte> bytes) noexcept;
  uint64_t place() const { return begin_ + gathered_.size(); }
  void seek(uint64_t place) noexcept;

  /// Throws RunError if a write failed.
  void check() const;
  /// Writes the buffered bytes and closes the file. The caller calls it after the last byte. Throws RunError.
  void close();

 private:
  void flush() noexcept;

  std::filesystem::path target_;
  int descriptor_ = -1;
  /// errno of the first failure; 0 if there was none.
  int error_ = 0;
  /// Position in the file of the buffered bytes.
  uint64_t begin_ = 0;
  std::vector<std::byte> gathered_;
};

}  // namespace promin
