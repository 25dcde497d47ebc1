// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "promin/image.h"

namespace promin {

/// Does what read_image does, and refuses a picture of more pixels in a row or more rows before its pixels are read.
Image read_image_within(const std::filesystem::path& file, const uvec2& most);

/// Does the same with a file in memory, of one of the formats of image/picture_formats.h. `name` is for messages.
Image read_image_bytes(std::span<const std::byte> file, const std::string& name, const uvec2& most);

}  // namespace promin
