// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene/scene_preparer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "device/device.h"
#include "formats/source_file.h"
#include "promin/error.h"
#include "promin/motion.h"
#include "promin/validate.h"
#include "scene/choose_instances.h"
#include "scene/features.h"
#include "work/pictures/load_posed.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"

namespace promin::app {
namespace {

/// The interval in seconds at which the scene's files are checked.
constexpr double kLookInterval = 0.1;

/// The longest side, in pixels, of the picture from which an average exposure is computed.
constexpr float kMeteredSide = 320.0F;

/// The number of scenes of poses on the device: the one that is shown, the next one, and one that is no longer shown
/// but still in use.
constexpr size_t kMostPoses = 3;

/// Returns the indices of lights that the scene has.
std::vector<uint32_t> keep_known(std::vector<uint32_t> lights, const Scene& scene) {
  std::erase_if(lights, [&](uint32_t light) { return light >= scene.lights.size(); });
  return lights;
}

/// Returns a lit scene in another pose. Lights without motion stay.
std::shared_ptr<const Scene> put_into_pose(const Scene& scene, const MotionOptions& motion) {
  if (scene.motion == nullptr) return std::make_shared<const Scene>(scene);
  return std::make_shared<const Scene>(scene_at(scene, choose_pose(scene, motion)));
}

/// Returns the objects whose transforms differ in another pose, if nothing else of the geometry differs and if they are
/// instances, which move without a new tree. Otherwise returns nullopt.
std::optional<std::vector<std::pair<uint32_t, dmat4>>> find_moved(const ShownScene& shown, const Scene& posed) {
  if (posed.motion == nullptr) return {};
  const Scene& before = *shown.scene;
  const promin::Motion& motion = *posed.motion;
  if (!motion.meshes.empty() || !motion.materials.empty() || before.objects.size() != posed.objects.size()) return {};
  std::vector<std::pair<uint32_t, dmat4>> moved;
  for (uint32_t i = 0; i < posed.objects.size(); ++i) {
    const Object& object = posed.objects[i];
    const bool is_linked = i < motion.objects.size() && motion.objects[i].node != kNoIndex;
    // A pose may give an object another geometry, which takes the number of an earlier one.
    const bool is_own = !is_linked || object.geometry == motion.objects[i].geometry;
    if (object.geometry != before.objects[i].geometry || !is_own) return {};
    if (object.world_from_object == before.objects[i].world_from_object) continue;
    const std::vector<uint32_t>& meshes = shown.on_device->numbers().mesh_of_object;
    if (i >= meshes.size() || meshes[i] == PrimitiveNumbers::kNoMesh) return {};
    if (!is_fit_for_instance(object.world_from_object)) return {};
    moved.emplace_back(i, object.world_from_object);
  }
  return moved;
}

/// Returns the features without those that compile slowly, with as little visible effect as possible.
FeatureMask without_slow_parts(FeatureMask features) {
  return features.without(layout::FEATURE_SHADOWS)
      .without(layout::FEATURE_MIRRORS)
      .without(layout::FEATURE_GLASS)
      .without(layout::FEATURE_BLENDING);
}

}  // namespace

std::shared_ptr<const gpu::Device> open_same_device(const gpu::Device& device) {
  return std::make_shared<const gpu::Device>(
      gpu::DeviceOptions{.selection = std::to_string(device.info().index), .kernel_folder = device.kernel_folder()});
}

bool sets_apart(const gpu::Device& device) {
  // Devices that present late have a single queue for all work, including compiling.
  return device.profile().presents_late;
}

void SceneCopies::add(const SceneOn& copy) {
  const std::lock_guard lock(mutex_);
  copies_.push_back({copy.device, copy.scene});
}

std::vector<SceneOn> SceneCopies::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<SceneOn> there;
  for (const Copy& copy : copies_) {
    SceneOn on{copy.device.lock(), copy.scene.lock()};
    if (on.device && on.scene) there.push_back(std::move(on));
  }
  return there;
}

