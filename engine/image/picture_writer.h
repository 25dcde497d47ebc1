// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "promin/image.h"

namespace promin {

/// The header of a picture file.
struct PictureHeader {
  /// Width and height of the written pixels.
  uvec2 size{0};
  std::optional<CropPlacement> crop = std::nullopt;
  Metadata metadata = {};
  /// Channels in addition to R, G and B. They have no values here.
  std::vector<Channel> channels = {};
  DisplayTransform display = {};
  ExrOptions exr = {};
};

/// Writes a picture like write_image(), but some rows at a time. The file appears when it is complete. Without commit()
/// no file remains.
class PictureWriter {
 public:
  /// Throws the same errors as write_image().
  PictureWriter(const std::filesystem::path& file, const PictureHeader& header);
  ~PictureWriter();
  PictureWriter(PictureWriter&&) noexcept;
  PictureWriter& operator=(PictureWriter&&) noexcept;

  /// Adds the next rows from the top, of the header's width, with values of its channels. Throws UsageError if they do
  /// not match the header, and RunError.
  void write_rows(const Image& rows, std::span<const Channel> channels = {});
  /// Completes the file after the last row. Throws UsageError if rows are missing, and RunError.
  void commit();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
