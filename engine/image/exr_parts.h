// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace promin {

/// The part of a multi-part EXR that contains the picture itself.
inline constexpr std::string_view kColorPart = "rgba";

inline bool is_color_channel(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B";
}

/// Returns the part to which a channel belongs according to its name, as in files of several parts that other programs
/// write.
inline std::string part_of_channel(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return channel.substr(0, dot);
  return is_color_channel(channel) || channel == "A" ? std::string(kColorPart) : channel;
}

}  // namespace promin
