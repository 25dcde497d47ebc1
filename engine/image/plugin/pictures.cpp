// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/pictures.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "image/plugin/own_formats.h"
#include "image/plugin/upright.h"

struct ProminPicturesReader {
  /// The bytes of a file that is read without OpenImageIO, and its format. For all other files there is an `input`.
  std::span<const unsigned char> own;
  const OwnFormat* own_format = nullptr;
  /// The bytes of a file in memory that OpenImageIO reads.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
  int first_channel = -1;
  /// Name of the part that was described last.
  std::string part_name;
  std::vector<std::string> channel_names;
  std::vector<ProminPicturesChannel> channels;
};

namespace {

/// Returns the first line of an explanation: OpenImageIO's explanations may have several lines, but promin's errors
/// have one.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void tell(ProminPicturesMessage& message, std::string_view text) {
  const size_t size = std::min(text.size(), sizeof message.text - 1);
  std::memcpy(message.text, text.data(), size);
  message.text[size] = '\0';
}

/// Runs the body of a call and converts exceptions to a status; no exception leaves this function.
template <typename Body>
int guard(ProminPicturesMessage* message, const Body& body) noexcept {
  try {
    body();
    return PROMIN_PICTURES_DONE;
  } catch (const std::bad_alloc&) {
    return PROMIN_PICTURES_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    tell(*message, error.what());
  } catch (...) {
    tell(*message, "the reason is unknown");
  }
  return PROMIN_PICTURES_FAILED;
}

/// Returns the index of the R, G, B triple among a file's channels, or of a luminance without chroma; -1 if the file
/// has neither.
int find_rgb(const OIIO::ImageSpec& spec) {
  const auto& names = spec.channelnames;
  for (int first = 0; first + 2 < spec.nchannels; ++first) {
    const auto i = static_cast<size_t>(first);
    if (names[i] == "R" && names[i + 1] == "G" && names[i + 2] == "B") return first;
  }
  const bool has_chroma = std::ranges::count(names, "RY") + std::ranges::count(names, "BY") > 0;
  const auto luminance = std::ranges::find(names, "Y");
  if (!has_chroma && luminance != names.end()) return static_cast<int>(luminance - names.begin());
  return -1;
}

bool is_flat(const OIIO::ImageSpec& spec) {
  return spec.width >= 1 && spec.height >= 1 && spec.depth <= 1 && !spec.deep;
}

bool is_exr(const ProminPicturesReader& reader) {
  return std::string_view(reader.input->format_name()) == "openexr";
}

/// Returns options for opening files. Without them some readers multiply colours by alpha.
OIIO::ImageSpec keep_alpha_apart() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

ProminPicturesInfo describe(ProminPicturesReader& reader) {
  const OIIO::ImageSpec& spec = reader.input->spec();
  reader.first_channel = find_rgb(spec);
  // In formats other than EXR, several parts are successive pictures, so only the first counts.
  const int parts = is_exr(reader) ? std::max(spec.get_int_attribute("oiio:subimages", 1), 1) : 1;
  return {is_flat(spec) ? static_cast<uint64_t>(spec.width) : 0, is_flat(spec) ? static_cast<uint64_t>(spec.height) : 0,
          is_flat(spec) ? 1U : 0U, reader.first_channel, static_cast<uint32_t>(parts)};
}

/// Returns whether a channel's integers are read as integers, because they are ids, and not as fractions of the largest
/// integer.
bool is_integer(const ProminPicturesReader& reader, const OIIO::TypeDesc& type) {
  return is_exr(reader) && type == OIIO::TypeDesc::UINT32;
}

OIIO::ImageSpec part_spec(ProminPicturesReader& reader, uint32_t part) {
  if (!reader.input) throw std::runtime_error("the file has no parts");
  if (!reader.input->seek_subimage(static_cast<int>(part), 0)) {
    const std::string why = first_line(reader.input->geterror());
    throw std::runtime_error(why.empty() ? "a part of it cannot be read" : why);
  }
  return reader.input->spec();
}

