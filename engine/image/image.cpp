// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "core/file.h"
#include "core/parallel.h"
#include "core/srgb.h"
#include "image/dither.h"
#include "image/open_pictures.h"
#include "image/picture_formats.h"
#include "image/read_image.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

/// The name that OpenImageIO gives to the format of a file's ending; empty if write_image does not know it.
std::string format_of(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".exr") return "openexr";
  if (ending == ".png") return "png";
  return "";
}

/// The pixels one after the other, with the channels in the order of the EXR's spec; each channel is four bytes.
std::vector<uint32_t> interleave(const Image& image, std::span<const Channel> channels) {
  std::vector<uint32_t> words;
  words.reserve(image.pixels.size() * (3 + channels.size()));
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) words.push_back(std::bit_cast<uint32_t>(image.pixels[i][c]));
    for (const Channel& channel : channels) words.push_back(channel.values[i]);
  }
  return words;
}

/// `lo` is the place of the upper left pixel in the whole picture.
std::vector<uint8_t> encode_pixels(const Image& image, const DisplayTransform& display, const uvec2& lo) {
  std::vector<uint8_t> bytes(image.pixels.size() * 3);
  for_each_index(image.size.y, 0, [&](size_t y) {
    uint8_t* next = &bytes[3 * y * image.size.x];
    for (uint32_t x = 0; x < image.size.x; ++x) {
      const vec3 shown = apply(display, image.at(x, static_cast<uint32_t>(y)));
      for (int channel = 0; channel < 3; ++channel) {
        float code = 255.0F * encode_srgb(shown[channel]);
        if (display.dithers) {
          code = dithered(code, lo.x + x, lo.y + static_cast<uint32_t>(y), static_cast<uint32_t>(channel));
        }
        *next++ = static_cast<uint8_t>(std::lround(code));
      }
    }
  });
  return bytes;
}

std::vector<ProminPicturesChannel> list_channels(std::span<const Channel> channels) {
  std::vector<ProminPicturesChannel> result = {
      {"R", PROMIN_PICTURES_FLOAT}, {"G", PROMIN_PICTURES_FLOAT}, {"B", PROMIN_PICTURES_FLOAT}};
  for (const Channel& channel : channels) {
    result.push_back({channel.name.c_str(), channel.is_integer ? PROMIN_PICTURES_UINT32 : PROMIN_PICTURES_FLOAT});
  }
  return result;
}

/// Whether a call of the plugin was done; the message has the reason where not.
bool is_done(int status) {
  if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
  return status == PROMIN_PICTURES_DONE;
}

/// Writes the file with the encoded picture that the plugin hands over. What it throws must not pass through the
/// plugin.
struct FileSink {
  fs::path file;
  std::exception_ptr failure;

  static void take(void* context, const void* bytes, size_t byte_count) {
    auto& sink = *static_cast<FileSink*>(context);
    try {
      write_file(sink.file, {std::span(static_cast<const std::byte*>(bytes), byte_count)});
    } catch (...) {
      sink.failure = std::current_exception();
    }
  }
};

/// Completes the source by what it points to, encodes it and writes the file.
void encode_and_write(const PicturesPlugin& plugin, ProminPicturesSource source, const fs::path& file,
                      const void* pixels, std::span<const ProminPicturesChannel> channels, const Metadata& metadata) {
  std::vector<ProminPicturesAttribute> attributes;
  for (const auto& [name, value] : metadata) attributes.push_back({name.c_str(), value.c_str()});
  source.channels = channels.data();
  source.channel_count = channels.size();
  source.attributes = attributes.data();
  source.attribute_count = attributes.size();
  source.pixels = pixels;

  FileSink sink{file, nullptr};
  ProminPicturesMessage message{};
  if (!is_done(plugin.encode(&source, FileSink::take, &sink, &message))) {
    throw RunError({std::string("cannot encode the picture (") + message.text + ")", file.string(),
                    "try the other format, .exr or .png"});
  }
  if (sink.failure) std::rethrow_exception(sink.failure);
}

/// Throws UsageError where parts of a picture do not suit each other: the plugin reads by the sizes that it is told.
void check_picture(const Image& image, const std::optional<CropPlacement>& crop, std::span<const Channel> channels) {
  const auto check = [](bool is_so, const std::string& what, const char* cure) {
    if (!is_so) throw UsageError({what, "in the picture to write", cure});
  };
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
  if (!crop) return;
  const auto is_within = [](uint32_t lo, uint32_t size, uint32_t whole) { return lo <= whole && size <= whole - lo; };
  check(
      is_within(crop->lo.x, image.size.x, crop->full_size.x) && is_within(crop->lo.y, image.size.y, crop->full_size.y),
      "the crop reaches beyond the whole picture", "give its place and the size of the whole");
}

