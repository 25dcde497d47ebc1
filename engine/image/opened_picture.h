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

/// A picture file that the plugin has open. Everything throws as read_image does.
class OpenedPicture {
 public:
  /// Has `open` open it, a call of the plugin's. `name` is for messages.
  template <typename Open>
  OpenedPicture(std::string name, const Open& open) : name_(std::move(name)), plugin_(open_pictures()) {
    ProminPicturesReader* opened = nullptr;
    const bool is_open = is_done(open(plugin_, &opened, &info_, &message_));
    reader_ = {opened, plugin_.close};
    if (is_open) return;
    throw InputError({std::string("the picture cannot be read (") + message_.text + ")", name_,
                      "name a picture such as .exr or .png"});
  }

  explicit OpenedPicture(const std::filesystem::path& file);

  const ProminPicturesInfo& info() const { return info_; }

  /// R, G and B of the first part. A picture of more pixels in a row or more rows is refused.
  Image read(const uvec2& most);

  /// Holds until the next part is described. What is not flat or too large is refused.
  ProminPicturesPart describe_part(uint32_t part);

  /// See promin_pictures_read_rows; of a part that was described.
  void read_rows(uint32_t part, uint32_t first_row, uint32_t row_count, uint32_t* values);

 private:
  /// Whether a call of the plugin was done; the message has the reason where not.
  static bool is_done(int status) {
    if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
    return status == PROMIN_PICTURES_DONE;
  }
  /// Throws where a call that reads was not.
  void check_read(int status) const;
  void check_flat(bool is_flat, uint64_t width, uint64_t height) const;

  std::string name_;
  const PicturesPlugin& plugin_;
  ProminPicturesInfo info_{};
  ProminPicturesMessage message_{};
  std::unique_ptr<ProminPicturesReader, decltype(PicturesPlugin::close)> reader_{nullptr, nullptr};
};

}  // namespace promin
