// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "core/file.h"

namespace promin {

/// A file that a scene is read from.
struct SourceFile {
  std::filesystem::path file;
  /// From just before it was read: what is written meanwhile differs. None where it was missing.
  std::optional<FileStamp> stamp;
};

}  // namespace promin
