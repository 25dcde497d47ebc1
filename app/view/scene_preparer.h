// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "promin/renderer.h"
#include "trace/progressive_picture.h"
#include "view/background.h"
#include "view/scene_watch.h"

namespace promin::app {

/// With which tree a scene is shown, and which of its lights are on.
struct SceneChoice {
  std::string builder;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights, in their order; those that a scene does not have are passed over.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// A scene in device memory.
struct ShownScene {
  /// As its file has it, lit up, whatever lights are on.
  std::shared_ptr<const Scene> scene;
  /// What of it is on the device.
  SceneChoice choice;
  std::shared_ptr<Renderer> renderer;
};

/// A picture that can be traced at once.
struct ReadyPicture {
  /// Its lights may be others than those on the device: take_lights() comes before anything is traced.
  std::shared_ptr<const ShownScene> scene;
  RenderMode mode;
  ProgressivePicture picture;

  /// Brings the lights that are on to the device; nothing is being traced there.
  void take_lights();
};

/// A scene and how it is to be shown.
struct PictureRequest {
  SceneChoice choice;
  RenderMode mode;
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
  /// Whether a picture in that mode, which is not shown, is still to come.
  bool will_show(const RenderMode& mode) const { return is_busy() || asked_.mode != mode; }

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
  /// For other lights or another mode of a scene on the device.
  void compile(std::shared_ptr<const ShownScene> scene);

  // Parts of the work.
  void enter(Step step);
  std::shared_ptr<const ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const PictureRequest& request);
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
