// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "image/picture_bytes.h"
#include "image/picture_writer.h"

namespace promin {

/// Encodes an EXR file by OpenEXR. Equal pixels give equal bytes.
class ExrEncoder {
 public:
  /// The bytes must outlive it. All functions throw RunError if bytes cannot be written, and std::runtime_error for
  /// other failures of OpenEXR.
  ExrEncoder(PictureBytes& bytes, const PictureHeader& header);
  ~ExrEncoder();
  ExrEncoder(const ExrEncoder&) = delete;
  ExrEncoder& operator=(const ExrEncoder&) = delete;

  /// Adds the next rows: for each pixel R, G, B and the header's channels, four bytes each.
  void write_rows(std::span<const uint32_t> words);
  /// Call it after the last row.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
