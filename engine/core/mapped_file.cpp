// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/file.h"
#include "promin/error.h"

namespace promin {

MappedFile::MappedFile(const std::filesystem::path& file) {
  // The status is read before the file is opened, because opening a pipe would wait for a writer.
  if (!std::filesystem::is_regular_file(find_input(file))) {
    throw InputError({"file.kind", "the file is not a regular file", file.string(), "use a regular file"});
  }
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || fstat(descriptor, &status) != 0) {
    if (descriptor >= 0) close(descriptor);
    throw InputError({"file.open", "the file cannot be opened", file.string(), "check its permissions"});
  }
  const auto size = static_cast<size_t>(status.st_size);
  void* memory = size > 0 ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0) : nullptr;
  close(descriptor);
  if (size == 0) throw InputError({"file.empty", "the file is empty", file.string(), "write it again"});
  if (memory == MAP_FAILED) throw InputError({"file.read", "the file cannot be read", file.string(), "check the disk"});
  bytes_ = {static_cast<const std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
  munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace promin
