// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/picture_formats.h"

#include <algorithm>
#include <array>
#include <limits>

namespace promin {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::array<PictureFormat, 15> kFormats = {{
    {"png", "\x89PNG\r\n\x1A\n"sv},
    {"jpeg", "\xFF\xD8\xFF"sv},
    {"webp", "RIFF????WEBP"sv},
    {"avif", "????ftypavif"sv},
    {"avif", "????ftypavis"sv},
    {"avif", "????ftypmif1"sv},
    {"ktx2", "\xABKTX 20\xBB\r\n\x1A\n"sv},
    {"bmp", "BM????????????\x0C"sv, 18, 20, 2},
    {"bmp", "BM"sv, 18, 22, 4},
    {"dds", "DDS "sv, 16, 12, 4},
    {"gif", "GIF87a"sv, 6, 8, 2},
    {"gif", "GIF89a"sv, 6, 8, 2},
    {"openexr", "\x76\x2F\x31\x01"sv},
    {"hdr", "#?RADIANCE"sv},
    {"hdr", "#?RGBE"sv},
}};
constexpr PictureFormat kTarga = {"targa", ""sv, 12, 14, 2};

uint32_t byte_at(std::span<const std::byte> file, size_t place) {
  return place < file.size() ? std::to_integer<uint32_t>(file[place]) : 0;
}

bool begins_with(std::span<const std::byte> file, std::string_view magic) {
  if (file.size() < magic.size()) return false;
  for (size_t i = 0; i < magic.size(); ++i) {
    if (magic[i] != '?' && byte_at(file, i) != static_cast<unsigned char>(magic[i])) return false;
  }
  return true;
}

/// Returns whether 18 bytes can be a Targa header: whether it has a valid palette entry, an existing kind of picture,
/// and a possible number of bits per pixel.
bool is_targa(std::span<const std::byte> file) {
  constexpr size_t kHeaderBytes = 18;
  constexpr std::array kKinds = {1U, 2U, 3U, 9U, 10U, 11U};
  constexpr std::array kDepths = {8U, 15U, 16U, 24U, 32U};
  return file.size() > kHeaderBytes && byte_at(file, 1) <= 1 &&
         std::ranges::find(kKinds, byte_at(file, 2)) != kKinds.end() &&
         std::ranges::find(kDepths, byte_at(file, 16)) != kDepths.end();
}

}  // namespace

const PictureFormat* find_picture_format(std::span<const std::byte> file) {
  for (const PictureFormat& format : kFormats) {
    if (begins_with(file, format.magic)) return &format;
  }
  return is_targa(file) ? &kTarga : nullptr;
}

bool holds_light(std::span<const std::byte> file) {
  const PictureFormat* format = find_picture_format(file);
  return format != nullptr && (format->name == "openexr"sv || format->name == "hdr"sv);
}

std::optional<uvec2> read_told_size(std::span<const std::byte> file, const PictureFormat& format) {
  if (format.size_bytes == 0) return std::nullopt;
  const auto number_at = [&](size_t place) {
    uint32_t number = 0;
    for (size_t i = 0; i < format.size_bytes; ++i) number |= byte_at(file, place + i) << (8 * i);
    // If the first row of a bitmap is the top row, its height is negative.
    return number > uint32_t{std::numeric_limits<int32_t>::max()} ? 0 - number : number;
  };
  return uvec2(number_at(format.width_at), number_at(format.height_at));
}

}  // namespace promin
