// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/picture_bytes.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/file.h"
#include "promin/error.h"

namespace promin {
namespace {

constexpr size_t kGatheredBytes = size_t{64} << 10;

}  // namespace

PictureBytes::PictureBytes(const std::filesystem::path& file, std::filesystem::path target)
    : target_(std::move(target)), descriptor_(open(file.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) error_ = errno;
  check();
  gathered_.reserve(kGatheredBytes);
}

PictureBytes::~PictureBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PictureBytes::flush() noexcept {
  if (error_ == 0) error_ = write_at(descriptor_, begin_, gathered_);
  begin_ += gathered_.size();
  gathered_.clear();
}

bool PictureBytes::write(std::span<const std::byte> bytes) noexcept {
  if (gathered_.size() + bytes.size() > kGatheredBytes) flush();
  if (bytes.size() > kGatheredBytes) {
    if (error_ == 0) error_ = write_at(descriptor_, begin_, bytes);
    begin_ += bytes.size();
  } else {
    gathered_.insert(gathered_.end(), bytes.begin(), bytes.end());
  }
  return error_ == 0;
}

void PictureBytes::seek(uint64_t place) noexcept {
  flush();
  begin_ = place;
}

void PictureBytes::check() const {
  if (error_ == 0) return;
  throw RunError({"file.write", std::string("the output file cannot be written (") + std::strerror(error_) + ")",
                  target_.string(), "check the disk and permissions"});
}

void PictureBytes::close() {
  flush();
  if (::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  check();
}

}  // namespace promin
