// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/picture_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include "core/file.h"
#include "core/parallel.h"
#include "core/scratch_file.h"
#include "image/dither.h"
#include "image/open_pictures.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

/// The name that OpenImageIO gives to the format of a file's ending; empty if promin does not write it.
const char* format_of(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".exr") return "openexr";
  if (ending == ".png") return "png";
  return "";
}

const Channel* find_alpha(std::span<const Channel> channels) {
  const auto alpha = std::ranges::find(channels, "A", &Channel::name);
  return alpha == channels.end() ? nullptr : &*alpha;
}

/// Of an EXR, what is handed over at a time: many rows, or of wide pictures with many channels few.
constexpr size_t kMostWords = size_t{4} << 20;

/// Pixels [begin, end) one after the other, with the channels in the order of the EXR's spec; each channel is four
/// bytes.
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

/// Of light that covers so much of its pixel, as PNG keeps it.
vec3 unassociated(const vec3& color, float alpha) {
  return alpha > 0.0F ? color / alpha : vec3(0.0F);
}

/// `lo` is the place of the upper left pixel in the whole picture.
std::vector<uint8_t> encode_pixels(const Image& image, const Channel* alpha, const DisplayTransform& display,
                                   const uvec2& lo) {
  const size_t stride = alpha == nullptr ? 3 : 4;
  std::vector<uint8_t> bytes(image.pixels.size() * stride);
  for_each_index(image.size.y, 0, [&](size_t y) {
    uint8_t* next = &bytes[stride * y * image.size.x];
    for (uint32_t x = 0; x < image.size.x; ++x) {
      const size_t at = y * image.size.x + x;
      const float covered = alpha == nullptr ? 1.0F : std::bit_cast<float>(alpha->values[at]);
      const vec3& color = image.pixels[at];
      const vec3 shown = apply(display, alpha == nullptr ? color : unassociated(color, covered));
      for (int channel = 0; channel < 3; ++channel) {
        float code = 255.0F * encode_srgb(shown[channel]);
        if (display.dithers) {
          code = dithered(code, lo.x + x, lo.y + static_cast<uint32_t>(y), static_cast<uint32_t>(channel));
        }
        *next++ = static_cast<uint8_t>(std::lround(code));
      }
      if (alpha != nullptr) *next++ = static_cast<uint8_t>(std::lround(255.0F * std::clamp(covered, 0.0F, 1.0F)));
    }
  });
  return bytes;
}

/// Whether halves keep a channel well enough: colours, normals and shares, no distances, places or numbers of things.
bool takes_half(const Channel& channel) {
  if (channel.is_integer || channel.name.starts_with("Crypto")) return false;
  const std::string group = channel.name.substr(0, channel.name.find('.'));
  static constexpr std::array kInFull = {"Z", "P", "UV", "error"};
  return std::ranges::find(kInFull, group) == kInFull.end();
}

std::vector<ProminPicturesChannel> list_channels(std::span<const Channel> channels, const ExrOptions& exr) {
  const uint32_t color = exr.is_half ? PROMIN_PICTURES_HALF : PROMIN_PICTURES_FLOAT;
  std::vector<ProminPicturesChannel> result = {{"R", color}, {"G", color}, {"B", color}};
  for (const Channel& channel : channels) {
    const uint32_t sample = channel.is_integer                   ? PROMIN_PICTURES_UINT32
                            : exr.is_half && takes_half(channel) ? PROMIN_PICTURES_HALF
                                                                 : PROMIN_PICTURES_FLOAT;
    result.push_back({channel.name.c_str(), sample});
  }
  return result;
}

void check(bool is_so, const std::string& what, const char* cure) {
  if (!is_so) throw UsageError({what, "in the picture to write", cure});
}

/// Throws UsageError where parts of a picture do not suit each other: the plugin reads by the sizes that it is told.
void check_rows(const Image& image, std::span<const Channel> channels) {
  const size_t pixel_count = static_cast<size_t>(image.size.x) * image.size.y;
  check(pixel_count > 0, "there are no pixels", "give it a width and a height");
  check(
      image.pixels.size() == pixel_count,
      "there are " + std::to_string(image.pixels.size()) + " pixels where its size has " + std::to_string(pixel_count),
      "give one for each place");
  for (const Channel& channel : channels) {
    check(channel.values.size() == pixel_count,
          "the channel " + channel.name + " has " + std::to_string(channel.values.size()) + " values for " +
              std::to_string(pixel_count) + " pixels",
          "give one for each pixel");
  }
}