std::vector<Light> ShownScene::lights() const {
  std::vector<Light> lights = scene->lights;
  switch_lights(lights, choice.lights_off);
  Environment turned = scene->environment;
  turn_light(surroundings.light_rotation_deg, turned, lights);
  return lights;
}

Environment ShownScene::environment() const {
  Environment environment = scene->environment;
  turn_light(surroundings.light_rotation_deg, environment, {});
  if (surroundings.background) show_background({.color = *surroundings.background}, environment);
  return environment;
}

bool ShownScene::takes(const Surroundings& other) const {
  const bool has_same_kind = other.background.has_value() == surroundings.background.has_value();
  return has_same_kind || scene->environment.shows_backdrop();
}

void ShownScene::put() const {
  const std::vector<Light> all_lights = lights();
  const Environment around = environment();
  gpu::translate_vulkan_errors([&] {
    on_device->set_lights(all_lights);
    on_device->set_environment(around);
    for (const SceneOn& copy : copies->list()) {
      copy.scene->set_lights(all_lights);
      copy.scene->set_environment(around);
    }
  });
}

std::shared_ptr<const HostScene> ShownScene::make_host() const {
  auto data = std::make_shared<HostScene>();
  data->scene = world::flatten(*scene, world::Purpose::kPictures, choice.instances);
  data->scene.environment = environment();
  data->glass_solids = std::make_shared<const GlassSolids>(data->scene);
  data->packed = pack_scene(data->scene, choice.builder, {}, texture_bytes);
  data->packed.stack_size = std::max(data->packed.stack_size, first.scene->stack_size());
  return data;
}

SceneOn ShownScene::set_apart() const {
  // Some copies of a scene of this size in bytes need little memory.
  constexpr uint64_t kMostBytes = 256U << 20;
  if (!sets_apart(*first.device) || first.scene->size_bytes() > kMostBytes) return first;
  SceneOn apart{open_same_device(*first.device), nullptr};
  const std::shared_ptr<const HostScene> data = host ? host : make_host();
  const world::Scene& in_world = data->scene;
  apart.scene = upload_scene(*apart.device, data->packed,
                             {in_world.materials, in_world.textures, lights(), environment(), data->glass_solids});
  copies->add(apart);
  return apart;
}

void ReadyPicture::take_lights() {
  if (!has_lights) scene->put();
  picture->picture().take_scene_change();
}

ScenePreparer::ScenePreparer(std::shared_ptr<const gpu::Device> device, double budget_ms, std::filesystem::path file,
                             LoadOptions load, MotionOptions motion, std::vector<SourceFile> sources, LookOptions look,
                             EnvironmentChoice environment, View first_view)
    : device_(std::move(device)),
      budget_ms_(budget_ms),
      file_(std::move(file)),
      load_(std::move(load)),
      motion_(std::move(motion)),
      asked_look_(look),
      environment_(std::move(environment)),
      first_view_(std::move(first_view)),
      watch_(std::move(sources)) {}

ScenePreparer::~ScenePreparer() {
  is_given_up_ = true;
  work_.wait();
}

void ScenePreparer::begin(std::shared_ptr<const Scene> scene, const LookOptions& look, const PictureRequest& request) {
  asked_ = request;
  look_ = look;
  base_ = scene;
  pack(std::move(scene), true);
}

bool ScenePreparer::update(const std::shared_ptr<ShownScene>& shown, const std::shared_ptr<const gpu::Device>& device,
                           const PictureRequest& request, double time_s) {
  if (is_busy()) return false;
  const PictureRequest last = std::exchange(asked_, request);
  const bool has_another_tree = last.choice.builder != request.choice.builder || last.choice.bvh != request.choice.bvh;
  if (has_another_tree) {
    pack(base_, false);
  } else if (last.motion != request.motion) {
    pose(*shown, device);
  } else if (last.choice != request.choice || last.mode != request.mode || last.is_draft != request.is_draft ||
             (last.surroundings != request.surroundings && !shown->takes(request.surroundings))) {
    compile(shown);
  } else {
    if (time_s < next_look_at_files_s_) return false;
    next_look_at_files_s_ = time_s + kLookInterval;
    if (!watch_.has_changed()) return false;
    read();
  }
  return true;
}

