// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/file.h"

namespace promin {

/// Whether write_image makes a JPEG of the file, which holds no alpha.
inline bool is_jpeg(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".jpg" || ending == ".jpeg";
}

}  // namespace promin
