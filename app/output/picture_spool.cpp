// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/picture_spool.h"

#include <bit>
#include <span>

#include "trace/film/refinement.h"

namespace promin::app {

PictureSpool::PictureSpool(const std::filesystem::path& file, const PixelWindow& window, std::vector<Channel> channels)
    : window_(window),
      channels_(std::move(channels)),
      file_(file, area_of(window) * words_per_pixel() * sizeof(uint32_t)) {}

uint64_t PictureSpool::place_of(const uvec2& pixel) const {
  const uvec2 place = pixel - window_.lo;
  const uint64_t index = uint64_t{place.y} * (window_.hi.x - window_.lo.x) + place.x;
  return index * words_per_pixel() * sizeof(uint32_t);
}

void PictureSpool::write(const PixelWindow& part, const Image& image, const std::vector<Channel>& channels) {
  const size_t width = part.hi.x - part.lo.x;
  std::vector<uint32_t> words(width * words_per_pixel());
  for (uint32_t y = part.lo.y; y < part.hi.y; ++y) {
    const size_t first = (y - part.lo.y) * width;
    uint32_t* word = words.data();
    for (size_t i = first; i < first + width; ++i) {
      for (int c = 0; c < 3; ++c) *word++ = std::bit_cast<uint32_t>(image.pixels[i][c]);
      for (const Channel& channel : channels) *word++ = channel.values[i];
    }
    file_.write(place_of({part.lo.x, y}), std::as_bytes(std::span(words)));
  }
}

PictureRows PictureSpool::read(const PixelWindow& band) const {
  PictureRows rows{{band.hi - band.lo, {}}, channels_};
  const size_t count = area_of(band);
  std::vector<uint32_t> words(count * words_per_pixel());
  file_.read(place_of(band.lo), std::as_writable_bytes(std::span(words)));
  rows.image.pixels.resize(count);
  for (Channel& channel : rows.channels) channel.values.resize(count);
  const uint32_t* word = words.data();
  for (size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) rows.image.pixels[i][c] = std::bit_cast<float>(*word++);
    for (Channel& channel : rows.channels) channel.values[i] = *word++;
  }
  return rows;
}

}  // namespace promin::app
