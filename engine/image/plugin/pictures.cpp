// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/pictures.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "image/exr_parts.h"
#include "image/plugin/own_formats.h"
#include "image/plugin/upright.h"

struct ProminPicturesReader {
  /// A file in memory that is read without OpenImageIO, and its format; all else has an input.
  std::span<const unsigned char> own;
  const OwnFormat* own_format = nullptr;
  /// Another file in memory.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
  int first_channel = -1;
  /// Of the part that was described last.
  std::string part_name;
  std::vector<std::string> channel_names;
  std::vector<ProminPicturesChannel> channels;
};

namespace {

/// OpenImageIO's explanations may run over several lines; an error of ours is one.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

void tell(ProminPicturesMessage& message, std::string_view text) {
  const size_t size = std::min(text.size(), sizeof message.text - 1);
  std::memcpy(message.text, text.data(), size);
  message.text[size] = '\0';
}

/// Runs the body of a call, and makes a status of what it throws: nothing is thrown beyond this.
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
    tell(*message, "unknown failure");
  }
  return PROMIN_PICTURES_FAILED;
}

OIIO::TypeDesc type_of(uint32_t sample) {
  switch (sample) {
    case PROMIN_PICTURES_UINT8:
      return OIIO::TypeDesc::UINT8;
    case PROMIN_PICTURES_UINT32:
      return OIIO::TypeDesc::UINT32;
    case PROMIN_PICTURES_HALF:
      return OIIO::TypeDesc::HALF;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

/// Hands what is encoded to a sink.
class SinkProxy final : public OIIO::Filesystem::IOProxy {
 public:
  SinkProxy(const char* file_name, const ProminPicturesSink& sink) : IOProxy(file_name, Write), sink_(sink) {}

  const char* proxytype() const override { return "promin"; }
  size_t write(const void* bytes, size_t byte_count) override {
    const size_t written = pwrite(bytes, byte_count, m_pos);
    m_pos += static_cast<int64_t>(written);
    return written;
  }
  size_t pwrite(const void* bytes, size_t byte_count, int64_t place) override {
    if (sink_.write(sink_.context, static_cast<uint64_t>(place), bytes, byte_count) == 0) {
      is_full_ = true;
      return 0;
    }
    size_ = std::max(size_, static_cast<size_t>(place) + byte_count);
    return byte_count;
  }
  size_t size() const override { return size_; }
  /// Whether the sink has not taken something. OpenImageIO's PNG writer does not notice.
  bool is_full() const { return is_full_; }
  /// Has OpenImageIO leave a PNG as it is, whose end libpng would else write and, where no row has been, say on
  /// standard error that it cannot. What libpng holds is lost to the process.
  void give_up() { m_mode = Closed; }

 private:
  ProminPicturesSink sink_;
  size_t size_ = 0;
  bool is_full_ = false;
};

/// A part of an EXR, or the one picture.
struct Part {
  OIIO::ImageSpec spec;
  /// Places of its channels among the source's.
  std::vector<size_t> channels;
  /// Where its rows wait in the scratch, as those of all parts but the first do.
  uint64_t scratch_place = 0;
};

OIIO::ImageSpec make_exr_spec(const ProminPicturesSource& source) {
  OIIO::ImageSpec spec(static_cast<int>(source.width), static_cast<int>(source.height), 0, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", source.compression);
  // Without this the writer puts the time of day in, and equal pictures would differ.
  spec.attribute("DateTime", "");
  for (const ProminPicturesAttribute& attribute : std::span(source.attributes, source.attribute_count)) {
    spec.attribute(attribute.name, attribute.value);
  }
  if (source.full_width > 0) {
    spec.x = static_cast<int>(source.x);
    spec.y = static_cast<int>(source.y);
    spec.full_width = static_cast<int>(source.full_width);
    spec.full_height = static_cast<int>(source.full_height);
  }
  return spec;
}

std::vector<Part> make_exr_parts(const ProminPicturesSource& source) {
  std::vector<Part> parts;
  for (size_t i = 0; i < source.channel_count; ++i) {
    const ProminPicturesChannel& channel = source.channels[i];
    const std::string name = source.is_multipart != 0 ? promin::part_of_channel(channel.name) : "";
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const Part& p) { return p.spec.get_string_attribute("oiio:subimagename") == name; });
    if (part == parts.end()) {
      parts.push_back({make_exr_spec(source), {}});
      part = parts.end() - 1;
      if (!name.empty()) part->spec.attribute("oiio:subimagename", name);
    }
    part->channels.push_back(i);
    part->spec.channelnames.emplace_back(channel.name);
    part->spec.channelformats.push_back(type_of(channel.sample));
    ++part->spec.nchannels;
    if (std::string_view(channel.name) == "A") part->spec.alpha_channel = part->spec.nchannels - 1;
  }
  return parts;
}

/// The rows that are compressed together.
size_t rows_of_block(OIIO::string_view compression) {
  return compression == "zip" ? 16 : compression == "piz" ? 32 : 1;
}

/// The bytes of a block of rows of all parts: none gives its blocks back before the file is whole.
size_t count_block_bytes(const std::vector<Part>& parts, OIIO::string_view compression) {
  size_t row_bytes = 0;
  for (const Part& part : parts) row_bytes += part.spec.scanline_bytes(true);
  return rows_of_block(compression) * row_bytes;
}

/// Of wide pictures with many channels "zip" becomes "zips", the same for single rows: blocks would take more memory
/// than all else, or be compressed by one thread. Such files are hardly larger, as a row of a channel alone is about as
/// long as the 32 KiB that the compressor looks back. It must not depend on the machine, as the file's bytes hang on
/// it.
void fit_compression(std::vector<Part>& parts) {
  constexpr size_t kMostBytes = size_t{8} << 20;
  const std::string compression = parts.front().spec.get_string_attribute("compression");
  if (compression != "zip" || count_block_bytes(parts, compression) <= kMostBytes) return;
  for (Part& part : parts) part.spec.attribute("compression", "zips");
}

/// How many threads compress an EXR, as OpenImageIO takes it: 0 is one for each core, -1 none but the caller's. OpenEXR
/// holds two blocks of rows for each thread, and of each three copies.
int count_exr_threads(const std::vector<Part>& parts) {
  constexpr size_t kMostBytes = size_t{128} << 20;
  constexpr size_t kCopies = 2 * 3;
  const size_t block_bytes = count_block_bytes(parts, parts.front().spec.get_string_attribute("compression"));
  const size_t threads = kMostBytes / (kCopies * block_bytes);
  if (threads >= std::thread::hardware_concurrency()) return 0;
  return threads == 0 ? -1 : static_cast<int>(threads);
}

std::vector<Part> make_png_parts(const ProminPicturesSource& source) {
  Part part;
  part.spec = OIIO::ImageSpec(static_cast<int>(source.width), static_cast<int>(source.height),
                              static_cast<int>(source.channel_count), OIIO::TypeDesc::UINT8);
  part.spec.attribute("oiio:ColorSpace", "sRGB");
  part.spec.attribute("oiio:UnassociatedAlpha", 1);
  for (size_t i = 0; i < source.channel_count; ++i) part.channels.push_back(i);
  return {part};
}

}  // namespace

