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

/// Reads a panorama from a picture: of .hdr and .exr the values are radiance, of any other format sRGB's. Negative
/// numbers, which resampling leaves behind, count as 0, with a warning that counts them. Throws InputError where it is
/// no picture, larger than a panorama may be, or has a pixel that is no radiance; RunError where the plugin for
/// pictures is missing.
Panorama read_panorama(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Does the same with a file in memory, of one of the formats of image/picture_formats.h. `name` is for messages.
Panorama read_panorama(std::span<const std::byte> file, const std::string& name, std::vector<std::string>& warnings);

}  // namespace promin
