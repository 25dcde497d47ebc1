// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

/// A picture of ETC1S blocks with BasisLZ compression (KTX 2.0, "BasisLZ Bitstream Specification").
struct Etc1sPicture {
  uint32_t width;
  uint32_t height;
  /// The file's global data of supercompression, and the bytes of its largest level.
  std::span<const unsigned char> globals;
  std::span<const unsigned char> level;
  /// True if the second slice contains green and not alpha. It has no effect without a second slice.
  bool is_second_green;
};

/// Fills the pixels, of 4 bytes each, with RGBA from the top row. Throws std::runtime_error if the data is damaged.
void decode_etc1s(const Etc1sPicture& picture, std::span<unsigned char> pixels);
