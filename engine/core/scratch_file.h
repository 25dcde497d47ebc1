// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace promin {

/// Room on disk for what is too much for memory until a file can be written: a file without a name in the folder of
/// that file, so that nothing of it is left however the process ends. Any threads may write and read places that do not
/// overlap.
class ScratchFile {
 public:
  /// Takes the room of so many bytes at once where the file system can promise it; others tell while it is written.
  /// Throws RunError, whose place is `target`, where there is not as much.
  ScratchFile(std::filesystem::path target, uint64_t byte_count);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws RunError.
  void write(uint64_t place, std::span<const std::byte> bytes);
  /// Reads what was written. Throws RunError.
  void read(uint64_t place, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path target_;
  uint64_t byte_count_;
  int descriptor_ = -1;
};

}  // namespace promin
