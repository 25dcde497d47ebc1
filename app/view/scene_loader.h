// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/pack_scene.h"
#include "scene/features.h"
#include "scene/scene.h"

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
struct LoadedScene {
  /// As the file has it, lit up.
  std::shared_ptr<const Scene> scene;
  /// What of it is packed, with only those lights off that the scene has.
  SceneChoice choice;
  PackedScene packed;
  FeatureMask features = 0;
};

/// Reads a file and packs what is chosen of it. Throws InputError, UsageError, RunError.
LoadedScene load_chosen_scene(const std::filesystem::path& file, const SceneChoice& choice);
/// Packs another choice of a scene that has been read.
LoadedScene pack_chosen_scene(std::shared_ptr<const Scene> scene, const SceneChoice& choice);

/// Loads scenes on a thread of its own, one at a time, and watches a file for changes.
class SceneLoader {
 public:
  explicit SceneLoader(std::filesystem::path file);

  /// Notices by its time and size that the file was written, and has been left alone since the last call.
  bool has_file_changed();

  bool is_busy() const { return result_.valid(); }
  /// Not while busy.
  void load(const SceneChoice& choice);
  void pack(std::shared_ptr<const Scene> scene, const SceneChoice& choice);
  /// What it was asked for last, once it is there. Throws what loading threw.
  std::optional<LoadedScene> take();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };
  /// None while there is no such file: editors replace it.
  std::optional<Stamp> read_stamp() const;

  std::filesystem::path file_;
  std::optional<Stamp> loaded_;
  std::optional<Stamp> last_;
  std::future<LoadedScene> result_;
};

}  // namespace promin::app
