// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "promin/math.h"

namespace promin {

/// The difference of one channel between two picture files, in the files' units.
struct ChannelDifference {
  std::string name;
  uint64_t pixel_count = 0;
  /// The largest difference, computed like PictureDifference::largest.
  double largest = 0.0;
  uvec2 largest_at{0};
  /// Number of pixels whose values differ by more than the allowed difference.
  uint64_t different_count = 0;
};

/// Compares all channels of two picture files (image/channel_file.h) except R, G and B. Only some rows are in memory at
/// a time. Throws the same errors as read_image(), and InputError if one file has channels that the other lacks or a
/// channel has different sizes.
std::vector<ChannelDifference> compare_other_channels(const std::filesystem::path& reference,
                                                      const std::filesystem::path& test, double allowed);

}  // namespace promin
