// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace promin {

/// The part of an EXR of several that has the picture itself.
inline constexpr std::string_view kColorPart = "rgba";

inline bool is_color_channel(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B";
}

/// The part that ExrOptions::is_multipart puts a channel into. The plugin that writes parts and those who read them ask
/// it.
inline std::string part_of_channel(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot != std::string::npos) return channel.substr(0, dot);
  return is_color_channel(channel) || channel == "A" ? std::string(kColorPart) : channel;
}

}  // namespace promin
