// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
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
#include "work/spec/common_spec.h"
#include "work/spec/environment_choice.h"

namespace promin::app {

/// The user's choice of the builder of a scene's tree, and of the lights that are on.
struct SceneChoice {
  std::string builder;
  Instancing instances = Instancing::kAuto;
  std::optional<std::filesystem::path> bvh;
  /// Indices of the scene's lights that are off, in order. Indices that a scene does not have are ignored.
  std::vector<uint32_t> lights_off;

  bool operator==(const SceneChoice&) const = default;
};

/// The changes of a scene's environment that the user made in the window. They need another kernel only if the kind of
/// background changes.
struct Surroundings {
  /// Rotation of the light, like EnvironmentOptions::light_rotation_deg. The scene itself is not rotated.
  double light_rotation_deg = 0.0;
  /// The background as a displayed colour, sRGB.
  std::optional<vec3> background = std::nullopt;

  bool operator==(const Surroundings&) const = default;
};

/// A scene prepared for copying to devices.
struct HostScene {
  world::Scene scene;
  PackedScene packed;
  std::shared_ptr<const GlassSolids> glass_solids;
};

/// Returns the same physical device, opened again with a separate queue and without a window.
std::shared_ptr<const gpu::Device> open_same_device(const gpu::Device& device);
/// Returns whether scenes are copied to a separate device if they are on such a device.
bool sets_apart(const gpu::Device& device);

/// The copies of a scene on separate devices. Each exists as long as it is in use.
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
  /// The lit scene of the file. It contains all lights, whether they are on or off.
  std::shared_ptr<const Scene> scene;
  /// The tree, and the lights that are on, as on the device.
  SceneChoice choice;
  Surroundings surroundings = {};
  /// The scene of the file, of which this is a pose.
  std::shared_ptr<const Scene> base = nullptr;
  MotionOptions motion = {};
  /// The light that was chosen for the scene of the file (settle_light()).
  LightChoice light = LightChoice::kAuto;
  /// The display transform of the scene.
  DisplayTransform display;
  /// The first device that has the scene.
  SceneOn first;
  std::shared_ptr<SceneOnDevice> on_device;
  SetupStats setup_stats;
  /// RendererOptions::texture_bytes.
  uint64_t texture_bytes = kDefaultTextureBytes;
  /// The data that was copied to the device; null if the scene on the device was put into another pose since then.
  std::shared_ptr<const HostScene> host;
  /// The copies that set_apart() has made.
  std::shared_ptr<SceneCopies> copies = std::make_shared<SceneCopies>();

  /// Returns the scene with its lights on a separate device, if the device is a CPU and the scene is not large. The
  /// driver of a CPU device compiles in its queue; on a separate device this blocks no other work. Otherwise returns
  /// the scene on the first device. Throws DeviceError, RunError.
  SceneOn set_apart() const;

  /// Returns the data for another device.
  std::shared_ptr<const HostScene> make_host() const;

  // Returns the lights as the devices have them.
  std::vector<Light> lights() const;
  Environment environment() const;
  /// Returns whether the scene can have another environment without another kernel.
  bool takes(const Surroundings& other) const;
  /// Copies lights and environment to all devices that have the scene. Nothing may be traced there meanwhile. It may
  /// take some time. Call ProgressivePicture::take_scene_change() afterwards.
  void put() const;
};

/// A picture that can be traced immediately.
struct ReadyPicture {
  /// The scene of the picture. Its lights may differ from those on the device, so take_lights() must be called before
  /// tracing.
  std::shared_ptr<ShownScene> scene;
  RenderMode mode;
  bool is_draft = false;
  std::unique_ptr<TracedPicture> picture;
  /// True if the devices have the lights.
  bool has_lights = false;
  /// True if the scene is one of an earlier pose that was put into this pose on the device.
  bool is_reused = false;

  /// Copies the lights that are on to the devices, if they do not have them. Nothing may be traced there meanwhile.
  void take_lights();
};

/// A request for a picture: a scene, and how to show it.
struct PictureRequest {
  SceneChoice choice;
  Surroundings surroundings;
  RenderMode mode;
  /// The pose of the scene.
  MotionOptions motion;
  /// The size of the window for which memory is allocated.
  uvec2 size{1};
  /// True if the picture is a draft, which is shown until a better one is compiled. It leaves out features that compile
  /// slowly.
  bool is_draft = false;
};

