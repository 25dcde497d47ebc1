// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Returns a JPEG of pixels of red, green and blue, as libjpeg-turbo writes it.
inline std::vector<std::byte> make_jpeg(const uvec2& size, const std::vector<uint8_t>& rgb) {
  const tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  EXPECT_EQ(tjCompress2(handle, rgb.data(), static_cast<int>(size.x), 0, static_cast<int>(size.y), TJPF_RGB, &bytes,
                        &count, TJSAMP_444, 100, 0),
            0);
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> file(first, first + count);
  tjFree(bytes);
  tjDestroy(handle);
  return file;
}

}  // namespace promin
