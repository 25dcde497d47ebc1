// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <span>

#include "core/file.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

/// OpenImageIO's name of the format that a file's ending asks for; empty if write_image does not know it.
std::string format_of(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".exr") return "openexr";
  if (ending == ".png") return "png";
  return "";
}

/// OpenImageIO's explanations may run over several lines; an error of ours is one.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

OIIO::ImageSpec make_exr_spec(const Image& image, const Metadata& metadata, const std::optional<CropPlacement>& crop,
                              std::span<const Channel> channels) {
  OIIO::ImageSpec spec(static_cast<int>(image.size.x), static_cast<int>(image.size.y),
                       static_cast<int>(3 + channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B"};
  spec.channelformats.assign(3, OIIO::TypeDesc::FLOAT);
  for (const Channel& channel : channels) {
    spec.channelnames.push_back(channel.name);
    spec.channelformats.push_back(channel.is_integer ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
  }
  spec.attribute("compression", "zip");
  // Otherwise the writer puts the time of day in, and equal pictures would differ.
  spec.attribute("DateTime", "");
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  if (crop) {
    spec.x = static_cast<int>(crop->lo.x);
    spec.y = static_cast<int>(crop->lo.y);
    spec.full_width = static_cast<int>(crop->full_size.x);
    spec.full_height = static_cast<int>(crop->full_size.y);
  }
  return spec;
}

OIIO::ImageSpec make_png_spec(const Image& image) {
  OIIO::ImageSpec spec(static_cast<int>(image.size.x), static_cast<int>(image.size.y), 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  return spec;
}

/// A pixel after the other, its channels in the order of the EXR's spec; each is four bytes.
std::vector<uint32_t> interleave(const Image& image, std::span<const Channel> channels) {
  std::vector<uint32_t> words;
  words.reserve(image.pixels.size() * (3 + channels.size()));
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) words.push_back(std::bit_cast<uint32_t>(image.pixels[i][c]));
    for (const Channel& channel : channels) words.push_back(channel.values[i]);
  }
  return words;
}

std::vector<uint8_t> encode_pixels(const Image& image) {
  std::vector<uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const vec3& pixel : image.pixels) {
    for (int channel = 0; channel < 3; ++channel) {
      bytes.push_back(static_cast<uint8_t>(std::lround(255.0F * encode_srgb(pixel[channel]))));
    }
  }
  return bytes;
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

}  // namespace

bool is_writable_format(const fs::path& file) {
  return !format_of(file).empty();
}

bool has_named_channels(const fs::path& file) {
  return format_of(file) == "openexr";
}

float encode_srgb(float linear) {
  if (!(linear > 0.0F)) return 0.0F;
  if (linear >= 1.0F) return 1.0F;
  const double x = linear;
  return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055);
}

void write_image(const fs::path& file, const Image& image, const Metadata& metadata,
                 const std::optional<CropPlacement>& crop, std::span<const Channel> channels) {
  const std::string format = format_of(file);
  if (format.empty()) {
    throw RunError({"unknown picture format " + file.extension().string(), file.string(), "use .exr or .png"});
  }
  // In memory first: OpenImageIO's PNG writer does not notice a full disk.
  OIIO::Filesystem::IOVecOutput encoded;
  const std::unique_ptr<OIIO::ImageOutput> writer = OIIO::ImageOutput::create(format);
  const bool is_exr = format == "openexr";
  const bool is_encoded = writer && writer->set_ioproxy(&encoded) &&
                          writer->open(file.filename().string(), is_exr ? make_exr_spec(image, metadata, crop, channels)
                                                                        : make_png_spec(image)) &&
                          (is_exr ? writer->write_image(OIIO::TypeDesc::UNKNOWN, interleave(image, channels).data())
                                  : writer->write_image(OIIO::TypeDesc::UINT8, encode_pixels(image).data())) &&
                          writer->close();
  if (!is_encoded) {
    throw RunError({"cannot encode the picture (" + first_line(writer ? writer->geterror() : OIIO::geterror()) + ")",
                    file.string(), "try the other format, .exr or .png"});
  }
  write_file(file, {std::as_bytes(std::span(encoded.buffer()))});
}

Image read_image(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw InputError({"no such picture", file.string(), "check the path"});
  const std::unique_ptr<OIIO::ImageInput> reader = OIIO::ImageInput::open(file.string());
  if (!reader) {
    throw InputError({"cannot read the picture (" + first_line(OIIO::geterror()) + ")", file.string(),
                      "name a picture such as .exr or .png"});
  }
  const OIIO::ImageSpec& spec = reader->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.deep) {
    throw InputError({"not a flat picture", file.string(), "name a two-dimensional picture"});
  }
  const uint64_t pixel_count = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  if (pixel_count > kMaxReadPixels) {
    throw InputError({"the picture is too large (" + std::to_string(pixel_count) + " pixels)", file.string(),
                      "at most " + std::to_string(kMaxReadPixels) + " pixels are read"});
  }
  const int first = find_rgb(spec);
  if (first < 0) throw InputError({"the picture has no channels R, G, B", file.string(), "convert it to RGB"});

  Image image;
  image.size = uvec2(spec.width, spec.height);
  image.pixels.resize(pixel_count);
  if (!reader->read_image(0, 0, first, first + 3, OIIO::TypeDesc::FLOAT, image.pixels.data())) {
    throw InputError(
        {"the picture is damaged (" + first_line(reader->geterror()) + ")", file.string(), "write or export it again"});
  }
  return image;
}

}  // namespace promin
