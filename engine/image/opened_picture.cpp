// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/opened_picture.h"

#include <fstream>

#include "core/file.h"

namespace promin {
namespace {

std::string name_existing(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    refuse_lost_folder(file);
    throw InputError({"file.missing", "the picture does not exist", file.string(), "check the path"});
  }
  if (!std::ifstream(file))
    throw InputError({"file.open", "the file cannot be opened", file.string(), "check its permissions"});
  return file.string();
}

}  // namespace

OpenedPicture::OpenedPicture(const std::filesystem::path& file)
    : OpenedPicture(name_existing(file), [&](const PicturesPlugin& plugin, auto... results) {
        return plugin.open(file.c_str(), results...);
      }) {}

Image OpenedPicture::read(const uvec2& most) {
  if (info_.is_flat != 0 && (info_.width > most.x || info_.height > most.y)) {
    throw InputError(
        {"picture.large",
         "the picture is too large (" + std::to_string(info_.width) + "x" + std::to_string(info_.height) + " pixels)",
         name_, "use a picture of at most " + std::to_string(most.x) + "x" + std::to_string(most.y) + " pixels"});
  }
  check_flat(info_.is_flat != 0, info_.width, info_.height);
  if (info_.first_rgb_channel < 0) {
    throw InputError(
        {"picture.channels", "the picture has neither channels R, G, B nor a luminance Y", name_, "convert it to RGB"});
  }
  Image image;
  image.size = uvec2(info_.width, info_.height);
  image.pixels.resize(info_.width * info_.height);
  static_assert(sizeof(vec3) == 3 * sizeof(float));
  check_read(plugin_.read_rgb(reader_.get(), &image.pixels.data()->x, &message_));
  return image;
}

ProminPicturesPart OpenedPicture::describe_part(uint32_t part) {
  ProminPicturesPart described{};
  check_read(plugin_.describe_part(reader_.get(), part, &described, &message_));
  check_flat(described.is_flat != 0, described.width, described.height);
  return described;
}

void OpenedPicture::read_rows(uint32_t part, uint32_t first_row, uint32_t row_count, uint32_t* values) {
  check_read(plugin_.read_rows(reader_.get(), part, first_row, row_count, values, &message_));
}

void OpenedPicture::check_read(int status) const {
  if (is_done(status)) return;
  throw InputError({"picture.damaged", std::string("the picture is damaged (") + message_.text + ")", name_,
                    "write or export it again"});
}

void OpenedPicture::check_flat(bool is_flat, uint64_t width, uint64_t height) const {
  if (!is_flat)
    throw InputError({"picture.flat", "the picture is not two-dimensional", name_, "use a two-dimensional picture"});
  if (width * height <= kMaxReadPixels) return;
  throw InputError({"picture.large", "the picture is too large (" + std::to_string(width * height) + " pixels)", name_,
                    "use a picture of at most " + std::to_string(kMaxReadPixels) + " pixels"});
}

}  // namespace promin
