// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/image.h"

namespace promin {

/// Does what read_image does, and refuses a picture of more pixels in a row or more rows before its pixels are read.
Image read_image_within(const std::filesystem::path& file, const uvec2& most);

}  // namespace promin