ProminPicturesPart describe_part(ProminPicturesReader& reader, uint32_t part) {
  const OIIO::ImageSpec spec = part_spec(reader, part);
  reader.part_name = spec.get_string_attribute("oiio:subimagename").c_str();
  reader.channel_names = spec.channelnames;
  reader.channels.clear();
  for (int i = 0; i < spec.nchannels; ++i) {
    const bool has_integers = is_integer(reader, spec.channelformat(i));
    reader.channels.push_back({reader.channel_names[static_cast<size_t>(i)].c_str(),
                               static_cast<uint32_t>(has_integers ? PROMIN_PICTURES_UINT32 : PROMIN_PICTURES_FLOAT)});
  }
  return {static_cast<uint64_t>(std::max(spec.width, 0)),
          static_cast<uint64_t>(std::max(spec.height, 0)),
          is_flat(spec) ? 1U : 0U,
          reader.part_name.c_str(),
          reader.channels.data(),
          reader.channels.size()};
}

/// Rows `begin` to `end` of a part in the format of the file. The rows are numbered as in the part, and `first` is the
/// first row in the data.
struct NativeRows {
  std::vector<unsigned char> bytes;
  size_t skipped_bytes = 0;
};

NativeRows read_native(ProminPicturesReader& reader, uint32_t part, const OIIO::ImageSpec& spec, int begin, int end) {
  OIIO::ImageInput& input = *reader.input;
  const size_t row_bytes = spec.scanline_bytes(true);
  NativeRows rows;
  bool is_read = false;
  if (spec.tile_height > 0) {
    // Tiles can only be read whole.
    const int first = begin / spec.tile_height * spec.tile_height;
    const int last = std::min((end + spec.tile_height - 1) / spec.tile_height * spec.tile_height, spec.height);
    rows.bytes.resize(static_cast<size_t>(last - first) * row_bytes);
    rows.skipped_bytes = static_cast<size_t>(begin - first) * row_bytes;
    is_read = input.read_tiles(static_cast<int>(part), 0, spec.x, spec.x + spec.width, spec.y + first, spec.y + last,
                               spec.z, spec.z + 1, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, rows.bytes.data());
  } else {
    rows.bytes.resize(static_cast<size_t>(end - begin) * row_bytes);
    is_read = input.read_scanlines(static_cast<int>(part), 0, spec.y + begin, spec.y + end, spec.z, 0, spec.nchannels,
                                   OIIO::TypeDesc::UNKNOWN, rows.bytes.data());
  }
  if (!is_read) throw std::runtime_error(first_line(input.geterror()));
  return rows;
}

void read_rows(ProminPicturesReader& reader, uint32_t part, uint32_t first_row, uint32_t row_count, uint32_t* values) {
  const OIIO::ImageSpec spec = part_spec(reader, part);
  const auto begin = static_cast<int>(first_row);
  const auto end = static_cast<int>(first_row + row_count);
  const NativeRows rows = read_native(reader, part, spec, begin, end);
  const auto stride = static_cast<OIIO::stride_t>(spec.pixel_bytes(true));
  const auto channel_count = static_cast<size_t>(spec.nchannels);
  const auto value_stride = static_cast<OIIO::stride_t>(channel_count * sizeof(uint32_t));
  const unsigned char* from = rows.bytes.data() + rows.skipped_bytes;
  for (size_t i = 0; i < channel_count; ++i) {
    const OIIO::TypeDesc type = spec.channelformat(static_cast<int>(i));
    // For integers both types are equal, so the conversion is a copy.
    const OIIO::TypeDesc to = is_integer(reader, type) ? type : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT);
    const bool is_done =
        OIIO::convert_image(1, spec.width, end - begin, 1, from, type, stride, OIIO::AutoStride, OIIO::AutoStride,
                            values + i, to, value_stride, OIIO::AutoStride, OIIO::AutoStride);
    if (!is_done) throw std::runtime_error("its number format is unknown");
    from += type.size();
  }
}