/// A picture that the plugin has opened, or not.
class OpenedPicture {
 public:
  /// Has `open` open it, a call of the plugin's. `name` is for messages.
  template <typename Open>
  OpenedPicture(std::string name, const Open& open) : name_(std::move(name)), plugin_(open_pictures()) {
    ProminPicturesReader* opened = nullptr;
    const bool is_open = is_done(open(plugin_, &opened, &info_, &message_));
    reader_ = {opened, plugin_.close};
    if (is_open) return;
    throw InputError(
        {std::string("cannot read the picture (") + message_.text + ")", name_, "name a picture such as .exr or .png"});
  }

  std::string channel_names() const { return info_.channel_names; }

  Image read(const uvec2& most) {
    check(most);
    Image image;
    image.size = uvec2(info_.width, info_.height);
    image.pixels.resize(info_.width * info_.height);
    static_assert(sizeof(vec3) == 3 * sizeof(float));
    if (!is_done(plugin_.read_rgb(reader_.get(), &image.pixels.data()->x, &message_))) {
      throw InputError(
          {std::string("the picture is damaged (") + message_.text + ")", name_, "write or export it again"});
    }
    return image;
  }

 private:
  void check(const uvec2& most) const {
    if (info_.is_flat == 0) throw InputError({"not a flat picture", name_, "name a two-dimensional picture"});
    if (info_.width > most.x || info_.height > most.y) {
      throw InputError(
          {"the picture is too large (" + std::to_string(info_.width) + "x" + std::to_string(info_.height) + " pixels)",
           name_, "give one of at most " + std::to_string(most.x) + "x" + std::to_string(most.y)});
    }
    if (const uint64_t pixel_count = info_.width * info_.height; pixel_count > kMaxReadPixels) {
      throw InputError({"the picture is too large (" + std::to_string(pixel_count) + " pixels)", name_,
                        "at most " + std::to_string(kMaxReadPixels) + " pixels are read"});
    }
    if (info_.first_rgb_channel < 0) {
      throw InputError({"the picture has no channels R, G, B", name_, "convert it to RGB"});
    }
  }

  std::string name_;
  const PicturesPlugin& plugin_;
  ProminPicturesInfo info_{};
  ProminPicturesMessage message_{};
  std::unique_ptr<ProminPicturesReader, decltype(PicturesPlugin::close)> reader_{nullptr, nullptr};
};

constexpr uvec2 kAnySize(std::numeric_limits<uint32_t>::max());

OpenedPicture open_picture(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw InputError({"no such picture", file.string(), "check the path"});
  const auto open = [&](const PicturesPlugin& plugin, auto... results) {
    return plugin.open(file.c_str(), results...);
  };
  return OpenedPicture(file.string(), open);
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
  return static_cast<float>(linear_to_srgb(static_cast<double>(linear)));
}

void write_image(const fs::path& file, const Image& image, const Metadata& metadata,
                 const std::optional<CropPlacement>& crop, std::span<const Channel> channels,
                 const DisplayTransform& display) {
  const std::string format = format_of(file);
  if (format.empty()) {
    throw UsageError({"unknown picture format " + file.extension().string(), file.string(), "use .exr or .png"});
  }
  check_picture(image, crop, channels);
  const PicturesPlugin& plugin = open_pictures();
  const std::string name = file.filename().string();
  ProminPicturesSource source{};
  source.format = format.c_str();
  source.file_name = name.c_str();
  source.width = image.size.x;
  source.height = image.size.y;
  if (crop) {
    source.x = crop->lo.x;
    source.y = crop->lo.y;
    source.full_width = crop->full_size.x;
    source.full_height = crop->full_size.y;
  }
  if (has_named_channels(file)) {
    encode_and_write(plugin, source, file, interleave(image, channels).data(), list_channels(channels), metadata);
  } else {
    const ProminPicturesChannel bytes[] = {
        {"R", PROMIN_PICTURES_UINT8}, {"G", PROMIN_PICTURES_UINT8}, {"B", PROMIN_PICTURES_UINT8}};
    encode_and_write(plugin, source, file, encode_pixels(image, display, crop ? crop->lo : uvec2(0)).data(), bytes, {});
  }
}

Image read_image(const fs::path& file) {
  return read_image_within(file, kAnySize);
}

NamedPicture read_named_picture(const fs::path& file) {
  OpenedPicture picture = open_picture(file);
  return {picture.read(kAnySize), picture.channel_names()};
}

Image read_image_within(const fs::path& file, const uvec2& most) {
  return open_picture(file).read(most);
}

Image read_image_bytes(std::span<const std::byte> file, const std::string& name, const uvec2& most) {
  const PictureFormat* format = find_picture_format(file);
  if (format == nullptr) {
    throw InputError({"the picture is of no known format", name, "name a picture such as .exr or .png"});
  }
  const auto open = [&](const PicturesPlugin& plugin, auto... results) {
    return plugin.open_bytes(file.data(), file.size(), format->name, results...);
  };
  return OpenedPicture(name, open).read(most);
}

}  // namespace promin
