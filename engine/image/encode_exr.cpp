// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_exr.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
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
#include "core/scratch_file.h"
#include "image/exr_parts.h"

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

struct FileChannel {
  std::string name;
  Imf::PixelType type = Imf::FLOAT;
  /// Its place among a pixel's words.
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

std::vector<FileChannel> list_channels(const PictureHeader& header) {
  const Imf::PixelType color = header.exr.is_half ? Imf::HALF : Imf::FLOAT;
  std::vector<FileChannel> result = {{"R", color, 0}, {"G", color, 1}, {"B", color, 2}};
  size_t word = result.size();
  for (const Channel& channel : header.channels) {
    const bool is_half = header.exr.is_half && takes_half(channel);
    const Imf::PixelType type = channel.is_integer ? Imf::UINT : is_half ? Imf::HALF : Imf::FLOAT;
    if (!channel.is_hidden) result.push_back({channel.name, type, word});
    ++word;
  }
  return result;
}

/// A part of an EXR, or the whole.
struct Part {
  std::string name;
  std::vector<FileChannel> channels;
  /// Where its rows wait in the scratch, as those of all parts but the first do.
  uint64_t scratch_place = 0;

  size_t pixel_bytes() const {
    size_t bytes = 0;
    for (const FileChannel& channel : channels) bytes += bytes_of(channel.type);
    return bytes;
  }
};

std::vector<Part> make_parts(const PictureHeader& header) {
  std::vector<Part> parts;
  for (const FileChannel& channel : list_channels(header)) {
    const std::string name = header.exr.is_multipart ? part_of_channel(channel.name) : "";
    auto part = std::ranges::find(parts, name, &Part::name);
    if (part == parts.end()) part = parts.insert(part, {name, {}});
    part->channels.push_back(channel);
  }
  return parts;
}

Imf::Compression compression_of(ExrCompression compression) {
  static constexpr std::array kCompressions = {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION};
  return kCompressions[static_cast<size_t>(compression)];
}

/// The rows that are compressed together.
size_t rows_of_block(Imf::Compression compression) {
  return compression == Imf::ZIP_COMPRESSION ? 16 : compression == Imf::PIZ_COMPRESSION ? 32 : 1;
}

/// The bytes of a block of rows of all parts: no part frees its blocks before the file is complete.
size_t count_block_bytes(const PictureHeader& header, const std::vector<Part>& parts, Imf::Compression compression) {
  size_t row_bytes = 0;
  for (const Part& part : parts) row_bytes += part.pixel_bytes() * header.size.x;
  return rows_of_block(compression) * row_bytes;
}

/// Replaces "zip" by "zips", the same for single rows, where a picture is wide and has many channels: blocks would take
/// more memory than all else, or one thread would compress them. Such files are hardly larger, because a row of one
/// channel is about as long as the 32 KiB that the compressor looks back. The choice must not depend on the machine,
/// because the file's bytes depend on the choice.
Imf::Compression fit_compression(const PictureHeader& header, const std::vector<Part>& parts) {
  constexpr size_t kMostBytes = size_t{8} << 20;
  const Imf::Compression compression = compression_of(header.exr.compression);
  const bool is_large = count_block_bytes(header, parts, compression) > kMostBytes;
  return compression == Imf::ZIP_COMPRESSION && is_large ? Imf::ZIPS_COMPRESSION : compression;
}

/// How many threads compress an EXR; 0 means the caller's thread alone. OpenEXR holds two blocks of rows for each
/// thread, and three copies of each block.
unsigned count_threads(size_t block_bytes) {
  constexpr size_t kMostBytes = size_t{128} << 20;
  constexpr size_t kCopies = 2 * 3;
  return static_cast<unsigned>(std::min<size_t>(kMostBytes / (kCopies * block_bytes), core_count()));
}

/// Grows OpenEXR's pool to this number of threads, or to as many as the system starts, and returns the number. It adds
/// one thread at a time, because OpenEXR's pool survives a failure to start one thread, but not a failure to start the
/// second of two.
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

Imf::Header make_header(const PictureHeader& header, const Part& part, Imf::Compression compression) {
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
  for (const FileChannel& channel : part.channels) result.channels().insert(channel.name, Imf::Channel(channel.type));
  if (part.name.empty()) return result;
  result.setName(part.name);
  result.setType(Imf::SCANLINEIMAGE);
  return result;
}

/// The nearest, or the largest that is finite; what is not a number stays so.
half to_half(uint32_t word) {
  const auto value = std::bit_cast<float>(word);
  constexpr float kLargestHalf = 65504.0F;
  if (value > kLargestHalf) return {kLargestHalf};
  return value < -kLargestHalf ? half(-kLargestHalf) : half(value);
}

/// The part's channels of some pixels, as the file keeps them.
std::vector<char> pick(const Part& part, size_t word_count, std::span<const uint32_t> words) {
  const size_t stride = part.pixel_bytes();
  const size_t pixel_count = words.size() / word_count;
  std::vector<char> picked(pixel_count * stride);
  char* to = picked.data();
  for (const FileChannel& channel : part.channels) {
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
  Impl(PictureBytes& bytes, const PictureHeader& header, const std::filesystem::path& target)
      : size_(header.size),
        lo_(header.crop ? header.crop->lo : uvec2(0)),
        word_count_(3 + header.channels.size()),
        bytes_(bytes),
        stream_(bytes),
        parts_(make_parts(header)) {
    const Imf::Compression compression = fit_compression(header, parts_);
    const int threads = grow_pool(count_threads(count_block_bytes(header, parts_, compression)));
    std::vector<Imf::Header> headers;
    for (const Part& part : parts_) headers.push_back(make_header(header, part, compression));
    if (headers.size() > 1) keep_rows(target);
    translate([&] {
      if (!header.exr.is_multipart) {
        single_.emplace(stream_, headers.front(), threads);
      } else {
        several_.emplace(stream_, headers.data(), static_cast<int>(headers.size()), false, threads);
      }
    });
  }

  void write_rows(std::span<const uint32_t> words) {
    const size_t row_count = words.size() / (word_count_ * size_.x);
    const auto is_word = [](const FileChannel& channel) { return channel.type != Imf::HALF; };
    for (const Part& part : parts_) {
      if (part.channels.size() == word_count_ && std::ranges::all_of(part.channels, is_word)) {
        encode(part, row_, row_count, reinterpret_cast<const char*>(words.data()));
        continue;
      }
      const std::vector<char> native = pick(part, word_count_, words);
      if (&part == &parts_.front()) {
        encode(part, row_, row_count, native.data());
      } else {
        waiting_->write(part.scratch_place + row_ * row_bytes(part), std::as_bytes(std::span(native)));
      }
    }
    row_ += row_count;
  }

  void finish() {
    for (const Part& part : std::span(parts_).subspan(1)) encode_waiting(part);
    // Offsets of rows are written at the end, where OpenEXR does not report failures.
    single_.reset();
    several_.reset();
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

  size_t row_bytes(const Part& part) const { return part.pixel_bytes() * size_.x; }

  void keep_rows(const std::filesystem::path& target) {
    uint64_t waiting_bytes = 0;
    for (Part& part : std::span(parts_).subspan(1)) {
      part.scratch_place = waiting_bytes;
      waiting_bytes += row_bytes(part) * size_.y;
    }
    waiting_.emplace(target, waiting_bytes);
  }

  /// Encodes rows of a part, as the file keeps them.
  void encode(const Part& part, size_t first_row, size_t row_count, const char* native) {
    const size_t pixel_bytes = part.pixel_bytes();
    const IMATH_NAMESPACE::V2i origin(static_cast<int>(lo_.x), static_cast<int>(lo_.y + first_row));
    Imf::FrameBuffer frame;
    for (const FileChannel& channel : part.channels) {
      frame.insert(channel.name, Imf::Slice::Make(channel.type, native, origin, size_.x,
                                                  static_cast<int64_t>(row_count), pixel_bytes, row_bytes(part)));
      native += bytes_of(channel.type);
    }
    translate([&] {
      if (single_) {
        single_->setFrameBuffer(frame);
        single_->writePixels(static_cast<int>(row_count));
        return;
      }
      Imf::OutputPart output(*several_, static_cast<int>(&part - parts_.data()));
      output.setFrameBuffer(frame);
      output.writePixels(static_cast<int>(row_count));
    });
  }

  /// Encodes a part whose rows were kept until the end, in groups of rows.
  void encode_waiting(const Part& part) {
    constexpr size_t kMostBytes = size_t{16} << 20;
    // A multiple of those by which EXRs are compressed.
    constexpr size_t kLeastRows = 32;
    const size_t rows = std::max(kMostBytes / row_bytes(part) / kLeastRows, size_t{1}) * kLeastRows;
    std::vector<char> native;
    for (size_t row = 0; row < row_; row += rows) {
      const size_t count = std::min(rows, row_ - row);
      native.resize(count * row_bytes(part));
      waiting_->read(part.scratch_place + row * row_bytes(part), std::as_writable_bytes(std::span(native)));
      encode(part, row, count, native.data());
    }
  }

  uvec2 size_;
  /// Where the pixels lie in the whole picture.
  uvec2 lo_;
  size_t word_count_;
  PictureBytes& bytes_;
  ByteStream stream_;
  std::vector<Part> parts_;
  /// Rows of all parts but the first: a file has one part after the other.
  std::optional<ScratchFile> waiting_;
  size_t row_ = 0;
  std::optional<Imf::OutputFile> single_;
  std::optional<Imf::MultiPartOutputFile> several_;
};

ExrEncoder::ExrEncoder(PictureBytes& bytes, const PictureHeader& header, const std::filesystem::path& target)
    : impl_(std::make_unique<Impl>(bytes, header, target)) {}
ExrEncoder::~ExrEncoder() = default;

void ExrEncoder::write_rows(std::span<const uint32_t> words) {
  impl_->write_rows(words);
}

void ExrEncoder::finish() {
  impl_->finish();
}

}  // namespace promin
