// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace promin::gpu {

/// A folder with compiled kernels, which all processes of a user share. A file holds a whole key, the binary of the
/// kernel and a checksum of both. Files appear completely or not at all, so several processes and threads can use a
/// folder at the same time. The folder is only a cache: a damaged file counts as absent, and store() reports an
/// unusable folder only in problem(). The checksum does not protect against deliberate changes.
class KernelFolder {
 public:
  /// Enough for about 200 kernels of 300 KiB each.
  static constexpr uint64_t kMostBytes = uint64_t{64} << 20;

  /// Does not access the folder. store() creates it.
  explicit KernelFolder(std::filesystem::path folder, uint64_t most_bytes = kMostBytes);

  /// Returns the folder promin/kernels in $XDG_CACHE_HOME, or in ~/.cache if that variable is not an absolute path;
  /// nullopt if $HOME is not an absolute path either.
  static std::optional<std::filesystem::path> usual();

  const std::filesystem::path& path() const { return folder_; }

  /// Returns the binary that was stored with this key; empty if there is none. The kernel then counts as used.
  std::vector<std::byte> find(std::span<const uint32_t> key) const;

  /// Stores a binary. If the folder then exceeds its size, removes the kernels that were not used for longest.
  void store(std::span<const uint32_t> key, std::span<const std::byte> binary) const;

  /// Returns the reason why the last call of store() failed; empty if it did not fail.
  std::string problem() const;

 private:
  std::filesystem::path file_of(std::span<const uint32_t> key) const;
  /// Returns the reason of a failure; empty after success.
  std::string try_to_store(std::span<const uint32_t> key, std::span<const std::byte> binary) const;
  /// Removes files until the rest fits the bound. Throws std::filesystem::filesystem_error.
  void remove_least_used() const;

  std::filesystem::path folder_;
  uint64_t most_bytes_;
  mutable std::mutex mutex_;
  mutable std::string problem_;
};

}  // namespace promin::gpu
