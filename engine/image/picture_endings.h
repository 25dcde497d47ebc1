// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "core/file.h"

namespace promin {

/// Returns whether write_image writes the file as a JPEG, which has no alpha.
inline bool is_jpeg(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".jpg" || ending == ".jpeg";
}

/// Returns the plugin's format for a file with this extension (image/plugin/pictures.h); empty if the plugin does not
/// write such files.
inline std::string_view plugin_format_of(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  if (ending == ".webp") return "webp";
  if (ending == ".tif" || ending == ".tiff") return "tiff";
  return ending == ".hdr" ? "hdr" : "";
}

/// Returns whether write_image() writes the file as linear light without named channels.
inline bool is_radiance(const std::filesystem::path& file) {
  return lower_case_ending(file) == ".hdr";
}

/// The key of the metadata entry with the name of a picture's scene.
inline constexpr std::string_view kSceneKey = "promin:scene";

/// The advice for an unknown extension.
inline constexpr const char* kUseKnownEnding = "use .exr, .png, .jpg, .webp, .tif or .hdr";

}  // namespace promin
