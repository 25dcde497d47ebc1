// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_jpeg.h"

#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

namespace promin {

JpegEncoder::JpegEncoder(PictureBytes& bytes, const uvec2& size) : bytes_(bytes), size_(size) {
  pixels_.reserve(size_t{3} * size.x * size.y);
}

void JpegEncoder::write_rows(std::span<const uint8_t> pixels) {
  pixels_.insert(pixels_.end(), pixels.begin(), pixels.end());
}

void JpegEncoder::finish() {
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  unsigned char* file = nullptr;
  unsigned long count = 0;  // NOLINT(google-runtime-int): libjpeg-turbo's
  const int failure =
      tjCompress2(encoder.get(), pixels_.data(), static_cast<int>(size_.x), 0, static_cast<int>(size_.y), TJPF_RGB,
                  &file, &count, TJSAMP_444, kQuality, TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(file, tjFree);
  if (failure != 0) throw std::runtime_error(tjGetErrorStr2(encoder.get()));
  if (!bytes_.write(std::as_bytes(std::span(file, count)))) bytes_.check();
}

}  // namespace promin
