// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>

#include "promin/progress.h"

namespace promin {

/// A lock that one holder has at a time, of threads, of processes, and where the file system knows locks of all
/// machines that see the file. It ends with the object or the process, whatever ends that. It is there to spare work
/// that several would do at once, and to keep nothing right: who cannot have it goes on without.
class FileLock {
 public:
  /// Makes the file, which stays, and waits for the lock; without it where there are no locks to be had, or another has
  /// held it so long. Throws Cancelled where `progress`, which is asked meanwhile, says so.
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
