// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/file.h"
#include "promin/error.h"

namespace promin {

ScratchFile::ScratchFile(std::filesystem::path target, uint64_t byte_count)
    : target_(std::move(target)), byte_count_(byte_count) {
  // The name has the form of a temporary file, so that clear_leftovers() removes it if the process is killed before it
  // unlinks the file.
  const AtomicFile named(target_);
  descriptor_ = open(named.temporary().c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ < 0) fail(errno);
  int error = unlink(named.temporary().c_str()) == 0 ? 0 : errno;
  if (error == 0 && byte_count > 0 && fallocate(descriptor_, 0, 0, static_cast<off_t>(byte_count)) != 0) {
    // If the file system cannot reserve space, there may still be enough.
    error = errno == EOPNOTSUPP || errno == ENOSYS || errno == EINTR ? 0 : errno;
  }
  if (error == 0) return;
  close(descriptor_);
  fail(error);
}

ScratchFile::~ScratchFile() {
  close(descriptor_);
}

void ScratchFile::fail(int error) const {
  constexpr double kMega = 1e6;
  const auto mega = static_cast<uint64_t>(static_cast<double>(byte_count_) / kMega) + 1;
  throw RunError({"file.room",
                  "there is no room for " + std::to_string(mega) +
                      " MB beside the output file until it can be written (" + std::strerror(error) + ")",
                  target_.string(), "check the disk and permissions"});
}

void ScratchFile::write(uint64_t place, std::span<const std::byte> bytes) {
  const int error = write_at(descriptor_, place, bytes);
  if (error != 0) fail(error);
}

void ScratchFile::read(uint64_t place, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t taken = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) fail(taken < 0 ? errno : EIO);
    place += static_cast<uint64_t>(taken);
    bytes = bytes.subspan(static_cast<size_t>(taken));
  }
}

}  // namespace promin
