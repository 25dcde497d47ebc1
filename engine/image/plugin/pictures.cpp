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

#include "image/plugin/webp.h"

struct ProminPicturesReader {
  /// A WebP file in memory; all else has an input.
  std::span<const unsigned char> webp;
  /// Another file in memory.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
  int first_channel = -1;
  std::string channel_names;
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
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

OIIO::ImageSpec make_exr_spec(const ProminPicturesSource& source) {
  OIIO::ImageSpec spec(static_cast<int>(source.width), static_cast<int>(source.height),
                       static_cast<int>(source.channel_count), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (const ProminPicturesChannel& channel : std::span(source.channels, source.channel_count)) {
    spec.channelnames.emplace_back(channel.name);
    spec.channelformats.push_back(type_of(channel.sample));
  }
  spec.attribute("compression", "zip");
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

OIIO::ImageSpec make_png_spec(const ProminPicturesSource& source) {
  OIIO::ImageSpec spec(static_cast<int>(source.width), static_cast<int>(source.height), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return spec;
}

/// The place of the R, G, B triple among a file's channels; -1 if it has none.
int find_rgb(const OIIO::ImageSpec& spec) {
  const auto& names = spec.channelnames;
  for (int first = 0; first + 2 < spec.nchannels; ++first) {
    const auto i = static_cast<size_t>(first);
    if (names[i] == "R" && names[i + 1] == "G" && names[i + 2] == "B") return first;
  }
  return -1;
}

ProminPicturesInfo describe(ProminPicturesReader& reader) {
  const OIIO::ImageSpec& spec = reader.input->spec();
  const bool is_flat = spec.width >= 1 && spec.height >= 1 && spec.depth <= 1 && !spec.deep;
  reader.first_channel = find_rgb(spec);
  for (const std::string& name : spec.channelnames) {
    reader.channel_names += reader.channel_names.empty() ? name : " " + name;
  }
  return {is_flat ? static_cast<uint64_t>(spec.width) : 0, is_flat ? static_cast<uint64_t>(spec.height) : 0,
          is_flat ? 1U : 0U, reader.first_channel, reader.channel_names.c_str()};
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

int promin_pictures_encode(const ProminPicturesSource* source, ProminPicturesSink sink, void* context,
                           ProminPicturesMessage* message) {
  return guard(message, [&] {
    // The picture is encoded in memory first, because OpenImageIO's PNG writer does not notice a full disk.
    OIIO::Filesystem::IOVecOutput encoded;
    const std::unique_ptr<OIIO::ImageOutput> writer = OIIO::ImageOutput::create(source->format);
    const bool is_exr = std::string_view(source->format) == "openexr";
    const bool is_encoded =
        writer && writer->set_ioproxy(&encoded) &&
        writer->open(source->file_name, is_exr ? make_exr_spec(*source) : make_png_spec(*source)) &&
        // Samples of several types are passed as they are.
        writer->write_image(is_exr ? OIIO::TypeDesc::UNKNOWN : OIIO::TypeDesc::UINT8, source->pixels) &&
        writer->close();
    if (!is_encoded) throw std::runtime_error(first_line(writer ? writer->geterror() : OIIO::geterror()));
    sink(context, encoded.buffer().data(), encoded.buffer().size());
  });
}

int promin_pictures_open(const char* file, ProminPicturesReader** reader, ProminPicturesInfo* info,
                         ProminPicturesMessage* message) {
  *reader = nullptr;
  return guard(message, [&] {
    auto opened = std::make_unique<ProminPicturesReader>();
    opened->input = OIIO::ImageInput::open(file);
    if (!opened->input) throw std::runtime_error(first_line(OIIO::geterror()));
    *info = describe(*opened);
    *reader = opened.release();
  });
}

int promin_pictures_open_bytes(const void* bytes, size_t byte_count, const char* format, ProminPicturesReader** reader,
                               ProminPicturesInfo* info, ProminPicturesMessage* message) {
  *reader = nullptr;
  return guard(message, [&] {
    auto opened = std::make_unique<ProminPicturesReader>();
    if (std::string_view(format) == "webp") {
      opened->webp = {static_cast<const unsigned char*>(bytes), byte_count};
      const auto [width, height] = read_webp_size(opened->webp);
      *info = {width, height, 1, -1, opened->channel_names.c_str()};
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
    *info = describe(*opened);
    *reader = opened.release();
  });
}

int promin_pictures_read_rgba(ProminPicturesReader* reader, unsigned char* pixels, ProminPicturesMessage* message) {
  return guard(message, [&] {
    if (!reader->input) {
      const auto [width, height] = read_webp_size(reader->webp);
      read_webp(reader->webp, {pixels, size_t{4} * width * height});
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
    if (!reader->input) throw std::runtime_error("WebP has no numbers of light");
    const int first = reader->first_channel;
    if (!reader->input->read_image(0, 0, first, first + 3, OIIO::TypeDesc::FLOAT, pixels)) {
      throw std::runtime_error(first_line(reader->input->geterror()));
    }
  });
}

void promin_pictures_close(ProminPicturesReader* reader) {
  ProminPicturesMessage unread;
  guard(&unread, [&] { delete reader; });
}
