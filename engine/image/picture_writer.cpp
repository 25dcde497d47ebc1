// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/picture_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "core/file.h"
#include "core/parallel.h"
#include "image/encode_by_plugin.h"
#include "image/encode_exr.h"
#include "image/encode_jpeg.h"
#include "image/encode_png.h"
#include "image/encode_shown.h"
#include "image/picture_bytes.h"
#include "image/picture_endings.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

const Channel* find_channel(std::span<const Channel> channels, std::string_view name) {
  const auto found = std::ranges::find(channels, name, &Channel::name);
  return found == channels.end() ? nullptr : &*found;
}

/// The number of words of an EXR that the encoder receives at a time. It is many rows, or few if a picture is wide and
/// has many channels.
constexpr size_t kMostWords = size_t{4} << 20;

/// Returns the pixels [begin, end) one after the other. A pixel has its channels in the order of the EXR's header, with
/// four bytes each.
std::vector<uint32_t> interleave(const Image& image, std::span<const Channel> channels, size_t begin, size_t end) {
  const size_t stride = 3 + channels.size();
  std::vector<uint32_t> words((end - begin) * stride);
  constexpr size_t kChunk = 16384;
  for_each_chunk(end - begin, kChunk, 0, [&](size_t first, size_t last) {
    for (size_t i = begin + first; i < begin + last; ++i) {
      uint32_t* word = &words[(i - begin) * stride];
      for (int c = 0; c < 3; ++c) *word++ = std::bit_cast<uint32_t>(image.pixels[i][c]);
      for (const Channel& channel : channels) *word++ = channel.values[i];
    }
  });
  return words;
}

/// Returns the name of the picture's scene; empty if the metadata has no such entry.
std::string find_scene(const Metadata& metadata) {
  const auto found = std::ranges::find(metadata, kSceneKey, &Metadata::value_type::first);
  return found == metadata.end() ? "" : found->second;
}

void check(ProblemCode code, bool is_so, const std::string& what, const char* cure) {
  if (!is_so) throw UsageError({code, what, "", cure});
}

/// Throws UsageError if the parts of a picture have different sizes, because encoders read as much as the sizes state.
void check_rows(const Image& image, std::span<const Channel> channels) {
  const size_t pixel_count = static_cast<size_t>(image.size.x) * image.size.y;
  check("picture.empty", pixel_count > 0, "the picture has no pixels", "give it a width and a height");
  check("picture.size", image.pixels.size() == pixel_count,
        "the picture has " + std::to_string(image.pixels.size()) + " pixels, but its size requires " +
            std::to_string(pixel_count),
        "give width times height pixels");
  for (const Channel& channel : channels) {
    check("picture.size", channel.values.size() == pixel_count,
          "the number of values of channel " + channel.name + " is " + std::to_string(channel.values.size()) +
              ", but the number of pixels is " + std::to_string(pixel_count),
          "give one value for each pixel");
  }
}

void check_header(const PictureHeader& header) {
  check("picture.empty", header.size.x > 0 && header.size.y > 0, "the picture has no pixels",
        "give it a width and a height");
  if (!header.crop) return;
  const CropPlacement& crop = *header.crop;
  const auto is_within = [](uint32_t lo, uint32_t size, uint32_t whole) { return lo <= whole && size <= whole - lo; };
  check("picture.crop",
        is_within(crop.lo.x, header.size.x, crop.full_size.x) && is_within(crop.lo.y, header.size.y, crop.full_size.y),
        "the crop extends beyond the whole picture", "give the crop's position and the size of the whole picture");
}

}  // namespace

std::span<const std::string_view> exr_compression_names() {
  static constexpr std::array<std::string_view, 5> kNames = {"none", "rle", "zips", "zip", "piz"};
  return kNames;
}

bool is_writable_format(const fs::path& file) {
  return has_named_channels(file) || is_jpeg(file) || lower_case_ending(file) == ".png" ||
         !plugin_format_of(file).empty();
}

bool has_named_channels(const fs::path& file) {
  return lower_case_ending(file) == ".exr";
}

class PictureWriter::Impl {
 public:
  Impl(const fs::path& file, const PictureHeader& header)
      : file_(file), header_(header), output_(file), bytes_(output_.temporary(), file) {
    encode([&] {
      if (has_named_channels(file)) {
        exr_.emplace(bytes_, header);
      } else if (is_jpeg(file)) {
        jpeg_.emplace(bytes_, header.size);
      } else if (const std::string_view format = plugin_format_of(file); !format.empty()) {
        const size_t pixel_bytes = is_radiance(file) ? sizeof(vec3) : size_t{has_alpha() ? 4U : 3U};
        plugin_.emplace(output_.temporary(), format, header.size, pixel_bytes);
      } else {
        png_.emplace(bytes_, header.size, has_alpha(), find_scene(header.metadata));
      }
    });
  }

