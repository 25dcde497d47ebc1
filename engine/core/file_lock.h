// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>

#include "promin/progress.h"

namespace promin {

/// A lock that excludes other threads, other processes and, if the file system supports it, other machines. It is
/// released when the object is destroyed or the process ends. The lock only avoids duplicate work. Results do not
/// depend on it, and a caller that cannot get it continues without it.
class FileLock {
 public:
  /// Creates the lock file, which is never removed, and waits for the lock. Continues without the lock if locks are not
  /// supported, or if another process has held it for `patience`. Calls `progress` meanwhile and throws Cancelled if it
  /// returns false.
  FileLock(const std::filesystem::path& file, std::chrono::seconds patience, const ProgressCallback& progress);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return is_held_; }

 private:
  int descriptor_;
  bool is_held_ = false;
};

}  // namespace promin
