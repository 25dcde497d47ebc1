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

/// A picture of a format that the plugin writes (image/plugin/pictures.h), as a whole.
class PluginEncoder {
 public:
  /// Writes the file, which is there. Throws RunError where the plugin is missing.
  PluginEncoder(std::filesystem::path file, std::string_view format, const uvec2& size, size_t pixel_bytes);

  /// The next rows, as the format has them.
  void write_rows(std::span<const std::byte> pixels);
  /// Throws std::runtime_error where it cannot be written, as a WebP with a side of more than 16383 pixels.
  void finish();

 private:
  std::filesystem::path file_;
  std::string format_;
  uvec2 size_;
  size_t pixel_bytes_;
  std::vector<std::byte> pixels_;
};

}  // namespace promin
