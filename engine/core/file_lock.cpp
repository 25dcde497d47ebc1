// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <thread>

#include "promin/error.h"

namespace promin {
namespace {

/// Interval at which a waiting process tries again.
constexpr std::chrono::milliseconds kAsk{20};

}  // namespace

// The file is opened for writing, because NFS only locks such files.
FileLock::FileLock(const std::filesystem::path& file, std::chrono::seconds patience, const ProgressCallback& progress)
    : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  const auto until = std::chrono::steady_clock::now() + patience;
  while (descriptor_ >= 0) {
    is_held_ = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (is_held_ || errno != EWOULDBLOCK || std::chrono::steady_clock::now() >= until) return;
    if (progress && !progress(0.0)) {
      close(descriptor_);
      throw Cancelled();
    }
    std::this_thread::sleep_for(kAsk);
  }
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace promin
