// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device_scene/pack_scene.h"
#include "formats/source_file.h"
#include "scene/features.h"

namespace promin::app {

/// What of a scene is shown, and with which tree.
struct SceneChoice {
  std::string builder;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights, in their order; those that a scene does not have are passed over.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// A scene that is ready to be copied to the device.
struct PackedChoice {
  /// What of it is packed, with only those lights off that the scene has.
  SceneChoice choice;
  PackedScene packed;
  FeatureMask features = 0;
};

/// Packs what is chosen of a scene that is lit up. Throws InputError, UsageError, RunError, and what `progress` throws
/// that the tree's builder calls.
PackedChoice pack_choice(const Scene& scene, const SceneChoice& choice, const ProgressCallback& progress = {});

/// Watches the files that a scene is read from.
class SceneWatch {
 public:
  explicit SceneWatch(std::vector<SourceFile> sources) { follow(std::move(sources)); }

  /// From now on these, as they were when they were read.
  void follow(std::vector<SourceFile> sources);
  /// Whether one has been written, or has appeared, since it was read, and all have been left alone since the last
  /// call. Says so once for each change.
  bool has_changed();

 private:
  using Stamps = std::vector<std::optional<FileStamp>>;

  std::vector<SourceFile> sources_;
  /// Of the last call.
  Stamps last_;
};

}  // namespace promin::app