/// Returns the number of channels that are read to make RGBA: grey; grey and alpha; colours; or colours and alpha.
int count_rgba(const OIIO::ImageSpec& spec) {
  const int count = std::min(spec.nchannels, 4);
  const bool has_alpha = spec.alpha_channel == count - 1;
  return count % 2 == 0 && !has_alpha ? count - 1 : count;
}

/// Extends each pixel from its first channels to all four channels.
void spread_channels(std::span<unsigned char> pixels, int count) {
  if (count == 4) return;
  for (size_t i = 0; i < pixels.size(); i += 4) {
    unsigned char* pixel = &pixels[i];
    pixel[3] = count == 2 ? pixel[1] : 255;
    if (count <= 2) pixel[1] = pixel[2] = pixel[0];
  }
}

void write_bytes(const char* file, std::span<const unsigned char> bytes) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush()) throw std::runtime_error("cannot write the file");
}

/// Writes a picture. `spec` has its size and its channels.
void write_picture(const char* file, const std::string& format, OIIO::ImageSpec spec, const void* pixels) {
  const bool is_light = format == "hdr";
  spec.set_format(is_light ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", is_light ? "Linear" : "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("compression", "zip");
  // Without this, the file would contain the time of writing, and equal pictures would give different files.
  spec.attribute("DateTime", "");
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) throw std::runtime_error(first_line(OIIO::geterror()));
  if (!output->open(file, spec) || !output->write_image(spec.format, pixels) || !output->close()) {
    throw std::runtime_error(first_line(output->geterror()));
  }
}

/// Draws a text. Throws std::runtime_error if the font cannot be used or the text cannot be drawn.
void draw_text(const char* font, const char* text, int width, int height, unsigned char* coverage) {
  // Height of a line of text, including descenders, relative to the size of its letters.
  constexpr double kLine = 1.35;
  constexpr int kLeastSize = 6;
  int size = std::max(static_cast<int>(height / kLine), kLeastSize);
  OIIO::ROI place = OIIO::ImageBufAlgo::text_size(text, size, font);
  while (place.defined() && place.width() > width && size > kLeastSize) {
    place = OIIO::ImageBufAlgo::text_size(text, --size, font);
  }
  OIIO::ImageBuf strip(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::UINT8), coverage);
  OIIO::ImageBufAlgo::zero(strip);
  const int x = std::max((width - place.width()) / 2 - place.xbegin, 0);
  const int y = (height + static_cast<int>(size / kLine)) / 2;
  if (!place.defined() || !OIIO::ImageBufAlgo::render_text(strip, x, y, text, size, font)) {
    throw std::runtime_error(strip.has_error() ? first_line(strip.geterror()) : "the text cannot be drawn");
  }
}

}  // namespace

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE;
}

int promin_pictures_open(const char* file, ProminPicturesReader** reader, ProminPicturesInfo* info,
                         ProminPicturesMessage* message) {
  *reader = nullptr;
  return guard(message, [&] {
    auto opened = std::make_unique<ProminPicturesReader>();
    const OIIO::ImageSpec config = keep_alpha_apart();
    opened->input = OIIO::ImageInput::open(file, &config);
    if (!opened->input) throw std::runtime_error(first_line(OIIO::geterror()));
    opened->input = make_upright(std::move(opened->input));
    *info = describe(*opened);
    *reader = opened.release();
  });
}

int promin_pictures_open_bytes(const void* bytes, size_t byte_count, const char* format, ProminPicturesReader** reader,
                               ProminPicturesInfo* info, ProminPicturesMessage* message) {
  *reader = nullptr;
  return guard(message, [&] {
    auto opened = std::make_unique<ProminPicturesReader>();
    if (const OwnFormat* own = find_own_format(format)) {
      opened->own = {static_cast<const unsigned char*>(bytes), byte_count};
      opened->own_format = own;
      const auto [width, height] = own->read_size(opened->own);
      *info = {width, height, 1, -1, 1};
      *reader = opened.release();
      return;
    }
    opened->memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, byte_count);
    opened->input = OIIO::ImageInput::create(format);
    if (!opened->input) throw std::runtime_error(first_line(OIIO::geterror()));
    const OIIO::ImageSpec config = keep_alpha_apart();
    OIIO::ImageSpec spec;
    const bool takes_memory = opened->input->supports("ioproxy") && opened->input->set_ioproxy(opened->memory.get());
    if (!takes_memory) throw std::runtime_error(std::string(format) + " cannot be read from memory");
    if (!opened->input->open(std::string("memory.") + format, spec, config)) {
      throw std::runtime_error(first_line(opened->input->geterror()));
    }
    opened->input = make_upright(std::move(opened->input));
    *info = describe(*opened);
    *reader = opened.release();
  });
}

