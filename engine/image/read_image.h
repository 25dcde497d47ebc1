// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "promin/image.h"

namespace promin {

/// Reads a picture like read_image(). Refuses a picture that is wider or higher than `most` before its pixels are read.
Image read_image_within(const std::filesystem::path& file, const uvec2& most);

/// Reads a picture from a file in memory, in one of the formats of image/picture_formats.h. `name` is used in messages.
Image read_image_bytes(std::span<const std::byte> file, const std::string& name, const uvec2& most);

}  // namespace promin
