// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_by_plugin.h"

#include <new>
#include <stdexcept>

#include "image/open_pictures.h"

namespace promin {

PluginEncoder::PluginEncoder(std::filesystem::path file, std::string_view format, const uvec2& size, size_t pixel_bytes)
    : file_(std::move(file)), format_(format), size_(size), pixel_bytes_(pixel_bytes) {
  open_pictures();
  pixels_.reserve(pixel_bytes * size.x * size.y);
}

void PluginEncoder::write_rows(std::span<const std::byte> pixels) {
  pixels_.insert(pixels_.end(), pixels.begin(), pixels.end());
}

void PluginEncoder::finish() {
  const size_t channels = format_ == "hdr" ? pixel_bytes_ / sizeof(float) : pixel_bytes_;
  ProminPicturesMessage message;
  const int status = open_pictures().write(file_.c_str(), format_.c_str(), size_.x, size_.y,
                                           static_cast<uint32_t>(channels), pixels_.data(), &message);
  if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
  if (status != PROMIN_PICTURES_DONE) throw std::runtime_error(message.text);
}

}  // namespace promin
