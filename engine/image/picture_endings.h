// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "core/file.h"

namespace promin {

/// Whether write_image makes a JPEG of the file, which holds no alpha.
inline bool is_jpeg(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".jpg" || ending == ".jpeg";
}

/// The format in which the plugin writes a file of this ending (image/plugin/pictures.h); empty where it does not.
inline std::string_view plugin_format_of(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".webp") return "webp";
  if (ending == ".tif" || ending == ".tiff") return "tiff";
  return ending == ".hdr" ? "hdr" : "";
}

/// Whether write_image writes linear light without named channels.
inline bool is_radiance(const std::filesystem::path& file) {
  return lower_case_ending(file) == ".hdr";
}

/// The metadata that names the scene which a picture is of.
inline constexpr std::string_view kSceneKey = "promin:scene";

/// The cure for any other ending.
inline constexpr const char* kUseKnownEnding = "use .exr, .png, .jpg, .webp, .tif or .hdr";

}  // namespace promin
