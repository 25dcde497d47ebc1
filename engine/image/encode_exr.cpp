// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_exr.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/parallel.h"

namespace promin {
namespace {

constexpr size_t kWordBytes = sizeof(uint32_t);

/// Passes encoded bytes to the file.
class ByteStream final : public Imf::OStream {
 public:
  explicit ByteStream(PictureBytes& bytes) : OStream("the picture"), bytes_(bytes) {}

  void write(const char* bytes, int count) override {
    const bool is_written = bytes_.write(std::as_bytes(std::span(bytes, static_cast<size_t>(count))));
    if (!is_written) throw IEX_NAMESPACE::IoExc("the file cannot be written");
  }
  uint64_t tellp() override { return bytes_.place(); }
  void seekp(uint64_t place) override { bytes_.seek(place); }

 private:
  PictureBytes& bytes_;
};

struct ExrChannel {
  std::string name;
  Imf::PixelType type = Imf::FLOAT;
  /// Index of the channel among a pixel's words.
  size_t word = 0;
};

size_t bytes_of(Imf::PixelType type) {
  return type == Imf::HALF ? sizeof(half) : kWordBytes;
}

/// Returns whether 16-bit floats are precise enough for a channel: for colours, normals and coverage, but not for
/// distances, positions or ids.
bool takes_half(const Channel& channel) {
  if (channel.is_integer || channel.name.starts_with("Crypto")) return false;
  const std::string group = channel.name.substr(0, channel.name.find('.'));
  static constexpr std::array kInFull = {"Z", "P", "UV", "error"};
  return std::ranges::find(kInFull, group) == kInFull.end();
}

std::vector<ExrChannel> list_channels(const PictureHeader& header) {
  const Imf::PixelType color = header.exr.is_half ? Imf::HALF : Imf::FLOAT;
  std::vector<ExrChannel> result = {{"R", color, 0}, {"G", color, 1}, {"B", color, 2}};
  size_t word = result.size();
  for (const Channel& channel : header.channels) {
    const bool is_half = header.exr.is_half && takes_half(channel);
    const Imf::PixelType type = channel.is_integer ? Imf::UINT : is_half ? Imf::HALF : Imf::FLOAT;
    if (!channel.is_hidden) result.push_back({channel.name, type, word});
    ++word;
  }
  return result;
}

size_t count_pixel_bytes(const std::vector<ExrChannel>& channels) {
  size_t bytes = 0;
  for (const ExrChannel& channel : channels) bytes += bytes_of(channel.type);
  return bytes;
}

Imf::Compression compression_of(ExrCompression compression) {
  static constexpr std::array kCompressions = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION};
  return kCompressions[static_cast<size_t>(compression)];
}

/// Returns the number of rows that are compressed together.
size_t rows_of_block(Imf::Compression compression) {
  return compression == Imf::ZIP_COMPRESSION ? 16 : compression == Imf::PIZ_COMPRESSION ? 32 : 1;
}

size_t count_block_bytes(const PictureHeader& header, size_t pixel_bytes, Imf::Compression compression) {
  return rows_of_block(compression) * pixel_bytes * header.size.x;
}

/// Replaces "zip" by "zips", the same compression for single rows, if a picture is wide and has many channels. Blocks
/// would otherwise use more memory than everything else, or one thread would compress all of them. Such files are
/// hardly larger, because a row of one channel is about as long as the 32 KiB that the compressor looks back. The
/// choice must not depend on the machine, because the file's bytes depend on the choice.
Imf::Compression fit_compression(const PictureHeader& header, size_t pixel_bytes) {
  constexpr size_t kMostBytes = size_t{8} << 20;
  const Imf::Compression compression = compression_of(header.exr.compression);
  const bool is_large = count_block_bytes(header, pixel_bytes, compression) > kMostBytes;
  return compression == Imf::ZIP_COMPRESSION && is_large ? Imf::ZIPS_COMPRESSION : compression;
}

/// Returns the number of threads that compress an EXR; 0 means only the caller's thread. For each thread, OpenEXR holds
/// two blocks of rows, and three copies of each block.
unsigned count_threads(size_t block_bytes) {
  constexpr size_t kMostBytes = size_t{128} << 20;
  constexpr size_t kCopies = 2 * 3;
  return static_cast<unsigned>(std::min<size_t>(kMostBytes / (kCopies * block_bytes), core_count()));
}

/// Enlarges OpenEXR's pool of threads to this number, or to as many threads as the system starts. Returns the number of
/// threads. It adds one thread at a time, because OpenEXR's pool survives a failure to start one thread, but not a
/// failure to start the second of two.
int grow_pool(unsigned count) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const int wanted = static_cast<int>(count);
  try {
    while (Imf::globalThreadCount() < wanted) Imf::setGlobalThreadCount(Imf::globalThreadCount() + 1);
  } catch (const std::system_error&) {
  }
  return std::min(Imf::globalThreadCount(), wanted);
}

