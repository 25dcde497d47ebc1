// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "image/picture_bytes.h"
#include "image/picture_writer.h"

namespace promin {

/// An EXR file on its way through OpenEXR. Equal pixels give equal bytes.
class ExrEncoder {
 public:
  /// The bytes outlive it. `target` is the file that they become, beside which rows wait that are not the first part's.
  /// Everything throws RunError where bytes cannot be written or kept, std::runtime_error where OpenEXR has another
  /// reason.
  ExrEncoder(PictureBytes& bytes, const PictureHeader& header, const std::filesystem::path& target);
  ~ExrEncoder();
  ExrEncoder(const ExrEncoder&) = delete;
  ExrEncoder& operator=(const ExrEncoder&) = delete;

  /// The next rows: of each pixel R, G, B and the header's channels, four bytes each.
  void write_rows(std::span<const uint32_t> words);
  /// After the last row.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
