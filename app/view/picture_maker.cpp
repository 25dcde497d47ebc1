// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/picture_maker.h"

#include <fmt/format.h>

#include "console.h"
#include "core/error.h"
#include "gpu/device.h"
#include "scene/load_scene.h"
#include "view_setup.h"

namespace promin::app {

FeatureMask ShownScene::light_features(const Look& look) const {
  return features & ~(look.has_shadows ? 0 : layout::FEATURE_SHADOWS);
}

PictureMaker::~PictureMaker() {
  is_given_up_ = true;
  work_.wait();
}

void PictureMaker::read(const std::filesystem::path& file, const SceneChoice& choice, const Look& look,
                        const uvec2& size) {
  step_ = Step::kReading;
  work_.start([this, file, choice, look, size] {
    const auto scene = std::make_shared<Scene>(load_scene(file, sources_));
    light_up(*scene, Console(Verbosity::kQuiet));
    return make(put_on_device(scene, choice), look, size);
  });
}

void PictureMaker::pack(std::shared_ptr<const Scene> scene, const SceneChoice& choice, const Look& look,
                        const uvec2& size) {
  step_ = Step::kBuilding;
  work_.start(
      [this, scene = std::move(scene), choice, look, size] { return make(put_on_device(scene, choice), look, size); });
}

void PictureMaker::compile(std::shared_ptr<const ShownScene> scene, const Look& look, const uvec2& size) {
  step_ = Step::kCompiling;
  work_.start([this, scene = std::move(scene), look, size] { return make(scene, look, size); });
}

std::string PictureMaker::describe() const {
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

void PictureMaker::begin(Step step) {
  // Nobody is left to take it.
  if (is_given_up_) throw RunError({"given up", "while a picture was made", "keep the window open"});
  step_ = step;
}

std::shared_ptr<const ShownScene> PictureMaker::put_on_device(std::shared_ptr<const Scene> scene,
                                                              const SceneChoice& choice) {
  built_ = 0.0;
  begin(Step::kBuilding);
  // A builder ends by what its callback throws.
  PackedChoice packed = pack_choice(*scene, choice, [this](double fraction) {
    built_ = fraction;
    begin(Step::kBuilding);
  });
  begin(Step::kUploading);
  ShownScene shown{std::move(scene), std::move(packed.choice), packed.features, {}, nullptr};
  gpu::translate_vulkan_errors([&] { shown.on_device = std::make_shared<const DeviceScene>(*device_, packed.packed); });
  shown.numbers = std::move(packed.packed.numbers);
  return std::make_shared<const ShownScene>(std::move(shown));
}

ReadyPicture PictureMaker::make(std::shared_ptr<const ShownScene> scene, const Look& look, const uvec2& size) {
  begin(Step::kCompiling);
  std::optional<LivePicture> picture;
  gpu::translate_vulkan_errors([&] {
    const FeatureMask features = scene->light_features(look) | features_of(look.shading);
    picture.emplace(*device_, scene->on_device, features, budget_ms_);
    picture->resize(size);
  });
  return {std::move(scene), look, std::move(*picture)};
}

}  // namespace promin::app