std::optional<ReadyPicture> ScenePreparer::take() {
  // Only reading returns files. Other work does not change the set of watched files.
  if (is_ready() && !sources_.empty()) watch_.follow(std::exchange(sources_, {}));
  return work_.take();
}

void ScenePreparer::read() {
  step_ = Step::kReading;
  is_posing_ = false;
  work_.start([this, request = asked_, up = base_->environment.up] {
    const auto scene = std::make_shared<Scene>(load_posed(file_, load_, request.motion, sources_));
    LookOptions look = asked_look_;
    environment_.replace_sky(*scene);
    settle_light(*scene, first_view_.mode.integrator, look);
    light_up(*scene, look, environment_, up);
    look_ = look;
    base_ = scene;
    return make_first(scene, request);
  });
}

void ScenePreparer::pack(std::shared_ptr<const Scene> scene, bool is_posed) {
  step_ = Step::kBuilding;
  is_posing_ = false;
  work_.start([this, scene = std::move(scene), is_posed, request = asked_] {
    return make_first(is_posed ? scene : put_into_pose(*scene, request.motion), request);
  });
}

void ScenePreparer::pose(const ShownScene& shown, std::shared_ptr<const gpu::Device> device) {
  step_ = Step::kBuilding;
  is_posing_ = true;
  stack_size_ = std::max(stack_size_, shown.first.scene->stack_size());
  work_.start([this, device = std::move(device), request = asked_] {
    const std::shared_ptr<const Scene> scene = put_into_pose(*base_, request.motion);
    std::shared_ptr<ShownScene> posed = reuse(scene, request, device);
    const bool is_reused = posed != nullptr;
    if (!is_reused) posed = put_on_device(scene, request, device);
    poses_.push_back(posed);
    SceneOn first = posed->first;
    ReadyPicture ready = make(std::move(posed), std::move(first), request);
    ready.scene->put();
    ready.has_lights = true;
    ready.is_reused = is_reused;
    return ready;
  });
}

void ScenePreparer::compile(std::shared_ptr<ShownScene> scene) {
  step_ = Step::kCompiling;
  is_posing_ = false;
  work_.start([this, scene = std::move(scene), request = asked_] {
    ShownScene chosen = *scene;
    chosen.copies = std::make_shared<SceneCopies>();
    chosen.surroundings = request.surroundings;
    chosen.choice.lights_off = keep_known(request.choice.lights_off, *scene->scene);
    SceneOn apart = chosen.set_apart();
    return make(std::make_shared<ShownScene>(std::move(chosen)), std::move(apart), request);
  });
}

std::string ScenePreparer::describe() const {
  if (!is_busy() || is_posing_) return "";
  switch (step_) {
    case Step::kReading:
      return "reading the scene";
    case Step::kBuilding:
      return fmt::format("building the tree, {:.0f} %", 100.0 * built_);
    case Step::kUploading:
      return "uploading the scene";
    case Step::kCompiling:
      return "compiling";
  }
  return "";
}

void ScenePreparer::enter(Step step) {
  // The owner no longer exists, so the picture is not needed.
  if (is_given_up_)
    throw RunError({"window.scene.closed",
                    "the scene was not opened, because the window closed while a picture was made", "",
                    "keep the window open"});
  step_ = step;
}

