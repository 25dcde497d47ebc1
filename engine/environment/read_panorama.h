// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "promin/environment.h"

namespace promin {

/// Reads a panorama from a picture: of .hdr and .exr the values are radiance, of any other format sRGB's. Throws
/// InputError where it is no picture, larger than a panorama may be, or has a pixel that is no radiance; RunError where
/// the plugin for pictures is missing.
Panorama read_panorama(const std::filesystem::path& file);

}  // namespace promin