  void write_rows(const Image& rows, std::span<const Channel> channels) {
    check_rows(rows, channels);
    check("picture.rows", rows.size.x == header_.size.x && rows.size.y <= header_.size.y - rows_written_,
          "the rows do not match the picture's size", "give as many rows as the picture has, each of its width");
    check("picture.channels", channels.size() == header_.channels.size(),
          "the rows have other channels than the picture", "give values for all channels that were named");
    if (exr_) {
      const size_t width = rows.size.x;
      const size_t most_rows = std::max<size_t>(kMostWords / (width * (3 + channels.size())), 1);
      for (size_t y = 0; y < rows.size.y; y += most_rows) {
        const size_t end = std::min<size_t>(rows.size.y, y + most_rows);
        const std::vector<uint32_t> words = interleave(rows, channels, y * width, end * width);
        encode([&] { exr_->write_rows(words); });
      }
    } else if (plugin_ && is_radiance(file_)) {
      plugin_->write_rows(std::as_bytes(std::span(rows.pixels)));
    } else {
      const uvec2 lo = (header_.crop ? header_.crop->lo : uvec2(0)) + uvec2(0, rows_written_);
      // A JPEG has no alpha, so the picture is stored in front of black.
      const std::vector<uint8_t> pixels = encode_shown(rows, channels, header_.display, lo, !jpeg_ && has_alpha());
      encode([&] {
        if (plugin_) return plugin_->write_rows(std::as_bytes(std::span(pixels)));
        jpeg_ ? jpeg_->write_rows(pixels) : png_->write_rows(pixels);
      });
    }
    rows_written_ += rows.size.y;
  }

  void commit() {
    check("picture.rows", rows_written_ == header_.size.y, "rows of the picture are missing",
          "write all rows before finishing");
    encode([&] {
      if (plugin_) return plugin_->finish();
      exr_ ? exr_->finish() : jpeg_ ? jpeg_->finish() : png_->finish();
    });
    bytes_.close();
    output_.commit();
  }

 private:
  bool has_alpha() const { return find_channel(header_.channels, "A") != nullptr; }

  template <typename Work>
  void encode(const Work& work) const {
    try {
      work();
    } catch (const Error&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw RunError({"picture.encode", std::string("the picture cannot be encoded (") + error.what() + ")",
                      file_.string(), "try another format, such as .exr or .png"});
    }
  }

  fs::path file_;
  PictureHeader header_;
  AtomicFile output_;
  PictureBytes bytes_;
  // Exactly one of these encoders exists. It is declared last, so that it is destroyed before the bytes to which it
  // writes.
  std::optional<ExrEncoder> exr_;
  std::optional<JpegEncoder> jpeg_;
  std::optional<PngEncoder> png_;
  std::optional<PluginEncoder> plugin_;
  uint32_t rows_written_ = 0;
};

PictureWriter::PictureWriter(const fs::path& file, const PictureHeader& header) {
  if (!is_writable_format(file)) {
    throw UsageError({"output.extension", "the output's extension \"" + file.extension().string() + "\" is unknown",
                      file.string(), kUseKnownEnding});
  }
  check_header(header);
  impl_ = std::make_unique<Impl>(file, header);
}
PictureWriter::~PictureWriter() = default;
PictureWriter::PictureWriter(PictureWriter&&) noexcept = default;
PictureWriter& PictureWriter::operator=(PictureWriter&&) noexcept = default;

void PictureWriter::write_rows(const Image& rows, std::span<const Channel> channels) {
  impl_->write_rows(rows, channels);
}

void PictureWriter::commit() {
  impl_->commit();
}

void write_image(const fs::path& file, const Image& image, const Metadata& metadata,
                 const std::optional<CropPlacement>& crop, std::span<const Channel> channels,
                 const DisplayTransform& display, const ExrOptions& exr) {
  if (is_writable_format(file)) check_rows(image, channels);
  PictureHeader header{image.size, crop, metadata, {}, display, exr};
  for (const Channel& channel : channels) {
    header.channels.push_back({channel.name, channel.is_integer, {}, channel.is_hidden});
  }
  PictureWriter writer(file, header);
  writer.write_rows(image, channels);
  writer.commit();
}

}  // namespace promin
