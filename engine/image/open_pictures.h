// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/plugin/pictures.h"

namespace promin {

/// The plugin that reads picture files and writes less common formats, with the functions of image/plugin/pictures.h.
struct PicturesPlugin {
  decltype(&promin_pictures_interface) interface = nullptr;
  decltype(&promin_pictures_open) open = nullptr;
  decltype(&promin_pictures_open_bytes) open_bytes = nullptr;
  decltype(&promin_pictures_read_rgb) read_rgb = nullptr;
  decltype(&promin_pictures_read_rgba) read_rgba = nullptr;
  decltype(&promin_pictures_describe_part) describe_part = nullptr;
  decltype(&promin_pictures_read_rows) read_rows = nullptr;
  decltype(&promin_pictures_write) write = nullptr;
  decltype(&promin_pictures_draw_text) draw_text = nullptr;
  decltype(&promin_pictures_close) close = nullptr;
};

/// Returns the plugin. The first call opens it, which takes a fifth of a second; it stays open until the process ends.
/// Any thread may call this function. It looks for the plugin in the folder that the environment variable
/// PROMIN_PLUGINS names or, if it is not set, beside the library or program that contains this code, as CMake builds
/// and installs it. Throws RunError if the plugin is missing, cannot be loaded or has another interface.
const PicturesPlugin& open_pictures();

}  // namespace promin
