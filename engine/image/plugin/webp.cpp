// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/own_formats.h"

#include <webp/decode.h>
#include <webp/encode.h>

#include <memory>
#include <stdexcept>
#include <string>

std::pair<uint32_t, uint32_t> read_webp_size(std::span<const unsigned char> file) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK) {
    throw std::runtime_error("its header is damaged");
  }
  if (features.has_animation != 0) throw std::runtime_error("it is animated");
  return {static_cast<uint32_t>(features.width), static_cast<uint32_t>(features.height)};
}

void read_webp(std::span<const unsigned char> file, std::span<unsigned char> pixels) {
  const auto [width, height] = read_webp_size(file);
  if (pixels.size() != size_t{4} * width * height ||
      WebPDecodeRGBAInto(file.data(), file.size(), pixels.data(), pixels.size(), static_cast<int>(4 * width)) ==
          nullptr) {
    throw std::runtime_error("its pixels are damaged");
  }
}

std::vector<unsigned char> make_webp(const unsigned char* pixels, uint32_t width, uint32_t height, uint32_t channels) {
  const auto encode = channels == 4 ? WebPEncodeRGBA : WebPEncodeRGB;
  uint8_t* file = nullptr;
  const size_t size = encode(pixels, static_cast<int>(width), static_cast<int>(height),
                             static_cast<int>(channels * width), kWebpQuality, &file);
  const std::unique_ptr<uint8_t, void (*)(void*)> owner(file, WebPFree);
  if (size == 0) {
    throw std::runtime_error("the sides of a WebP are limited to " + std::to_string(WEBP_MAX_DIMENSION) + " pixels");
  }
  return {file, file + size};
}
