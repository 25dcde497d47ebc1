// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "view/background.h"
#include "view/live_picture.h"
#include "view/scene_loader.h"

namespace promin::app {

/// What a picture's pipeline depends on beside the scene.
struct Look {
  bool has_shadows = true;
  Shading shading = Shading::kFull;

  bool operator==(const Look&) const = default;
};

/// A scene in device memory.
struct ShownScene {
  /// As its file has it, lit up.
  std::shared_ptr<const Scene> scene;
  /// What of it is on the device.
  SceneChoice choice;
  FeatureMask features = 0;
  PrimitiveNumbers numbers;
  std::shared_ptr<const DeviceScene> on_device;

  /// Of a picture that shows light.
  FeatureMask light_features(const Look& look) const;
};

/// A picture that can be traced at once.
struct ReadyPicture {
  std::shared_ptr<const ShownScene> scene;
  Look look;
  LivePicture picture;
};

/// Makes pictures on a thread of its own, one at a time: reads, packs, builds, uploads and compiles, while another
/// picture is shown.
class PictureMaker {
 public:
  PictureMaker(const gpu::Device& device, double budget_ms) : device_(&device), budget_ms_(budget_ms) {}
  /// Gives up what is under way: a tree that is being built is not waited for.
  ~PictureMaker();

  // Not while busy. `size` is the window's.
  void read(const std::filesystem::path& file, const SceneChoice& choice, const Look& look, const uvec2& size);
  void pack(std::shared_ptr<const Scene> scene, const SceneChoice& choice, const Look& look, const uvec2& size);
  void compile(std::shared_ptr<const ShownScene> scene, const Look& look, const uvec2& size);

  bool is_busy() const { return work_.is_busy(); }
  bool is_ready() const { return work_.is_ready(); }
  /// What it does just now, in words; empty where it does nothing.
  std::string describe() const;
  /// What it was asked for last, once it is there. Throws InputError, UsageError, RunError.
  std::optional<ReadyPicture> take() { return work_.take(); }
  /// The files of what was read last, also where that failed; empty where nothing was since the last call. Not while
  /// busy.
  std::vector<SourceFile> take_sources() { return std::exchange(sources_, {}); }

 private:
  enum class Step { kReading, kBuilding, kUploading, kCompiling };

  void begin(Step step);
  std::shared_ptr<const ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const SceneChoice& choice);
  ReadyPicture make(std::shared_ptr<const ShownScene> scene, const Look& look, const uvec2& size);

  const gpu::Device* device_;
  double budget_ms_;
  std::atomic<Step> step_ = Step::kReading;
  std::atomic<double> built_ = 0.0;
  std::atomic<bool> is_given_up_ = false;
  std::vector<SourceFile> sources_;
  /// Last: its thread uses the others.
  Background<ReadyPicture> work_;
};

}  // namespace promin::app
