// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "promin/environment.h"

namespace promin {

/// Reads a panorama from a picture. Values of .hdr and .exr are radiance; values of other formats are sRGB. Resampling
/// may cause negative values; they become 0, and a warning reports their number. Throws InputError if the file is not a
/// picture, is larger than a panorama may be, or has a pixel that is not a radiance; RunError if the plugin for
/// pictures is missing.
Panorama read_panorama(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Reads a panorama from a file in memory, in one of the formats of image/picture_formats.h. `name` is used in
/// messages.
Panorama read_panorama(std::span<const std::byte> file, const std::string& name, std::vector<std::string>& warnings);

}  // namespace promin