struct ProminPicturesWriter {
  ProminPicturesWriter(const ProminPicturesSource& source, const ProminPicturesSink& sink,
                       const ProminPicturesScratch& room)
      : is_exr(std::string_view(source.format) == "openexr"),
        file_name(source.file_name),
        proxy(source.file_name, sink),
        scratch(room),
        parts(is_exr ? make_exr_parts(source) : make_png_parts(source)) {
    for (const ProminPicturesChannel& channel : std::span(source.channels, source.channel_count)) {
      samples.push_back(channel.sample);
    }
    // The number of threads is heeded when an output is made.
    if (is_exr) {
      fit_compression(parts);
      OIIO::attribute("exr_threads", count_exr_threads(parts));
    }
    output = OIIO::ImageOutput::create(source.format);
    check(output != nullptr);
    if (parts.size() == 1) {
      check(output->set_ioproxy(&proxy));
      check(output->open(file_name, parts.front().spec));
      return;
    }
    uint64_t waiting_bytes = 0;
    for (Part& part : std::span(parts).subspan(1)) {
      part.scratch_place = waiting_bytes;
      waiting_bytes += part.spec.image_bytes(true);
    }
    check_scratch(scratch.reserve(scratch.context, waiting_bytes));
    // OpenImageIO 2.4 writes files of several parts by their names, whatever proxy there is.
    std::vector<OIIO::ImageSpec> specs;
    for (const Part& part : parts) specs.push_back(part.spec);
    check(output->open(file_name, static_cast<int>(specs.size()), specs.data()));
  }

