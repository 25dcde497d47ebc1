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

/// What a picture file begins with.
struct PictureHeader {
  /// Width and height of what is written.
  uvec2 size{0};
  std::optional<CropPlacement> crop = std::nullopt;
  Metadata metadata = {};
  /// Beside R, G and B; without values.
  std::vector<Channel> channels = {};
  DisplayTransform display = {};
  ExrOptions exr = {};
};

/// Writes a picture as write_image does, but some rows at a time. The file appears when it is whole; without commit()
/// nothing stays behind.
class PictureWriter {
 public:
  /// Throws as write_image.
  PictureWriter(const std::filesystem::path& file, const PictureHeader& header);
  ~PictureWriter();
  PictureWriter(PictureWriter&&) noexcept;
  PictureWriter& operator=(PictureWriter&&) noexcept;

  /// The next rows from the top, of the header's width, with values of its channels. Throws UsageError where they do
  /// not suit it, RunError.
  void write_rows(const Image& rows, std::span<const Channel> channels = {});
  /// After the last row. Throws UsageError where rows are missing, RunError.
  void commit();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
