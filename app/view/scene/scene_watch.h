// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/source_file.h"

namespace promin::app {

/// Watches the files that a scene is read from.
class SceneWatch {
 public:
  explicit SceneWatch(std::vector<SourceFile> sources) { follow(std::move(sources)); }

  /// Watches these files from now on, as they were when they were read.
  void follow(std::vector<SourceFile> sources);
  /// Whether a file has been written, or has appeared, since it was read, and all have been left alone since the last
  /// call. Returns true once for each change.
  bool has_changed();

 private:
  using Stamps = std::vector<std::optional<FileStamp>>;

  std::vector<SourceFile> sources_;
  /// The stamps at the last call.
  Stamps last_;
};

}  // namespace promin::app
