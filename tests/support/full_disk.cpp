// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A library to preload (LD_PRELOAD) into a program whose file size limit stands for a full disk. The limit is for files
// in memory too, where newer lavapipes keep device memory; a full disk is not. Such files may grow here.

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

/// A file of memfd_create has no name, and no other file that a program makes longer lacks one.
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

}  // namespace

extern "C" int ftruncate(int file, off_t bytes) noexcept {
  return change_size(file, bytes);
}

extern "C" int ftruncate64(int file, off64_t bytes) noexcept {
  return change_size(file, bytes);
}
