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
#include "options/render_options.h"
#include "promin/renderer.h"
#include "scene/world_scene.h"
#include "trace/render/renderer_impl.h"
#include "view/display/background.h"
#include "view/display/traced_picture.h"
#include "view/scene/scene_watch.h"
#include "work/spec/environment_choice.h"

namespace promin::app {

/// The builder of a scene's tree, and which of its lights are on.
struct SceneChoice {
  std::string builder;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights, in their order; those that a scene does not have are ignored.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// The user's changes of a scene's environment in the window. They need another kernel only if the kind of the
/// background changes.
struct Surroundings {
  /// As in EnvironmentOptions; the scene itself is not rotated.
  double light_rotation_deg = 0.0;
  /// A displayed colour, sRGB.
  std::optional<vec3> background = std::nullopt;

  bool operator==(const Surroundings&) const = default;
};

/// A scene prepared for copying to devices.
struct HostScene {
  world::Scene scene;
  PackedScene packed;
  std::shared_ptr<const GlassSolids> glass_solids;
};

/// Opens the same physical device again, with a separate queue and without a window.
std::shared_ptr<const gpu::Device> open_same_device(const gpu::Device& device);
/// Returns whether scenes are set apart on such a device.
bool sets_apart(const gpu::Device& device);

/// The copies of a scene on separate devices, as long as they are in use.
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
  /// The lit scene of the file, regardless of which lights are on.
  std::shared_ptr<const Scene> scene;
  /// The tree and the lights that are on the device.
  SceneChoice choice;
  Surroundings surroundings = {};
  /// How the scene's light is mapped to the display.
  DisplayTransform display;
  /// The first device that it was copied to.
  SceneOn first;
  std::shared_ptr<SceneOnDevice> on_device;
  SetupStats setup_stats;
  /// The data that was copied there.
  std::shared_ptr<const HostScene> host;
  /// The copies that set_apart() has made.
  std::shared_ptr<SceneCopies> copies = std::make_shared<SceneCopies>();

  /// Returns the scene with its lights on a separate device, for CPU devices and scenes that are not large: such a
  /// driver compiles in its queue, and on a separate device that blocks no other work. Else returns the first device.
  /// Throws DeviceError, RunError.
  SceneOn set_apart() const;

  // Returns the lights as they are on the devices.
  std::vector<Light> lights() const;
  Environment environment() const;
  /// Returns whether another environment needs no other kernel.
  bool takes(const Surroundings& other) const;
  /// Copies lights and environment to all devices with the scene, while nothing is traced there. It may take some time.
  /// Call ProgressivePicture::take_scene_change() afterwards.
  void put() const;
};

/// A picture that can be traced immediately.
struct ReadyPicture {
  /// Its lights may differ from those on the device, so call take_lights() before tracing.
  std::shared_ptr<ShownScene> scene;
  RenderMode mode;
  bool is_draft = false;
  std::unique_ptr<TracedPicture> picture;

  /// Copies the lights that are on to the devices, while nothing is traced there.
  void take_lights();
};

/// The request for a picture: a scene and how to show it.
struct PictureRequest {
  SceneChoice choice;
  Surroundings surroundings;
  RenderMode mode;
  /// The size of the window, for which room is made.
  uvec2 size{1};
  /// Whether it only bridges the time until a better one is compiled, and leaves out features that compile slowly.
  bool is_draft = false;
};

/// Prepares pictures on a separate thread, one at a time: reads, packs, builds, uploads and compiles while another
/// picture is shown. If the driver compiles in its queue, it uses a separate device, so that compiling blocks no
/// picture.
class ScenePreparer {
 public:
  /// Takes a device of which it opens others, a scene's file and how it is read, the files that it was read from, how
  /// it is lit and shown, what is changed about its surroundings, and the view by which an average exposure goes.
  ScenePreparer(std::shared_ptr<const gpu::Device> device, double budget_ms, std::filesystem::path file,
                LoadOptions load, std::vector<SourceFile> sources, LookOptions look, EnvironmentChoice environment,
                View first_view);
  /// Abandons the current work without waiting for a tree that is being built.
  ~ScenePreparer();

  /// Prepares the first picture of a scene that is read and lit.
  void begin(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Starts to prepare another picture if the request differs from the last one or files of the scene have changed.
  /// Returns whether it has started. Failed work is not repeated.
  bool update(const std::shared_ptr<ShownScene>& shown, const PictureRequest& request, double time_s);
  /// Returns whether a picture in that mode, which is not shown yet, is being prepared.
  bool will_show(const RenderMode& mode) const { return is_busy() || asked_.mode != mode; }
  /// Abandons the current work as soon as possible, without waiting.
  void give_up() { is_given_up_ = true; }

  bool is_busy() const { return work_.is_busy(); }
  bool is_ready() const { return work_.is_ready(); }
  /// Returns a description of the current work; empty if there is none.
  std::string describe() const;
  /// Returns the last requested picture when it is ready. Throws InputError, UsageError, RunError.
  std::optional<ReadyPicture> take();

 private:
  enum class Step { kReading, kBuilding, kUploading, kCompiling };

  // These start the work; they must not be called while busy.
  void read();
  void pack(std::shared_ptr<const Scene> scene);
  /// Prepares a picture with other lights or another mode of a scene that is on the device.
  void compile(std::shared_ptr<ShownScene> scene);

  // Parts of the work.
  void enter(Step step);
  std::shared_ptr<ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Computes the average exposure for the first view.
  float meter_exposure(const ShownScene& shown, TunedRendererOptions options, bool has_shadows) const;
  ReadyPicture make_first(std::shared_ptr<const Scene> scene, const PictureRequest& request);
  /// Creates the picture, which is traced on the device `on`.
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
  /// The files that were read last, even if reading failed.
  std::vector<SourceFile> sources_;
  /// This is the last member, because its thread uses the others.
  Background<ReadyPicture> work_;
};

}  // namespace promin::app
