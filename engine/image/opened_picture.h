// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "image/open_pictures.h"
#include "promin/error.h"
#include "promin/image.h"

namespace promin {

/// A picture file that the plugin has opened. All functions throw the same errors as read_image().
class OpenedPicture {
 public:
  /// Opens the file with `open`, a call of the plugin. `name` is used in messages.
  template <typename Open>
  OpenedPicture(std::string name, const Open& open) : name_(std::move(name)), plugin_(open_pictures()) {
    ProminPicturesReader* opened = nullptr;
    const bool is_open = is_done(open(plugin_, &opened, &info_, &message_));
    reader_ = {opened, plugin_.close};
    if (is_open) return;
    throw InputError({"picture.format", std::string("the picture cannot be read (") + message_.text + ")", name_,
                      "use a picture such as .exr or .png"});
  }

  explicit OpenedPicture(const std::filesystem::path& file);

  const ProminPicturesInfo& info() const { return info_; }

  /// Reads R, G and B of the first part. Refuses a picture that is wider or higher than `most`.
  Image read(const uvec2& most);

  /// Returns a description of a part. The description is valid until the next call. Refuses a part that is too large or
  /// not two-dimensional.
  ProminPicturesPart describe_part(uint32_t part);

  /// Reads rows of a part that was described before; see promin_pictures_read_rows.
  void read_rows(uint32_t part, uint32_t first_row, uint32_t row_count, uint32_t* values);

 private:
  /// Returns whether a call of the plugin succeeded; if not, the message has the reason.
  static bool is_done(int status) {
    if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
    return status == PROMIN_PICTURES_DONE;
  }
  /// Throws if a call that reads has failed.
  void check_read(int status) const;
  void check_flat(bool is_flat, uint64_t width, uint64_t height) const;

  std::string name_;
  const PicturesPlugin& plugin_;
  ProminPicturesInfo info_{};
  ProminPicturesMessage message_{};
  std::unique_ptr<ProminPicturesReader, decltype(PicturesPlugin::close)> reader_{nullptr, nullptr};
};

}  // namespace promin