  void check(bool is_done) const {
    if (proxy.is_full()) throw std::runtime_error("the file cannot be written");
    if (!is_done) throw std::runtime_error(first_line(output ? output->geterror() : OIIO::geterror()));
  }

  static void check_scratch(int is_done) {
    if (is_done == 0) throw std::runtime_error("what waits to be written cannot be kept");
  }

  /// Picks the part's channels of some pixels, as the file keeps them.
  std::vector<unsigned char> pick(const Part& part, size_t pixel_count, const unsigned char* pixels) const {
    const size_t sample_bytes = is_exr ? sizeof(uint32_t) : 1;
    const size_t stride = sample_bytes * samples.size();
    const size_t part_stride = part.spec.pixel_bytes(true);
    std::vector<unsigned char> picked(pixel_count * part_stride);
    size_t place = 0;
    for (const size_t channel : part.channels) {
      const OIIO::TypeDesc type = type_of(samples[channel]);
      const unsigned char* from = pixels + channel * sample_bytes;
      unsigned char* to = picked.data() + place;
      if (type == OIIO::TypeDesc::HALF) {
        put_halves(pixel_count, from, stride, to, part_stride);
      } else {
        for (size_t i = 0; i < pixel_count; ++i) std::memcpy(to + i * part_stride, from + i * stride, sample_bytes);
      }
      place += type.size();
    }
    return picked;
  }

  static void put_halves(size_t count, const unsigned char* from, size_t stride, unsigned char* to, size_t to_stride) {
    constexpr float kLargestHalf = 65504.0F;
    for (size_t i = 0; i < count; ++i) {
      float value = 0.0F;
      std::memcpy(&value, from + i * stride, sizeof value);
      // Not a number stays so.
      if (value > kLargestHalf) value = kLargestHalf;
      if (value < -kLargestHalf) value = -kLargestHalf;
      OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, &value, OIIO::TypeDesc::HALF, to + i * to_stride, 1);
    }
  }

  void write(const Part& part, uint32_t first_row, uint32_t row_count, const void* native) const {
    const int begin = part.spec.y + static_cast<int>(first_row);
    check(output->write_scanlines(begin, begin + static_cast<int>(row_count), 0,
                                  is_exr ? OIIO::TypeDesc::UNKNOWN : OIIO::TypeDesc::UINT8, native));
  }

  void write_rows(uint32_t row_count, const unsigned char* pixels) {
    const size_t pixel_count = static_cast<size_t>(parts.front().spec.width) * row_count;
    if (parts.size() == 1 && std::find(samples.begin(), samples.end(), PROMIN_PICTURES_HALF) == samples.end()) {
      write(parts.front(), next_row, row_count, pixels);
      next_row += row_count;
      return;
    }
    for (const Part& part : parts) {
      const std::vector<unsigned char> native = pick(part, pixel_count, pixels);
      if (&part == &parts.front()) {
        write(part, next_row, row_count, native.data());
      } else {
        const uint64_t place = part.scratch_place + next_row * part.spec.scanline_bytes(true);
        check_scratch(scratch.write(scratch.context, place, native.data(), native.size()));
      }
    }
    next_row += row_count;
  }

  /// Writes a part whose rows wait, some at a time.
  void write_waiting(const Part& part) const {
    constexpr size_t kMostBytes = size_t{16} << 20;
    // A multiple of those by which EXRs are compressed.
    constexpr size_t kLeastRows = 32;
    const size_t row_bytes = part.spec.scanline_bytes(true);
    const auto rows = static_cast<uint32_t>(std::max(kMostBytes / row_bytes / kLeastRows, size_t{1}) * kLeastRows);
    std::vector<unsigned char> native;
    for (uint32_t row = 0; row < next_row; row += rows) {
      const uint32_t count = std::min(rows, next_row - row);
      native.resize(count * row_bytes);
      check_scratch(scratch.read(scratch.context, part.scratch_place + row * row_bytes, native.data(), native.size()));
      write(part, row, count, native.data());
    }
  }

  void finish() {
    for (const Part& part : std::span(parts).subspan(1)) {
      check(output->open(file_name, part.spec, OIIO::ImageOutput::AppendSubimage));
      write_waiting(part);
    }
    check(output->close());
    // Close may have written more.
    check(true);
    end.is_finished = true;
  }

  bool is_exr;
  std::string file_name;
  SinkProxy proxy;
  ProminPicturesScratch scratch;
  std::vector<Part> parts;
  std::vector<uint32_t> samples;
  uint32_t next_row = 0;
  std::unique_ptr<OIIO::ImageOutput> output;
  /// Gives up what is not finished: the last member, so that it does before OpenImageIO closes the output.
  struct End {
    SinkProxy& proxy;
    bool is_finished = false;
    ~End() {
      if (!is_finished) proxy.give_up();
    }
  } end{proxy};
};

