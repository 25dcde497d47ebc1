// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A library to preload (LD_PRELOAD) into a program whose file size limit simulates a full disk. The limit also applies
// to files in memory, in which newer lavapipes keep device memory; a full disk does not affect them, so this library
// lets them grow. With PROMIN_TEST_PROMISES_NO_ROOM it simulates a file system that cannot reserve room, so that a full
// disk is found only by writing.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace {

/// A file of memfd_create has no name; every other file that a program extends with ftruncate has one.
bool is_in_memory(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && status.st_nlink == 0;
}

int change_size(int file, off_t bytes) {
  rlimit old{};
  const bool is_free = is_in_memory(file) && getrlimit(RLIMIT_FSIZE, &old) == 0;
  if (is_free) {
    const rlimit most{old.rlim_max, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &most);
  }
  const auto result = static_cast<int>(syscall(SYS_ftruncate, file, bytes));
  if (is_free) setrlimit(RLIMIT_FSIZE, &old);
  return result;
}

int promise_room(int file, int mode, off_t place, off_t bytes) {
  if (std::getenv("PROMIN_TEST_PROMISES_NO_ROOM") == nullptr) {
    return static_cast<int>(syscall(SYS_fallocate, file, mode, place, bytes));
  }
  errno = EOPNOTSUPP;
  return -1;
}

}  // namespace

extern "C" int fallocate(int file, int mode, off_t place, off_t bytes) {
  return promise_room(file, mode, place, bytes);
}

extern "C" int fallocate64(int file, int mode, off64_t place, off64_t bytes) {
  return promise_room(file, mode, place, bytes);
}

extern "C" int ftruncate(int file, off_t bytes) noexcept {
  return change_size(file, bytes);
}

extern "C" int ftruncate64(int file, off64_t bytes) noexcept {
  return change_size(file, bytes);
}
