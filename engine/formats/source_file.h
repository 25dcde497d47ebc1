// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/file.h"
#include "promin/load_scene.h"

namespace promin {

/// A file from which a scene was read.
struct SourceFile {
  std::filesystem::path file;
  /// The stamp of the file just before it was read, so that a later change causes another stamp. nullopt if the file
  /// was missing.
  std::optional<FileStamp> stamp;
};

/// Loads a scene as load_scene() of promin/load_scene.h does. `sources` receives each file that was read or found
/// missing, the scene's own file first, also if the function throws.
Scene load_scene(const std::filesystem::path& file, const LoadOptions& options, std::vector<SourceFile>& sources);

}  // namespace promin
