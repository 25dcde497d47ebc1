// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "image/plugin/etc1s.h"
#include "image/plugin/own_formats.h"
#include "image/plugin/uastc.h"

// The numbers come from the Khronos Texture File Format Specification 2.0 and from Vulkan's VkFormat.
namespace {

using Bytes = std::span<const unsigned char>;

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

/// Returns bytes of the file. Throws if the file ends before them.
Bytes bytes_at(Bytes file, uint64_t place, uint64_t count) {
  if (place > file.size() || count > file.size() - place) throw std::runtime_error("it ends too early");
  return file.subspan(place, count);
}

template <typename Number>
Number number_at(Bytes file, uint64_t place) {
  Number number{};
  std::memcpy(&number, bytes_at(file, place, sizeof number).data(), sizeof number);
  return number;
}

/// The bytes of a pixel: the number of channels and their order.
struct Layout {
  uint32_t channel_count;
  bool is_bgr;
};

std::optional<Layout> layout_of(uint32_t vk_format) {
  switch (vk_format) {
    case 9:   // VK_FORMAT_R8_UNORM
    case 15:  // VK_FORMAT_R8_SRGB
      return Layout{1, false};
    case 16:  // VK_FORMAT_R8G8_UNORM
    case 22:  // VK_FORMAT_R8G8_SRGB
      return Layout{2, false};
    case 23:  // VK_FORMAT_R8G8B8_UNORM
    case 29:  // VK_FORMAT_R8G8B8_SRGB
      return Layout{3, false};
    case 30:  // VK_FORMAT_B8G8R8_UNORM
    case 36:  // VK_FORMAT_B8G8R8_SRGB
      return Layout{3, true};
    case 37:  // VK_FORMAT_R8G8B8A8_UNORM
    case 43:  // VK_FORMAT_R8G8B8A8_SRGB
      return Layout{4, false};
    case 44:  // VK_FORMAT_B8G8R8A8_UNORM
    case 50:  // VK_FORMAT_B8G8R8A8_SRGB
      return Layout{4, true};
    default:
      return std::nullopt;
  }
}

constexpr const char* kCure = " is not read; make a PNG of it, for example by `ktx extract`";

/// Colour models and channels of Khronos' data format descriptors.
constexpr uint8_t kEtc1s = 163;
constexpr uint8_t kUastc = 166;
constexpr uint8_t kEtc1sGreen = 4;

struct Header {
  uint32_t width;
  uint32_t height;
  /// The colour model if the file has no VkFormat; otherwise 0.
  uint8_t basis_model;
  Layout layout;
  uint32_t supercompression;
};

constexpr uint32_t kBasisLz = 1;
constexpr uint32_t kZstd = 2;

/// Returns a byte of the data format descriptor.
uint8_t descriptor_byte(Bytes file, uint64_t place) {
  constexpr uint64_t kDescriptorAt = 48;
  return number_at<uint8_t>(file, number_at<uint32_t>(file, kDescriptorAt) + place);
}

Header read_header(Bytes file) {
  const auto field = [&](uint64_t index) { return number_at<uint32_t>(file, 12 + 4 * index); };
  const uint32_t vk_format = field(0);
  // Fields 4, 5 and 6 are the depth, the number of layers and the number of faces.
  if (field(4) > 1 || field(5) > 1 || field(6) > 1) throw std::runtime_error("it is not a two-dimensional picture");
  Header header = {field(2), field(3), 0, {}, field(8)};
  constexpr uint64_t kColorModelAt = 12;
  if (vk_format == 0) header.basis_model = descriptor_byte(file, kColorModelAt);
  const bool is_etc1s = header.basis_model == kEtc1s && header.supercompression == kBasisLz;
  if (is_etc1s) return header;
  if (header.supercompression != 0 && header.supercompression != kZstd) {
    throw std::runtime_error("supercompression " + std::to_string(header.supercompression) + kCure);
  }
  if (header.basis_model == kUastc) return header;
  const std::optional<Layout> layout = layout_of(vk_format);
  if (!layout) throw std::runtime_error("VkFormat " + std::to_string(vk_format) + kCure);
  header.layout = *layout;
  return header;
}

/// Returns the value of a key in the file's key/value data, without its terminating zero; empty if there is no such
/// key.
std::string_view find_value(Bytes file, std::string_view key) {
  const auto field = [&](uint64_t place) { return number_at<uint32_t>(file, place); };
  Bytes notes = bytes_at(file, field(56), field(60));
  while (notes.size() > sizeof(uint32_t)) {
    const auto length = number_at<uint32_t>(notes, 0);
    const Bytes note = bytes_at(notes, sizeof length, length);
    const std::string_view text(reinterpret_cast<const char*>(note.data()), note.size());
    const size_t end = text.find('\0');
    if (text.substr(0, end) == key && end < text.size()) {
      const std::string_view value = text.substr(end + 1);
      return value.substr(0, value.find('\0'));
    }
    notes = notes.subspan(std::min<size_t>(notes.size(), sizeof length + (uint64_t{length} + 3) / 4 * 4));
  }
  return {};
}

/// Returns the stored bytes of the largest level, which may be compressed.
Bytes stored_level(Bytes file) {
  constexpr uint64_t kLevelsAt = 80;
  return bytes_at(file, number_at<uint64_t>(file, kLevelsAt), number_at<uint64_t>(file, kLevelsAt + sizeof(uint64_t)));
}

/// Returns the level, decompressed if Zstandard compressed it; it must have `byte_count` bytes.
std::vector<unsigned char> read_level(Bytes file, const Header& header, uint64_t byte_count) {
  const Bytes stored = stored_level(file);
  if (header.supercompression == 0) {
    if (stored.size() != byte_count) throw std::runtime_error("the size of its level does not match its pixels");
    return {stored.begin(), stored.end()};
  }
  std::vector<unsigned char> level(byte_count);
  if (ZSTD_decompress(level.data(), level.size(), stored.data(), stored.size()) != level.size()) {
    throw std::runtime_error("its Zstandard data is damaged");
  }
  return level;
}

void read_etc1s(Bytes file, const Header& header, std::span<unsigned char> pixels) {
  constexpr uint64_t kGlobalsAt = 64;
  constexpr uint64_t kDescriptorBytesAt = 52;
  constexpr uint64_t kSecondChannelAt = 28 + 16 + 3;
  const Bytes globals =
      bytes_at(file, number_at<uint64_t>(file, kGlobalsAt), number_at<uint64_t>(file, kGlobalsAt + sizeof(uint64_t)));
  const bool has_second = number_at<uint32_t>(file, kDescriptorBytesAt) > kSecondChannelAt;
  const bool is_green = has_second && (descriptor_byte(file, kSecondChannelAt) & 15) == kEtc1sGreen;
  decode_etc1s({header.width, header.height, globals, stored_level(file), is_green}, pixels);
}

void read_uastc(Bytes file, const Header& header, std::span<unsigned char> pixels) {
  constexpr size_t kBlockBytes = 16;
  const uint64_t column_count = (uint64_t{header.width} + 3) / 4;
  const uint64_t block_count = column_count * ((uint64_t{header.height} + 3) / 4);
  const std::vector<unsigned char> level = read_level(file, header, block_count * kBlockBytes);
  for (uint64_t i = 0; i < block_count; ++i) {
    const auto texels = decode_uastc(std::span<const unsigned char, kBlockBytes>(&level[i * kBlockBytes], kBlockBytes));
    for (uint64_t k = 0; k < texels.size(); ++k) {
      const uint64_t x = i % column_count * 4 + k % 4;
      const uint64_t y = i / column_count * 4 + k / 4;
      if (x >= header.width || y >= header.height) continue;
      std::copy(texels[k].begin(), texels[k].end(), &pixels[4 * (y * header.width + x)]);
    }
  }
}

/// Returns for each channel of a pixel whether it shows red, green, blue, alpha, 0 or 1: "rgba" unless the file has
/// another swizzle.
std::array<size_t, 4> read_swizzle(Bytes file) {
  constexpr std::string_view kNames = "rgba01";
  std::array<size_t, 4> swizzle = {0, 1, 2, 3};
  const std::string_view text = find_value(file, "KTXswizzle");
  if (text.size() != swizzle.size()) return swizzle;
  for (size_t i = 0; i < swizzle.size(); ++i) swizzle[i] = std::min(kNames.find(text[i]), kNames.size() - 1);
  return swizzle;
}

void read_plain(Bytes file, const Header& header, std::span<unsigned char> pixels) {
  const auto [count, is_bgr] = header.layout;
  const uint64_t pixel_count = uint64_t{header.width} * header.height;
  const std::vector<unsigned char> level = read_level(file, header, pixel_count * count);
  const std::array<size_t, 4> swizzle = read_swizzle(file);
  const std::string_view orientation = find_value(file, "KTXorientation");
  const bool is_from_bottom = orientation.size() > 1 && orientation[1] == 'u';
  for (uint64_t i = 0; i < pixel_count; ++i) {
    std::array<unsigned char, 6> values = {0, 0, 0, 255, 0, 255};
    std::copy_n(&level[i * count], count, values.begin());
    if (is_bgr) std::swap(values[0], values[2]);
    const uint64_t row = i / header.width;
    const uint64_t to = is_from_bottom ? (header.height - 1 - row) * header.width + i % header.width : i;
    for (size_t channel = 0; channel < 4; ++channel) pixels[4 * to + channel] = values[swizzle[channel]];
  }
}

}  // namespace

std::pair<uint32_t, uint32_t> read_ktx2_size(Bytes file) {
  const Header header = read_header(file);
  return {header.width, header.height};
}

void read_ktx2(Bytes file, std::span<unsigned char> pixels) {
  const Header header = read_header(file);
  if (header.basis_model == kEtc1s) return read_etc1s(file, header, pixels);
  if (header.basis_model == kUastc) return read_uastc(file, header, pixels);
  read_plain(file, header, pixels);
}
