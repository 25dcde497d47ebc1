// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/image.h"

#include <limits>

#include "core/srgb.h"
#include "image/opened_picture.h"
#include "image/picture_formats.h"
#include "image/read_image.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

constexpr uvec2 kAnySize(std::numeric_limits<uint32_t>::max());

}  // namespace

float encode_srgb(float linear) {
  if (!(linear > 0.0F)) return 0.0F;
  if (linear >= 1.0F) return 1.0F;
  return static_cast<float>(linear_to_srgb(static_cast<double>(linear)));
}

Image read_image(const fs::path& file) {
  return read_image_within(file, kAnySize);
}

Image read_image_within(const fs::path& file, const uvec2& most) {
  return OpenedPicture(file).read(most);
}

Image read_image_bytes(std::span<const std::byte> file, const std::string& name, const uvec2& most) {
  const PictureFormat* format = find_picture_format(file);
  if (format == nullptr) {
    throw InputError(
        {"picture.format", "the picture has an unknown format", name, "use a picture such as .exr or .png"});
  }
  const auto open = [&](const PicturesPlugin& plugin, auto... results) {
    return plugin.open_bytes(file.data(), file.size(), format->name, results...);
  };
  return OpenedPicture(name, open).read(most);
}

}  // namespace promin
