// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "image/picture_bytes.h"
#include "image/picture_writer.h"

namespace promin {

/// Encodes an EXR file with OpenEXR. Equal pixels give equal bytes.
class ExrEncoder {
 public:
  /// `bytes` must outlive the encoder. All functions throw RunError if bytes cannot be written, and std::runtime_error
  /// for other failures of OpenEXR.
  ExrEncoder(PictureBytes& bytes, const PictureHeader& header);
  ~ExrEncoder();
  ExrEncoder(const ExrEncoder&) = delete;
  ExrEncoder& operator=(const ExrEncoder&) = delete;

  /// Adds the next rows. Each pixel has R, G, B and the channels of the header, with four bytes each.
  void write_rows(std::span<const uint32_t> words);
  /// Completes the file. The caller calls it after the last row.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
