// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "view/background.h"
#include "view/progressive_picture.h"
#include "view/scene_loader.h"

namespace promin::app {

/// What a picture's pipeline depends on beside the scene.
struct RenderMode {
  bool has_shadows = true;
  Shading shading = Shading::kFull;

  bool operator==(const RenderMode&) const = default;
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
  FeatureMask light_features(const RenderMode& look) const;
};

/// A picture that can be traced at once.
struct ReadyPicture {
  std::shared_ptr<const ShownScene> scene;
  RenderMode look;
  ProgressivePicture picture;
};

/// A scene and how it is to be shown.
struct PictureRequest {
  SceneChoice choice;
  RenderMode look;
  /// The window's, for which room is made.
  uvec2 size{0};
};

/// Makes pictures on a thread of its own, one at a time: reads, packs, builds, uploads and compiles, while another
/// picture is shown.
class ScenePreparer {
 public:
  /// Of a scene's file, and of what it was read from.
  ScenePreparer(const gpu::Device& device, double budget_ms, std::filesystem::path file,
                std::vector<SourceFile> sources);
  /// Gives up what is under way: a tree that is being built is not waited for.
  ~ScenePreparer();

  /// The first picture of a scene that has been read and lit up.
  void begin(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Makes another picture than the one shown where the request is another than the last, or where files of the scene
  /// have changed. Returns whether it has begun to. What failed is not tried again.
  bool update(const std::shared_ptr<const ShownScene>& shown, const PictureRequest& request, double time_s);
  /// Whether a picture in that look, which is not shown, is still to come.
  bool will_show(const RenderMode& look) const { return is_busy() || asked_.look != look; }

  bool is_busy() const { return work_.is_busy(); }
  bool is_ready() const { return work_.is_ready(); }
  /// What it does just now, in words; empty where it does nothing.
  std::string describe() const;
  /// What it was asked for last, once it is there. Throws InputError, UsageError, RunError.
  std::optional<ReadyPicture> take();

 private:
  enum class Step { kReading, kBuilding, kUploading, kCompiling };

  // Start the work; not while busy.
  void read();
  void pack(std::shared_ptr<const Scene> scene);
  void compile(std::shared_ptr<const ShownScene> scene);

  // Parts of the work.
  void enter(Step step);
  std::shared_ptr<const ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const SceneChoice& choice);
  ReadyPicture make(std::shared_ptr<const ShownScene> scene, const PictureRequest& request);

  const gpu::Device* device_;
  double budget_ms_;
  std::filesystem::path file_;
  SceneWatch watch_;
  double next_look_at_files_s_ = 0.0;
  PictureRequest asked_;
  std::atomic<Step> step_ = Step::kReading;
  std::atomic<double> built_ = 0.0;
  std::atomic<bool> is_given_up_ = false;
  /// Of what was read last, also where that failed.
  std::vector<SourceFile> sources_;
  /// Last: its thread uses the others.
  Background<ReadyPicture> work_;
};

}  // namespace promin::app
