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

/// Watches the files from which a scene was read.
class SceneWatch {
 public:
  explicit SceneWatch(std::vector<SourceFile> sources) { follow(std::move(sources)); }

  /// Watches these files from now on. Their stamps are those at the time of reading.
  void follow(std::vector<SourceFile> sources);
  /// Returns whether a file has been written or has appeared since it was read, and no file has changed since the last
  /// call. Returns true once for each change.
  bool has_changed();

 private:
  using Stamps = std::vector<std::optional<FileStamp>>;

  std::vector<SourceFile> sources_;
  /// The stamps of the files at the last call.
  Stamps last_;
};

}  // namespace promin::app