namespace {

/// The place of the R, G, B triple among a file's channels, or of a luminance without chroma; -1 if it has neither.
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

ProminPicturesInfo describe(ProminPicturesReader& reader) {
  const OIIO::ImageSpec& spec = reader.input->spec();
  reader.first_channel = find_rgb(spec);
  // What other formats have several of are pictures that follow each other.
  const int parts = is_exr(reader) ? std::max(spec.get_int_attribute("oiio:subimages", 1), 1) : 1;
  return {is_flat(spec) ? static_cast<uint64_t>(spec.width) : 0, is_flat(spec) ? static_cast<uint64_t>(spec.height) : 0,
          is_flat(spec) ? 1U : 0U, reader.first_channel, static_cast<uint32_t>(parts)};
}

/// Whether a channel's integers are told as such, not as parts of the largest: they say what a thing is, not how light.
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

/// Rows of a part as the file keeps them, from `begin` to `end` in the part's own count, and where these begin.
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
    // Tiles are read whole.
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
    // Of integers the same type on both sides: a copy.
    const OIIO::TypeDesc to = is_integer(reader, type) ? type : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT);
    const bool is_done =
        OIIO::convert_image(1, spec.width, end - begin, 1, from, type, stride, OIIO::AutoStride, OIIO::AutoStride,
                            values + i, to, value_stride, OIIO::AutoStride, OIIO::AutoStride);
    if (!is_done) throw std::runtime_error("its numbers are of a kind that is not known");
    from += type.size();
  }
}

/// The number of channels that are read for RGBA: grey, grey and alpha, colours, colours and alpha.
int count_rgba(const OIIO::ImageSpec& spec) {
  const int count = std::min(spec.nchannels, 4);
  const bool has_alpha = spec.alpha_channel == count - 1;
  return count % 2 == 0 && !has_alpha ? count - 1 : count;
}

/// Spreads the first channels of each pixel over all four.
void spread_channels(std::span<unsigned char> pixels, int count) {
  if (count == 4) return;
  for (size_t i = 0; i < pixels.size(); i += 4) {
    unsigned char* pixel = &pixels[i];
    pixel[3] = count == 2 ? pixel[1] : 255;
    if (count <= 2) pixel[1] = pixel[2] = pixel[0];
  }
}

}  // namespace

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE;
}

int promin_pictures_begin(const ProminPicturesSource* source, const ProminPicturesSink* sink,
                          const ProminPicturesScratch* scratch, ProminPicturesWriter** writer,
                          ProminPicturesMessage* message) {
  *writer = nullptr;
  return guard(message, [&] { *writer = std::make_unique<ProminPicturesWriter>(*source, *sink, *scratch).release(); });
}

int promin_pictures_write_rows(ProminPicturesWriter* writer, uint32_t row_count, const void* pixels,
                               ProminPicturesMessage* message) {
  return guard(message, [&] { writer->write_rows(row_count, static_cast<const unsigned char*>(pixels)); });
}

int promin_pictures_finish(ProminPicturesWriter* writer, ProminPicturesMessage* message) {
  return guard(message, [&] { writer->finish(); });
}

void promin_pictures_end(ProminPicturesWriter* writer) {
  ProminPicturesMessage unread;
  guard(&unread, [&] { delete writer; });
}

int promin_pictures_open(const char* file, ProminPicturesReader** reader, ProminPicturesInfo* info,
                         ProminPicturesMessage* message) {
  *reader = nullptr;
  return guard(message, [&] {
    auto opened = std::make_unique<ProminPicturesReader>();
    opened->input = OIIO::ImageInput::open(file);
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
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
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
    if (!reader->input) throw std::runtime_error(std::string(reader->own_format->name) + " has no numbers of light");
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

void promin_pictures_close(ProminPicturesReader* reader) {
  ProminPicturesMessage unread;
  guard(&unread, [&] { delete reader; });
}