std::shared_ptr<ShownScene> ScenePreparer::put_on_device(std::shared_ptr<const Scene> scene,
                                                         const PictureRequest& request,
                                                         std::shared_ptr<const gpu::Device> device) {
  built_ = 0.0;
  enter(Step::kBuilding);
  ShownScene shown;
  shown.scene = scene;
  shown.base = base_;
  shown.motion = request.motion;
  shown.choice = request.choice;
  shown.surroundings = request.surroundings;
  shown.light = look_.light;
  shown.display = choose_display(*base_, look_, DebugView::kNone);
  shown.first.device = device ? std::move(device) : open_same_device(*device_);
  shown.choice.lights_off = keep_known(request.choice.lights_off, *scene);
  TunedRendererOptions options = options_for(request);
  shown.texture_bytes = options.texture_bytes;
  throw_if_invalid(*scene);
  auto host = std::make_shared<HostScene>();
  host->scene = world::flatten(*scene, world::Purpose::kPictures, options.instances);
  host->scene.environment = shown.environment();
  host->glass_solids = std::make_shared<const GlassSolids>(host->scene);
  options.repack = [&host, least = stack_size_](PackedScene packed) {
    packed.stack_size = std::max(packed.stack_size, least);
    host->packed = packed;
    return packed;
  };
  gpu::translate_vulkan_errors([&] {
    shown.on_device = std::make_shared<SceneOnDevice>(*shown.first.device, host->scene, options, shown.setup_stats);
  });
  if (base_->motion != nullptr && !base_->motion->animations.empty()) {
    // Lights and modes keep their own features.
    features_ |= shown.on_device->features_with({}, {}, {DebugView::kNone, false});
  }
  shown.host = std::move(host);
  shown.first.scene = shown.on_device->device_scene();
  if (look_.averages_exposure) shown.display.exposure_ev = meter_exposure(shown, options, request.mode);
  return std::make_shared<ShownScene>(std::move(shown));
}

TunedRendererOptions ScenePreparer::options_for(const PictureRequest& request) {
  TunedRendererOptions options;
  options.builder = request.choice.builder;
  if (request.motion == motion_) options.bvh = request.choice.bvh;
  options.more_features = features_;
  options.instances = request.choice.instances;
  options.texture_bytes = uint64_t{look_.texture_memory_mib} << 20;
  options.progress = [this](double fraction) {
    built_ = fraction;
    if (fraction == 1.0) step_ = Step::kUploading;
    return !is_given_up_;
  };
  return options;
}

std::shared_ptr<ShownScene> ScenePreparer::find_unused(const PictureRequest& request, const gpu::Device& device) {
  std::erase_if(poses_, [&](const std::shared_ptr<ShownScene>& pose) {
    return pose->base != base_ || pose->first.device.get() != &device ||
           pose->choice.builder != request.choice.builder || pose->choice.instances != request.choice.instances;
  });
  // A picture that is no longer shown may still be traced for some frames. The work waits for its end only if there may
  // be no further scene.
  constexpr std::chrono::milliseconds kPause{1};
  constexpr int kMostPauses = 100;
  for (int pause = 0; pause < kMostPauses; ++pause) {
    for (size_t i = 0; i < poses_.size(); ++i) {
      const std::shared_ptr<ShownScene>& pose = poses_[i];
      // Films have further references to the scene on the device, and queries of pixels to the shown scene.
      if (pose.use_count() > 1 || pose->on_device.use_count() > 1 || pose->first.scene.use_count() > 2) continue;
      std::atomic_thread_fence(std::memory_order_acquire);
      std::shared_ptr<ShownScene> unused = pose;
      poses_.erase(poses_.begin() + static_cast<std::ptrdiff_t>(i));
      return unused;
    }
    if (poses_.size() < kMostPoses) return nullptr;
    enter(Step::kBuilding);
    std::this_thread::sleep_for(kPause);
  }
  // The users of the scene keep it, so for some time there is one more.
  poses_.pop_front();
  return nullptr;
}