int promin_pictures_read_rgba(ProminPicturesReader* reader, unsigned char* pixels, ProminPicturesMessage* message) {
  return guard(message, [&] {
    if (!reader->input) {
      const auto [width, height] = reader->own_format->read_size(reader->own);
      reader->own_format->read(reader->own, {pixels, size_t{4} * width * height});
      return;
    }
    const OIIO::ImageSpec& spec = reader->input->spec();
    const int count = count_rgba(spec);
    constexpr OIIO::stride_t kPixelStride = 4;
    if (!reader->input->read_image(0, 0, 0, count, OIIO::TypeDesc::UINT8, pixels, kPixelStride)) {
      throw std::runtime_error(first_line(reader->input->geterror()));
    }
    spread_channels({pixels, 4 * spec.image_pixels()}, count);
  });
}

int promin_pictures_read_rgb(ProminPicturesReader* reader, float* pixels, ProminPicturesMessage* message) {
  return guard(message, [&] {
    if (!reader->input) throw std::runtime_error(std::string(reader->own_format->name) + " holds no linear light");
    const OIIO::ImageSpec& spec = reader->input->spec();
    const int first = reader->first_channel;
    const int count = spec.channelnames[static_cast<size_t>(first)] == "Y" ? 1 : 3;
    constexpr OIIO::stride_t kPixelStride = 3 * sizeof(float);
    if (!reader->input->read_image(0, 0, first, first + count, OIIO::TypeDesc::FLOAT, pixels, kPixelStride)) {
      throw std::runtime_error(first_line(reader->input->geterror()));
    }
    for (size_t i = 0; count == 1 && i < 3 * spec.image_pixels(); i += 3) pixels[i + 1] = pixels[i + 2] = pixels[i];
  });
}

int promin_pictures_describe_part(ProminPicturesReader* reader, uint32_t part, ProminPicturesPart* info,
                                  ProminPicturesMessage* message) {
  return guard(message, [&] { *info = describe_part(*reader, part); });
}

int promin_pictures_read_rows(ProminPicturesReader* reader, uint32_t part, uint32_t first_row, uint32_t row_count,
                              void* pixels, ProminPicturesMessage* message) {
  return guard(message, [&] { read_rows(*reader, part, first_row, row_count, static_cast<uint32_t*>(pixels)); });
}

int promin_pictures_write(const char* file, const char* format, uint32_t width, uint32_t height, uint32_t channel_count,
                          const void* pixels, ProminPicturesMessage* message) {
  return guard(message, [&] {
    if (format == std::string_view("webp")) {
      const auto bytes = make_webp(static_cast<const unsigned char*>(pixels), width, height, channel_count);
      write_bytes(file, bytes);
    } else {
      write_picture(file, format,
                    OIIO::ImageSpec(static_cast<int>(width), static_cast<int>(height), static_cast<int>(channel_count)),
                    pixels);
    }
  });
}

int promin_pictures_draw_text(const char* font, const char* text, uint32_t width, uint32_t height,
                              unsigned char* coverage, ProminPicturesMessage* message) {
  return guard(message, [&] { draw_text(font, text, static_cast<int>(width), static_cast<int>(height), coverage); });
}

void promin_pictures_close(ProminPicturesReader* reader) {
  ProminPicturesMessage unread;
  guard(&unread, [&] { delete reader; });
}
