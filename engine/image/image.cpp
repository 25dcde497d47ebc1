// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/image.h"

#include <cmath>
#include <limits>
#include <memory>
#include <new>

#include "core/file.h"
#include "core/srgb.h"
#include "image/open_pictures.h"
#include "image/picture_formats.h"
#include "image/read_image.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

/// Whether a call of the plugin was done; the message has the reason where not.
bool is_done(int status) {
  if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
  return status == PROMIN_PICTURES_DONE;
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

float encode_srgb(float linear) {
  if (!(linear > 0.0F)) return 0.0F;
  if (linear >= 1.0F) return 1.0F;
  return static_cast<float>(linear_to_srgb(static_cast<double>(linear)));
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
