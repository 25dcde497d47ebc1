// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Encodes a whole picture in a format that the plugin writes (image/plugin/pictures.h).
class PluginEncoder {
 public:
  /// Creates an encoder that writes to an existing file. Throws RunError if the plugin is missing.
  PluginEncoder(std::filesystem::path file, std::string_view format, const uvec2& size, size_t pixel_bytes);

  /// Adds the next rows in the format's layout.
  void write_rows(std::span<const std::byte> pixels);
  /// Writes the file. Throws std::runtime_error if it cannot be written, for example a WebP with a side of more than
  /// 16383 pixels.
  void finish();

 private:
  std::filesystem::path file_;
  std::string format_;
  uvec2 size_;
  size_t pixel_bytes_;
  std::vector<std::byte> pixels_;
};

}  // namespace promin