/// Prepares pictures on a separate thread, one at a time. It reads, packs, builds, uploads and compiles while another
/// picture is shown. If the driver compiles in its queue, it uses a separate device, so that compiling blocks no
/// picture.
class ScenePreparer {
 public:
  /// Creates a preparer. The arguments are: a device, which is opened again; a scene's file, the options for reading it
  /// and its pose; the files from which it was read; the user's options for lighting and showing it; the changes of its
  /// environment; and the view from which an average exposure is computed, with the integrator for which the light is
  /// chosen.
  ScenePreparer(std::shared_ptr<const gpu::Device> device, double budget_ms, std::filesystem::path file,
                LoadOptions load, MotionOptions motion, std::vector<SourceFile> sources, LookOptions look,
                EnvironmentChoice environment, View first_view);
  /// Abandons the current work. It does not wait for a tree that is being built.
  ~ScenePreparer();

  /// Prepares the first picture of a scene that is read and lit. `look` has the light that was chosen for it.
  void begin(std::shared_ptr<const Scene> scene, const LookOptions& look, const PictureRequest& request);
  /// Starts to prepare another picture if the request differs from the last one, or if files of the scene have changed.
  /// Returns whether it has started. Work that failed is not repeated. Another pose is put on the device of the shown
  /// picture, which has the kernels.
  bool update(const std::shared_ptr<ShownScene>& shown, const std::shared_ptr<const gpu::Device>& device,
              const PictureRequest& request, double time_s);
  /// Returns whether a picture in this mode is being prepared and not shown yet.
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

  // The following functions start the work. They must not be called while busy.
  void read();
  void pack(std::shared_ptr<const Scene> scene, bool is_posed);
  /// Prepares a picture of another pose.
  void pose(const ShownScene& shown, std::shared_ptr<const gpu::Device> device);
  /// Prepares a picture with other lights or another mode of a scene that is on the device.
  void compile(std::shared_ptr<ShownScene> scene);

  // The following functions are parts of the work.
  void enter(Step step);
  std::shared_ptr<ShownScene> put_on_device(std::shared_ptr<const Scene> scene, const PictureRequest& request,
                                            std::shared_ptr<const gpu::Device> device);
  TunedRendererOptions options_for(const PictureRequest& request);
  /// Puts a scene of an earlier pose, which nothing shows any more, into another pose. Returns null without such
  /// a scene, or if the picture needs a new one.
  std::shared_ptr<ShownScene> reuse(const std::shared_ptr<const Scene>& scene, const PictureRequest& request,
                                    const std::shared_ptr<const gpu::Device>& device);
  std::shared_ptr<ShownScene> find_unused(const PictureRequest& request, const gpu::Device& device);
  /// Returns the average exposure, computed for the first view.
  float meter_exposure(const ShownScene& shown, TunedRendererOptions options, const RenderMode& mode) const;
  /// Returns the picture of a scene, on a new device if `device` is null.
  ReadyPicture make_first(std::shared_ptr<const Scene> scene, const PictureRequest& request,
                          std::shared_ptr<const gpu::Device> device = nullptr);
  /// Returns the picture, which is traced on the device `on`.
  ReadyPicture make(std::shared_ptr<ShownScene> scene, SceneOn on, const PictureRequest& request);

  std::shared_ptr<const gpu::Device> device_;
  double budget_ms_;
  std::filesystem::path file_;
  LoadOptions load_;
  /// The scene as it was read, in any pose.
  std::shared_ptr<const Scene> base_;
  /// The pose in which the scene was opened. The file of a tree fits this pose.
  MotionOptions motion_;
  /// The user's options, and the options with the light that was chosen for base_.
  LookOptions asked_look_;
  LookOptions look_;
  EnvironmentChoice environment_;
  View first_view_;
  SceneWatch watch_;
  double next_look_at_files_s_ = 0.0;
  PictureRequest asked_;
  /// The size of the traversal stack and the features of all poses so far, so that poses share kernels.
  uint32_t stack_size_ = 0;
  FeatureMask features_;
  /// The last scenes of poses. While one is shown, another one is put into the next pose. Only the work uses them.
  std::deque<std::shared_ptr<ShownScene>> poses_;
  /// True if the current work is another pose.
  std::atomic<bool> is_posing_ = false;
  std::atomic<Step> step_ = Step::kReading;
  std::atomic<double> built_ = 0.0;
  std::atomic<bool> is_given_up_ = false;
  /// The files that were read last, even if reading failed.
  std::vector<SourceFile> sources_;
  /// The thread of this member uses the other members, so it is the last one.
  Background<ReadyPicture> work_;
};

}  // namespace promin::app
