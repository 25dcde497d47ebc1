// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "environment_options.h"
#include "promin/renderer.h"
#include "render_options.h"
#include "trace/progressive_picture.h"
#include "view/background.h"
#include "view/scene_watch.h"

namespace promin::app {

/// The tree that a scene is shown with, and which of its lights are on.
struct SceneChoice {
  std::string builder;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights, in their order; those that a scene does not have are ignored.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// A scene in device memory.
struct ShownScene {
  /// The scene as its file has it, lit up, whatever lights are on.
  std::shared_ptr<const Scene> scene;
  /// The tree and the lights that are on the device.
  SceneChoice choice;
  /// How its light is shown.
  DisplayTransform display;
  std::shared_ptr<Renderer> renderer;
};

/// A picture that can be traced at once.
struct ReadyPicture {
  /// The lights may be others than those on the device, so take_lights() comes before anything is traced.
  std::shared_ptr<const ShownScene> scene;
  RenderMode mode;
  ProgressivePicture picture;

  /// Brings the lights that are on to the device, while nothing is being traced there.
  void take_lights();
};

/// A scene and how it is to be shown.
struct PictureRequest {
  SceneChoice choice;
  RenderMode mode;
  /// The size of the window, for which room is made.
  uvec2 size{0};
};

/// Makes pictures on a thread of its own, one at a time: reads, packs, builds, uploads and compiles, while another
/// picture is shown.
class ScenePreparer {
 public:
  /// Takes a scene's file and how it is read, the files that it was read from, how it is lit and shown, what is changed
  /// about its surroundings, and the view by which an average exposure goes.
  ScenePreparer(const gpu::Device& device, double budget_ms, std::filesystem::path file, LoadOptions load,
                std::vector<SourceFile> sources, LookOptions look, EnvironmentChoice environment, View first_view);
  /// Gives up the current work: a tree that is being built is not waited for.
  ~ScenePreparer();

  /// Makes the first picture of a scene that has been read, has its surroundings and is lit up.
  void begin(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Makes another picture than the one shown where the request is another than the last, or where files of the scene
  /// have changed. Returns whether it has begun to. Work that failed is not tried again.
  bool update(const std::shared_ptr<const ShownScene>& shown, const PictureRequest& request, double time_s);
  /// Whether a picture in that mode, which is not shown, is still to come.
  bool will_show(const RenderMode& mode) const { return is_busy() || asked_.mode != mode; }

  bool is_busy() const { return work_.is_busy(); }
  bool is_ready() const { return work_.is_ready(); }
  /// The current work in words; empty where there is none.
  std::string describe() const;
  /// The picture that was asked for last, once it is there. Throws InputError, UsageError, RunError.
  std::optional<ReadyPicture> take();

 private:
  enum class Step { kReading, kBuilding, kUploading, kCompiling };

  // These start the work; they must not be called while busy.
  void read();
  void pack(std::shared_ptr<const Scene> scene);
  /// Makes a picture with other lights or another mode of a scene that is on the device.
  void compile(std::shared_ptr<const ShownScene> scene);

  // Parts of the work.
  void enter(Step step);
  std::shared_ptr<const ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  ReadyPicture make(std::shared_ptr<const ShownScene> scene, const PictureRequest& request);

  const gpu::Device* device_;
  double budget_ms_;
  std::filesystem::path file_;
  LoadOptions load_;
  LookOptions look_;
  EnvironmentChoice environment_;
  View first_view_;
  SceneWatch watch_;
  double next_look_at_files_s_ = 0.0;
  PictureRequest asked_;
  std::atomic<Step> step_ = Step::kReading;
  std::atomic<double> built_ = 0.0;
  std::atomic<bool> is_given_up_ = false;
  /// The files that were read last, also where reading failed.
  std::vector<SourceFile> sources_;
  /// This is the last member, because its thread uses the others.
  Background<ReadyPicture> work_;
};

}  // namespace promin::app
