// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_png.h"

#include <csetjmp>
#include <cstring>
#include <new>
#include <stdexcept>

namespace promin {
namespace {

void take_bytes(png_structp png, png_bytep from, size_t count) {
  auto& bytes = *static_cast<PictureBytes*>(png_get_io_ptr(png));
  if (!bytes.write({reinterpret_cast<const std::byte*>(from), count})) png_error(png, "the file cannot be written");
}

[[noreturn]] void take_error(png_structp png, png_const_charp message) {
  auto& error = *static_cast<std::array<char, 256>*>(png_get_error_ptr(png));
  std::strncpy(error.data(), message, error.size() - 1);
  png_longjmp(png, 1);
}

void take_warning(png_structp, png_const_charp) {}

void flush(png_structp) {}

}  // namespace

PngEncoder::PngEncoder(PictureBytes& bytes, const uvec2& size, bool has_alpha, const std::string& scene)
    : bytes_(bytes), scene_(scene) {
  png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error_, take_error, take_warning);
  if (png_ != nullptr) info_ = png_create_info_struct(png_);
  if (info_ == nullptr) {
    png_destroy_write_struct(&png_, nullptr);
    throw std::bad_alloc();
  }
  png_set_write_fn(png_, &bytes_, take_bytes, flush);
  try {
    write_header(size, has_alpha);
  } catch (...) {
    png_destroy_write_struct(&png_, &info_);
    throw;
  }
}

PngEncoder::~PngEncoder() {
  png_destroy_write_struct(&png_, &info_);
}

void PngEncoder::fail() const {
  bytes_.check();
  throw std::runtime_error(error_.data());
}

void PngEncoder::write_header(const uvec2& size, bool has_alpha) {
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  constexpr int kCompression = 6;
  constexpr int kBits = 8;
  png_set_IHDR(png_, info_, size.x, size.y, kBits, has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png_, kCompression);
  png_set_compression_strategy(png_, 0);
  png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
  png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
  png_set_oFFs(png_, info_, 0, 0, PNG_OFFSET_PIXEL);
  // The key that OpenImageIO wrote in earlier versions. It is kept so that equal pictures still give equal files.
  std::array<char, 16> key{"oiio:ColorSpace"};
  std::array<char, 5> text{"sRGB"};
  std::array<png_text, 2> notes{};
  notes[0].compression = PNG_TEXT_COMPRESSION_NONE;
  notes[0].key = key.data();
  notes[0].text = text.data();
  notes[0].text_length = text.size() - 1;
  notes[1].compression = PNG_ITXT_COMPRESSION_NONE;
  notes[1].key = scene_key_.data();
  notes[1].text = scene_.data();
  notes[1].itxt_length = scene_.size();
  // The language is empty.
  notes[1].lang = notes[1].lang_key = scene_key_.data() + scene_key_.size();
  png_set_text(png_, info_, notes.data(), scene_.empty() ? 1 : 2);
  png_write_info(png_, info_);
}

void PngEncoder::write_rows(std::span<const uint8_t> pixels) {
  const size_t row_bytes = png_get_rowbytes(png_, info_);
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  for (size_t at = 0; at < pixels.size(); at += row_bytes) png_write_row(png_, pixels.data() + at);
}

void PngEncoder::finish() {
  if (setjmp(png_jmpbuf(png_)) != 0) fail();
  png_write_end(png_, nullptr);
}

}  // namespace promin
