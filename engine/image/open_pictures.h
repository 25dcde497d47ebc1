// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/plugin/pictures.h"

namespace promin {

/// The plugin that reads picture files, and writes the rarer kinds, by the functions of image/plugin/pictures.h.
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

/// Opens the plugin at the first call, which takes a fifth of a second, and keeps it open until the process ends. Any
/// thread may call it. The plugin is searched in the folder that the environment variable PROMIN_PLUGINS names or, if
/// it is not set, beside the library or program that contains this code, as CMake builds and installs it. Throws
/// RunError if it is missing, cannot be loaded or has another interface.
const PicturesPlugin& open_pictures();

}  // namespace promin
