// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/file.h"
#include "promin/load_scene.h"

namespace promin {

/// A file that a scene is read from.
struct SourceFile {
  std::filesystem::path file;
  /// From just before it was read: what is written meanwhile differs. None where it was missing.
  std::optional<FileStamp> stamp;
};

/// load_scene that tells of each file that was read or missed, the scene's own first, also where it throws.
Scene load_scene(const std::filesystem::path& file, std::vector<SourceFile>& sources);

}  // namespace promin
