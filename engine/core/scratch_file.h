// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace promin {

/// Disk space for data that is too large for memory, until the data is written to its file. It is a nameless file in
/// the folder of that file, so nothing remains of it, even if the process is killed. Several threads may write and read
/// ranges that do not overlap.
class ScratchFile {
 public:
  /// Reserves this number of bytes if the file system supports it; other file systems report a lack of space when the
  /// file is written. Throws RunError with the place `target` if there is not enough space.
  ScratchFile(std::filesystem::path target, uint64_t byte_count);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Writes bytes at a position. Throws RunError.
  void write(uint64_t place, std::span<const std::byte> bytes);
  /// Reads bytes that were written at a position. Throws RunError.
  void read(uint64_t place, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  uint64_t byte_count_;
  int descriptor_ = -1;
};

}  // namespace promin
