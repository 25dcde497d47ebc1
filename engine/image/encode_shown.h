// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/display.h"
#include "promin/image.h"

namespace promin {

/// Returns the pixels of a picture, or of rows of it, as they are shown: 8-bit sRGB after the transform `display`, with
/// three bytes per pixel. With `has_alpha` they have four bytes, the last is the alpha of the channel "A", and colours
/// are not premultiplied. The channels of Aovs::unlit keep their colours. `lo` is the position of the upper left pixel
/// in the whole picture.
std::vector<uint8_t> encode_shown(const Image& image, std::span<const Channel> channels,
                                  const DisplayTransform& display, const uvec2& lo, bool has_alpha);

}  // namespace promin
