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
  /// The stamp taken just before the file was read, so that a later change differs from it. nullopt if the file was
  /// missing.
  std::optional<FileStamp> stamp;
};

/// Does what load_scene does, and returns each file that was read or missing, the scene's own first, also if it throws.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options, std::vector<SourceFile>& sources);

}  // namespace promin