Imf::Header make_header(const PictureHeader& header, const std::vector<ExrChannel>& channels,
                        Imf::Compression compression) {
  const IMATH_NAMESPACE::V2i size(static_cast<int>(header.size.x), static_cast<int>(header.size.y));
  const CropPlacement whole{uvec2(0), header.size};
  const CropPlacement& crop = header.crop.value_or(whole);
  const IMATH_NAMESPACE::V2i lo(static_cast<int>(crop.lo.x), static_cast<int>(crop.lo.y));
  const IMATH_NAMESPACE::V2i full(static_cast<int>(crop.full_size.x), static_cast<int>(crop.full_size.y));
  const IMATH_NAMESPACE::V2i one(1);
  Imf::Header result({IMATH_NAMESPACE::V2i(0), full - one}, {lo, lo + size - one});
  result.compression() = compression;
  Imf::addCapDate(result, "");
  for (const auto& [name, value] : header.metadata) result.insert(name, Imf::StringAttribute(value));
  for (const ExrChannel& channel : channels) result.channels().insert(channel.name, Imf::Channel(channel.type));
  return result;
}

/// Returns the nearest 16-bit float, at most the largest finite one. NaN stays NaN.
half to_half(uint32_t word) {
  const auto value = std::bit_cast<float>(word);
  constexpr float kLargestHalf = 65504.0F;
  if (value > kLargestHalf) return {kLargestHalf};
  return value < -kLargestHalf ? half(-kLargestHalf) : half(value);
}

/// Returns the channels of some pixels in the format of the file.
std::vector<char> pick(const std::vector<ExrChannel>& channels, size_t word_count, std::span<const uint32_t> words) {
  const size_t stride = count_pixel_bytes(channels);
  const size_t pixel_count = words.size() / word_count;
  std::vector<char> picked(pixel_count * stride);
  char* to = picked.data();
  for (const ExrChannel& channel : channels) {
    for (size_t i = 0; i < pixel_count; ++i) {
      const uint32_t word = words[i * word_count + channel.word];
      if (channel.type == Imf::HALF) {
        const half value = to_half(word);
        std::memcpy(to + i * stride, &value, sizeof value);
      } else {
        std::memcpy(to + i * stride, &word, kWordBytes);
      }
    }
    to += bytes_of(channel.type);
  }
  return picked;
}

}  // namespace

class ExrEncoder::Impl {
 public:
  Impl(PictureBytes& bytes, const PictureHeader& header)
      : size_(header.size),
        lo_(header.crop ? header.crop->lo : uvec2(0)),
        word_count_(3 + header.channels.size()),
        bytes_(bytes),
        stream_(bytes),
        channels_(list_channels(header)),
        pixel_bytes_(count_pixel_bytes(channels_)) {
    const Imf::Compression compression = fit_compression(header, pixel_bytes_);
    const int threads = grow_pool(count_threads(count_block_bytes(header, pixel_bytes_, compression)));
    translate([&] { output_.emplace(stream_, make_header(header, channels_, compression), threads); });
  }

  void write_rows(std::span<const uint32_t> words) {
    const size_t row_count = words.size() / (word_count_ * size_.x);
    const auto is_word = [](const ExrChannel& channel) { return channel.type != Imf::HALF; };
    if (channels_.size() == word_count_ && std::ranges::all_of(channels_, is_word)) {
      encode(row_count, reinterpret_cast<const char*>(words.data()));
    } else {
      encode(row_count, pick(channels_, word_count_, words).data());
    }
    row_ += row_count;
  }

  void finish() {
    // The destructor writes the offsets of rows. OpenEXR does not report failures there.
    output_.reset();
    bytes_.check();
  }

 private:
  template <typename Work>
  void translate(const Work& work) const {
    try {
      work();
    } catch (const IEX_NAMESPACE::BaseExc& error) {
      bytes_.check();
      throw std::runtime_error(error.what());
    }
  }

  /// Encodes the next rows, which are in the format of the file.
  void encode(size_t row_count, const char* native) {
    const IMATH_NAMESPACE::V2i origin(static_cast<int>(lo_.x), static_cast<int>(lo_.y + row_));
    Imf::FrameBuffer frame;
    for (const ExrChannel& channel : channels_) {
      frame.insert(channel.name,
                   Imf::Slice::Make(channel.type, native, origin, size_.x, static_cast<int64_t>(row_count),
                                    pixel_bytes_, pixel_bytes_ * size_.x));
      native += bytes_of(channel.type);
    }
    translate([&] {
      output_->setFrameBuffer(frame);
      output_->writePixels(static_cast<int>(row_count));
    });
  }

  uvec2 size_;
  /// Position of the pixels in the whole picture.
  uvec2 lo_;
  size_t word_count_;
  PictureBytes& bytes_;
  ByteStream stream_;
  std::vector<ExrChannel> channels_;
  size_t pixel_bytes_;
  size_t row_ = 0;
  std::optional<Imf::OutputFile> output_;
};

ExrEncoder::ExrEncoder(PictureBytes& bytes, const PictureHeader& header)
    : impl_(std::make_unique<Impl>(bytes, header)) {}
ExrEncoder::~ExrEncoder() = default;

void ExrEncoder::write_rows(std::span<const uint32_t> words) {
  impl_->write_rows(words);
}

void ExrEncoder::finish() {
  impl_->finish();
}

}  // namespace promin
