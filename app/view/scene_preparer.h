// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "device_scene/pack_scene.h"
#include "device_scene/scene_constants.h"
#include "environment_options.h"
#include "promin/renderer.h"
#include "render/renderer_impl.h"
#include "render_options.h"
#include "scene/world_scene.h"
#include "view/background.h"
#include "view/scene_watch.h"
#include "view/traced_picture.h"

namespace promin::app {

/// The tree that a scene is shown with, and which of its lights are on.
struct SceneChoice {
  std::string builder;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights, in their order; those that a scene does not have are ignored.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// What the user has changed in the window of what surrounds a scene. It needs no other kernel, unless the background
/// is of another kind.
struct Surroundings {
  /// Of EnvironmentOptions; the scene itself is not turned.
  double light_rotation_deg = 0.0;
  /// A colour as shown, sRGB.
  std::optional<vec3> background = std::nullopt;

  bool operator==(const Surroundings&) const = default;
};

/// A scene as it is copied to devices.
struct HostScene {
  world::Scene scene;
  PackedScene packed;
  std::shared_ptr<const GlassSolids> glass_solids;
};

/// The same physical device once more, with a queue of its own, without a window.
std::shared_ptr<const gpu::Device> open_same_device(const gpu::Device& device);
/// Whether scenes are set apart on such a device.
bool sets_apart(const gpu::Device& device);

/// The copies of a scene on devices of their own, as long as somebody has them.
class SceneCopies {
 public:
  void add(const SceneOn& copy);
  std::vector<SceneOn> list() const;

 private:
  struct Copy {
    std::weak_ptr<const gpu::Device> device;
    std::weak_ptr<DeviceScene> scene;
  };
  mutable std::mutex mutex_;
  std::vector<Copy> copies_;
};

/// A scene in device memory.
struct ShownScene {
  /// The scene as its file has it, lit up, whatever lights are on.
  std::shared_ptr<const Scene> scene;
  /// The tree and the lights that are on the device.
  SceneChoice choice;
  Surroundings surroundings = {};
  /// How its light is shown.
  DisplayTransform display;
  /// The device that it was put on first.
  SceneOn first;
  std::shared_ptr<SceneOnDevice> on_device;
  SetupStats setup_stats;
  /// What was copied there.
  std::shared_ptr<const HostScene> host;
  /// What set_apart() has made.
  std::shared_ptr<SceneCopies> copies = std::make_shared<SceneCopies>();

  /// The scene with its lights on a device of its own, on a CPU device and where it is not large: the driver compiles
  /// in its queue, and what is compiled there keeps nobody waiting. Else where it was first. Throws DeviceError,
  /// RunError.
  SceneOn set_apart() const;

  // As they are on the devices.
  std::vector<Light> lights() const;
  Environment environment() const;
  /// Whether other surroundings need no other kernel.
  bool takes(const Surroundings& other) const;
  /// Brings lights and surroundings to all devices that hold the scene, while nothing is traced there. It may take a
  /// while, and ProgressivePicture::take_scene_change() comes after it.
  void put() const;
};

/// A picture that can be traced at once.
struct ReadyPicture {
  /// The lights may be others than those on the device, so take_lights() comes before anything is traced.
  std::shared_ptr<ShownScene> scene;
  RenderMode mode;
  bool is_draft = false;
  std::unique_ptr<TracedPicture> picture;

  /// Brings the lights that are on to the devices, while nothing is being traced there.
  void take_lights();
};

/// A scene and how it is to be shown.
struct PictureRequest {
  SceneChoice choice;
  Surroundings surroundings;
  RenderMode mode;
  /// The size of the window, for which room is made.
  uvec2 size{1};
  /// Whether it is for the time until a better one is compiled: without what takes long to compile.
  bool is_draft = false;
};

/// Makes pictures on a thread of its own, one at a time: reads, packs, builds, uploads and compiles, while another
/// picture is shown. What it compiles on a driver that compiles in its queue has a device of its own, so that it keeps
/// no picture waiting.
class ScenePreparer {
 public:
  /// Takes a device of which it opens others, a scene's file and how it is read, the files that it was read from, how
  /// it is lit and shown, what is changed about its surroundings, and the view by which an average exposure goes.
  ScenePreparer(std::shared_ptr<const gpu::Device> device, double budget_ms, std::filesystem::path file,
                LoadOptions load, std::vector<SourceFile> sources, LookOptions look, EnvironmentChoice environment,
                View first_view);
  /// Gives up the current work: a tree that is being built is not waited for.
  ~ScenePreparer();

  /// Makes the first picture of a scene that has been read, has its surroundings and is lit up.
  void begin(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Makes another picture than the one shown where the request is another than the last, or where files of the scene
  /// have changed. Returns whether it has begun to. Work that failed is not tried again.
  bool update(const std::shared_ptr<ShownScene>& shown, const PictureRequest& request, double time_s);
  /// Whether a picture in that mode, which is not shown, is still to come.
  bool will_show(const RenderMode& mode) const { return is_busy() || asked_.mode != mode; }
  /// Gives up the current work as soon as may be, without waiting.
  void give_up() { is_given_up_ = true; }

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
  void compile(std::shared_ptr<ShownScene> scene);

  // Parts of the work.
  void enter(Step step);
  std::shared_ptr<ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// An average exposure for the first view.
  float meter_exposure(const ShownScene& shown, TunedRendererOptions options, bool has_shadows) const;
  ReadyPicture make_first(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// `on` is where it is traced.
  ReadyPicture make(std::shared_ptr<ShownScene> scene, SceneOn on, const PictureRequest& request);

  std::shared_ptr<const gpu::Device> device_;
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
