// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene_preparer.h"

#include <fmt/format.h>

#include "console.h"
#include "device/device.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "view_setup.h"

namespace promin::app {
namespace {

/// At the files of the scene, in seconds.
constexpr double kLookInterval = 0.1;

}  // namespace

FeatureMask ShownScene::light_features(const RenderMode& look) const {
  return features & ~(look.has_shadows ? 0 : layout::FEATURE_SHADOWS);
}

ScenePreparer::ScenePreparer(const gpu::Device& device, double budget_ms, std::filesystem::path file,
                             std::vector<SourceFile> sources)
    : device_(&device), budget_ms_(budget_ms), file_(std::move(file)), watch_(std::move(sources)) {}

ScenePreparer::~ScenePreparer() {
  is_given_up_ = true;
  work_.wait();
}

void ScenePreparer::begin(std::shared_ptr<const Scene> scene, const PictureRequest& request) {
  asked_ = request;
  pack(std::move(scene));
}

bool ScenePreparer::update(const std::shared_ptr<const ShownScene>& shown, const PictureRequest& request,
                           double time_s) {
  if (is_busy()) return false;
  const PictureRequest last = std::exchange(asked_, request);
  if (last.choice != request.choice) {
    pack(shown->scene);
  } else if (last.look != request.look) {
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
  // Only of what was read: other work leaves the files as they are known.
  if (is_ready() && !sources_.empty()) watch_.follow(std::exchange(sources_, {}));
  return work_.take();
}

void ScenePreparer::read() {
  step_ = Step::kReading;
  work_.start([this, request = asked_] {
    const auto scene = std::make_shared<Scene>(load_scene(file_, sources_));
    light_up(*scene, Console(Verbosity::kQuiet));
    return make(put_on_device(scene, request.choice), request);
  });
}

void ScenePreparer::pack(std::shared_ptr<const Scene> scene) {
  step_ = Step::kBuilding;
  work_.start([this, scene = std::move(scene), request = asked_] {
    return make(put_on_device(scene, request.choice), request);
  });
}

void ScenePreparer::compile(std::shared_ptr<const ShownScene> scene) {
  step_ = Step::kCompiling;
  work_.start([this, scene = std::move(scene), request = asked_] { return make(scene, request); });
}

std::string ScenePreparer::describe() const {
  if (!is_busy()) return "";
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
  // Nobody is left to take it.
  if (is_given_up_) throw RunError({"given up", "while a picture was made", "keep the window open"});
  step_ = step;
}

std::shared_ptr<const ShownScene> ScenePreparer::put_on_device(std::shared_ptr<const Scene> scene,
                                                               const SceneChoice& choice) {
  built_ = 0.0;
  enter(Step::kBuilding);
  // A builder ends by what its callback throws.
  PackedChoice packed = pack_choice(*scene, choice, [this](double fraction) {
    built_ = fraction;
    enter(Step::kBuilding);
  });
  enter(Step::kUploading);
  ShownScene shown{std::move(scene), std::move(packed.choice), packed.features, {}, nullptr};
  gpu::translate_vulkan_errors([&] { shown.on_device = std::make_shared<const DeviceScene>(*device_, packed.packed); });
  shown.numbers = std::move(packed.packed.numbers);
  return std::make_shared<const ShownScene>(std::move(shown));
}

ReadyPicture ScenePreparer::make(std::shared_ptr<const ShownScene> scene, const PictureRequest& request) {
  enter(Step::kCompiling);
  std::optional<ProgressivePicture> picture;
  gpu::translate_vulkan_errors([&] {
    const FeatureMask features = scene->light_features(request.look) | features_of(request.look.shading);
    picture.emplace(*device_, scene->on_device, features, budget_ms_);
    picture->resize(request.size);
  });
  return {std::move(scene), request.look, std::move(*picture)};
}

}  // namespace promin::app