std::shared_ptr<ShownScene> ScenePreparer::reuse(const std::shared_ptr<const Scene>& scene,
                                                 const PictureRequest& request,
                                                 const std::shared_ptr<const gpu::Device>& device) {
  // Steps show the tree, and the exposure is measured with a renderer.
  if (look_.averages_exposure || request.mode.debug_view == DebugView::kSteps) return nullptr;
  std::shared_ptr<ShownScene> shown = find_unused(request, *device);
  if (shown == nullptr) return nullptr;
  if (const auto moved = find_moved(*shown, *scene)) {
    gpu::translate_vulkan_errors([&] { shown->on_device->set_transforms(*moved); });
  } else {
    throw_if_invalid(*scene);
    const world::Scene flat = world::flatten(*scene, world::Purpose::kPictures, request.choice.instances);
    TunedRendererOptions options = options_for(request);
    options.repack = [least = stack_size_](PackedScene packed) {
      packed.stack_size = std::max(packed.stack_size, least);
      return packed;
    };
    gpu::translate_vulkan_errors(
        [&] { shown->on_device->set_pose(*device, flat, options, TreeOfPose::kRefitted, shown->setup_stats); });
    shown->first.scene = shown->on_device->device_scene();
    features_ |= shown->on_device->features_with({}, {}, {DebugView::kNone, false});
  }
  shown->scene = scene;
  shown->motion = request.motion;
  shown->choice.lights_off = keep_known(request.choice.lights_off, *scene);
  shown->surroundings = request.surroundings;
  shown->host = nullptr;
  shown->copies = std::make_shared<SceneCopies>();
  return shown;
}

float ScenePreparer::meter_exposure(const ShownScene& shown, TunedRendererOptions options,
                                    const RenderMode& mode) const {
  options.mode = {.has_shadows = mode.has_shadows, .integrator = mode.integrator};
  options.aovs.object = true;
  options.aovs.unlit = mixes_unlit(*shown.scene, shown.environment());
  options.repack = {};
  Renderer renderer = make_renderer(*shown.first.device, shown.host->scene, options);
  renderer.set_lights(shown.lights());
  View view = first_view_;
  view.mode = options.mode;
  view.samples_per_pixel = 1;
  const float scale = std::min(1.0F, kMeteredSide / static_cast<float>(std::max(view.size.x, view.size.y)));
  view.size = glm::max(uvec2(vec2(view.size) * scale), uvec2(1));
  const RenderResult metered = renderer.render(view);
  return average_exposure_ev(metered.image.pixels, metered.aovs.object, metered.aovs.unlit);
}

ReadyPicture ScenePreparer::make_first(std::shared_ptr<const Scene> scene, const PictureRequest& request,
                                       std::shared_ptr<const gpu::Device> device) {
  std::shared_ptr<ShownScene> shown = put_on_device(std::move(scene), request, std::move(device));
  SceneOn first = shown->first;
  return make(std::move(shown), std::move(first), request);
}

ReadyPicture ScenePreparer::make(std::shared_ptr<ShownScene> scene, SceneOn on, const PictureRequest& request) {
  enter(Step::kCompiling);
  const std::vector<Light> lights = scene->lights();
  const Environment environment = scene->environment();
  std::unique_ptr<TracedPicture> picture;
  RenderMode mode = request.mode;
  // A draft has no shadows, so a sky of single samples would only be noise.
  if (request.is_draft) mode.integrator = Integrator::kWhitted;
  gpu::translate_vulkan_errors([&] {
    FeatureMask features =
        scene->on_device->features_with(light_features(lights), environment_features(environment), mode) | features_;
    if (shows_unlit(features, mode.debug_view) &&
        shows_unlit_apart(*scene->scene, environment, look_, scene->display)) {
      features |= layout::FEATURE_UNLIT_SHARE;
    }
    if (request.is_draft) features = without_slow_parts(features);
    FilmOptions film_options;
    // A draft is replaced so soon that longer compilation is not worthwhile.
    if (request.is_draft) film_options.expected_samples = 0;
    const bool is_light = mode.debug_view == DebugView::kNone;
    picture = std::make_unique<TracedPicture>(
        std::move(on), features, budget_ms_, is_light ? scene->display : DisplayTransform(),
        [scene] { return scene->set_apart(); }, film_options);
    picture->resize(request.size);
    picture->warm_up();
  });
  return {std::move(scene), mode, request.is_draft, std::move(picture)};
}

}  // namespace promin::app
