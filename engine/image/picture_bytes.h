// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace promin {

/// The bytes of a picture file that is being encoded. They are gathered, as encoders write many times a few.
class PictureBytes {
 public:
  /// Writes `file`, which is to become `target`. Throws RunError.
  PictureBytes(const std::filesystem::path& file, std::filesystem::path target);
  ~PictureBytes();
  PictureBytes(const PictureBytes&) = delete;
  PictureBytes& operator=(const PictureBytes&) = delete;

  /// At the place. False where it cannot be written, from then on too.
  bool write(std::span<const std::byte> bytes) noexcept;
  uint64_t place() const { return begin_ + gathered_.size(); }
  void seek(uint64_t place) noexcept;

  /// Throws RunError where something could not be written.
  void check() const;
  /// After the last byte. Throws RunError.
  void close();

 private:
  void flush() noexcept;

  std::filesystem::path target_;
  int descriptor_ = -1;
  /// Why it cannot be written (errno); 0 where it can.
  int error_ = 0;
  /// Where the bytes lie that are gathered.
  uint64_t begin_ = 0;
  std::vector<std::byte> gathered_;
};

}  // namespace promin