void check_header(const PictureHeader& header) {
  check(header.size.x > 0 && header.size.y > 0, "there are no pixels", "give it a width and a height");
  if (!header.crop) return;
  const CropPlacement& crop = *header.crop;
  const auto is_within = [](uint32_t lo, uint32_t size, uint32_t whole) { return lo <= whole && size <= whole - lo; };
  check(is_within(crop.lo.x, header.size.x, crop.full_size.x) && is_within(crop.lo.y, header.size.y, crop.full_size.y),
        "the crop reaches beyond the whole picture", "give its place and the size of the whole");
}

}  // namespace

std::span<const std::string_view> exr_compression_names() {
  static constexpr std::array<std::string_view, 5> kNames = {"none", "rle", "zips", "zip", "piz"};
  return kNames;
}

bool is_writable_format(const fs::path& file) {
  return *format_of(file) != '\0';
}

bool has_named_channels(const fs::path& file) {
  return std::string_view(format_of(file)) == "openexr";
}

class PictureWriter::Impl {
 public:
  Impl(const fs::path& file, const PictureHeader& header)
      : file_(file),
        header_(header),
        is_exr_(has_named_channels(file)),
        plugin_(open_pictures()),
        output_(file),
        scratch_{file} {
    bytes_.descriptor = ::open(output_.temporary().c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
    if (bytes_.descriptor < 0) refuse_file(errno);
    std::vector<ProminPicturesChannel> channels = list_channels(header.channels, header.exr);
    if (!is_exr_) {
      channels = {{"R", PROMIN_PICTURES_UINT8}, {"G", PROMIN_PICTURES_UINT8}, {"B", PROMIN_PICTURES_UINT8}};
      if (find_alpha(header.channels) != nullptr) channels.push_back({"A", PROMIN_PICTURES_UINT8});
    }
    std::vector<ProminPicturesAttribute> attributes;
    for (const auto& [name, value] : header.metadata) attributes.push_back({name.c_str(), value.c_str()});
    // What OpenImageIO's explanations name, unless it writes to the file itself.
    const std::string name = header.exr.is_multipart ? output_.temporary().string() : file.filename().string();
    ProminPicturesSource source{};
    source.format = format_of(file);
    source.file_name = name.c_str();
    source.compression = exr_compression_names()[static_cast<size_t>(header.exr.compression)].data();
    source.is_multipart = header.exr.is_multipart ? 1 : 0;
    source.width = header.size.x;
    source.height = header.size.y;
    if (header.crop) {
      source.x = header.crop->lo.x;
      source.y = header.crop->lo.y;
      source.full_width = header.crop->full_size.x;
      source.full_height = header.crop->full_size.y;
    }
    source.channels = channels.data();
    source.channel_count = channels.size();
    source.attributes = attributes.data();
    source.attribute_count = is_exr_ ? attributes.size() : 0;
    const ProminPicturesSink sink{&bytes_, OpenFile::write};
    ProminPicturesWriter* begun = nullptr;
    const ProminPicturesScratch scratch{&scratch_, Scratch::reserve, Scratch::write, Scratch::read};
    check_done(plugin_.begin(&source, &sink, &scratch, &begun, &message_));
    writer_ = {begun, plugin_.end};
  }

  void write_rows(const Image& rows, std::span<const Channel> channels) {
    check_rows(rows, channels);
    check(rows.size.x == header_.size.x && rows.size.y <= header_.size.y - rows_written_,
          "rows do not suit the picture's size", "give as many as it has, of its width");
    check(channels.size() == header_.channels.size(), "rows have other channels than the picture",
          "give values of all that were named");
    if (is_exr_) {
      const size_t width = rows.size.x;
      const size_t most_rows = std::max<size_t>(kMostWords / (width * (3 + channels.size())), 1);
      for (size_t y = 0; y < rows.size.y; y += most_rows) {
        const size_t end = std::min<size_t>(rows.size.y, y + most_rows);
        const std::vector<uint32_t> words = interleave(rows, channels, y * width, end * width);
        check_done(plugin_.write_rows(writer_.get(), static_cast<uint32_t>(end - y), words.data(), &message_));
      }
    } else {
      const uvec2 lo = (header_.crop ? header_.crop->lo : uvec2(0)) + uvec2(0, rows_written_);
      const std::vector<uint8_t> bytes = encode_pixels(rows, find_alpha(channels), header_.display, lo);
      check_done(plugin_.write_rows(writer_.get(), rows.size.y, bytes.data(), &message_));
    }
    rows_written_ += rows.size.y;
  }

  void commit() {
    check(rows_written_ == header_.size.y, "rows of the picture are missing", "write all before the end");
    check_done(plugin_.finish(writer_.get(), &message_));
    if (!bytes_.close()) refuse_file(bytes_.error);
    output_.commit();
  }

 private:
  /// Where the plugin's bytes go.
  struct OpenFile {
    OpenFile() = default;
    ~OpenFile() { close(); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    /// As ProminPicturesSink::write; the context is one of these.
    static int write(void* context, uint64_t place, const void* bytes, size_t byte_count) {
      auto& file = *static_cast<OpenFile*>(context);
      const int error = write_at(file.descriptor, place, {static_cast<const std::byte*>(bytes), byte_count});
      if (error != 0) file.error = error;
      return error == 0 ? 1 : 0;
    }

    bool close() {
      if (descriptor < 0) return true;
      const bool is_closed = ::close(descriptor) == 0;
      if (!is_closed) error = errno;
      descriptor = -1;
      return is_closed;
    }

    int descriptor = -1;
    /// Why it cannot be written; 0 where it can.
    int error = 0;
  };

  /// What waits to be written; the contexts of its functions, which are ProminPicturesScratch's, are one of these.
  struct Scratch {
    static int reserve(void* context, uint64_t byte_count) {
      auto& scratch = *static_cast<Scratch*>(context);
      return scratch.attempt([&] { scratch.file.emplace(scratch.target, byte_count); });
    }
    static int write(void* context, uint64_t place, const void* bytes, size_t byte_count) {
      auto& scratch = *static_cast<Scratch*>(context);
      return scratch.attempt([&] { scratch.file->write(place, {static_cast<const std::byte*>(bytes), byte_count}); });
    }
    static int read(void* context, uint64_t place, void* bytes, size_t byte_count) {
      auto& scratch = *static_cast<Scratch*>(context);
      return scratch.attempt([&] { scratch.file->read(place, {static_cast<std::byte*>(bytes), byte_count}); });
    }

    template <typename Step>
    int attempt(const Step& step) noexcept {
      try {
        step();
        return 1;
      } catch (...) {
        failure = std::current_exception();
        return 0;
      }
    }

    fs::path target;
    std::optional<ScratchFile> file = std::nullopt;
    std::exception_ptr failure = nullptr;
  };

  [[noreturn]] void refuse_file(int error) const {
    throw RunError({std::string("cannot write the output file (") + std::strerror(error) + ")", file_.string(),
                    "check the disk and permissions"});
  }

  /// Why a file of several parts grows no further; 0 where it does. The plugin writes it by its name and not through
  /// OpenFile, and whether OpenEXR's words name the disk's error depends on its version: so the disk is asked, for more
  /// than OpenEXR writes at a time.
  int find_disk_error() const {
    if (!header_.exr.is_multipart) return 0;
    const off_t end = ::lseek(bytes_.descriptor, 0, SEEK_END);
    if (end < 0) return errno;
    constexpr size_t kStepBytes = 1 << 20;
    const std::vector<std::byte> zeros(kStepBytes);
    for (uint64_t step = 0; step < 64; ++step) {
      const int error = write_at(bytes_.descriptor, static_cast<uint64_t>(end) + step * kStepBytes, zeros);
      if (error != 0) return error;
    }
    return 0;
  }

  void check_done(int status) const {
    if (status == PROMIN_PICTURES_DONE) return;
    if (scratch_.failure) std::rethrow_exception(scratch_.failure);
    if (bytes_.error != 0) refuse_file(bytes_.error);
    if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
    if (const int error = find_disk_error(); error != 0) refuse_file(error);
    throw RunError({std::string("cannot encode the picture (") + message_.text + ")", file_.string(),
                    "try the other format, .exr or .png"});
  }

  fs::path file_;
  PictureHeader header_;
  bool is_exr_;
  const PicturesPlugin& plugin_;
  AtomicFile output_;
  OpenFile bytes_;
  Scratch scratch_;
  ProminPicturesMessage message_{};
  /// Gone before what it writes to.
  std::unique_ptr<ProminPicturesWriter, decltype(PicturesPlugin::end)> writer_{nullptr, nullptr};
  uint32_t rows_written_ = 0;
};

PictureWriter::PictureWriter(const fs::path& file, const PictureHeader& header) {
  if (!is_writable_format(file)) {
    throw UsageError({"unknown picture format " + file.extension().string(), file.string(), "use .exr or .png"});
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
  for (const Channel& channel : channels) header.channels.push_back({channel.name, channel.is_integer, {}});
  PictureWriter writer(file, header);
  writer.write_rows(image, channels);
  writer.commit();
}

}  // namespace promin
