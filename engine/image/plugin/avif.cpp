// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <avif/avif.h>

#include <memory>
#include <new>
#include <stdexcept>

#include "image/plugin/own_formats.h"

namespace {

using Decoder = std::unique_ptr<avifDecoder, decltype(&avifDecoderDestroy)>;

void check(avifResult result) {
  if (result == AVIF_RESULT_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result != AVIF_RESULT_OK) throw std::runtime_error(avifResultToString(result));
}

/// Returns a decoder that has read the header of the file.
Decoder open_avif(std::span<const unsigned char> file) {
  Decoder decoder(avifDecoderCreate(), avifDecoderDestroy);
  if (!decoder) throw std::bad_alloc();
  // Accepts files without boxes that some encoders omit and that no decoder needs.
  decoder->strictFlags = AVIF_STRICT_DISABLED;
  check(avifDecoderSetIOMemory(decoder.get(), file.data(), file.size()));
  check(avifDecoderParse(decoder.get()));
  if (decoder->imageCount > 1) throw std::runtime_error("it is animated");
  return decoder;
}

}  // namespace

std::pair<uint32_t, uint32_t> read_avif_size(std::span<const unsigned char> file) {
  const Decoder decoder = open_avif(file);
  return {decoder->image->width, decoder->image->height};
}

void read_avif(std::span<const unsigned char> file, std::span<unsigned char> pixels) {
  const Decoder decoder = open_avif(file);
  check(avifDecoderNextImage(decoder.get()));
  const avifImage& image = *decoder->image;
  if (pixels.size() != size_t{4} * image.width * image.height)
    throw std::runtime_error("its sizes contradict each other");
  avifRGBImage rgba;
  avifRGBImageSetDefaults(&rgba, &image);
  rgba.format = AVIF_RGB_FORMAT_RGBA;
  rgba.depth = 8;
  rgba.pixels = pixels.data();
  rgba.rowBytes = 4 * image.width;
  check(avifImageYUVToRGB(&image, &rgba));
}
