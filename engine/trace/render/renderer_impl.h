// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <set>

#include "device_scene/device_scene.h"
#include "promin/renderer.h"
#include "scene/features.h"
#include "trace/film/film.h"
#include "trace/render/make_renderer.h"

// Access to the implementation of Renderer. The window needs it, because it records its own frames; tests and
// measurements need it too.
namespace promin {

/// A scene on a device and the features that its parts use, which determine the pipeline of a picture.
class SceneOnDevice {
 public:
  SceneOnDevice(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options,
                SetupStats& stats);

  const std::shared_ptr<DeviceScene>& device_scene() const { return device_scene_; }
  const PrimitiveNumbers& numbers() const { return numbers_; }
  /// Returns whether the tree was built in this process and not read from a file.
  bool is_tree_built() const { return is_tree_built_; }
  size_t material_count() const { return shown_materials_.size(); }
  /// Returns the materials of copies that are not in the tree (device_scene/drop_copies.h).
  const std::set<uint32_t>& copied_materials() const { return copied_materials_; }
  /// Returns the material of each object.
  std::span<const uint32_t> object_materials() const { return object_materials_; }

  /// Returns the features of a picture in a mode. The lights and the environment are the scene's, or those given.
  FeatureMask features(const RenderMode& mode) const {
    return features_with(light_features_, environment_features_, mode);
  }
  FeatureMask features_with(FeatureMask lights, FeatureMask environment, const RenderMode& mode) const;

  void set_lights(std::span<const Light> lights);
  void set_materials(std::span<const Material> materials);
  void set_environment(const Environment& environment);

 private:
  FeatureMask more_features_;
  bool is_tree_built_ = true;
  FeatureMask geometry_features_;
  FeatureMask material_features_;
  FeatureMask light_features_;
  FeatureMask environment_features_;
  uint64_t primitive_count_ = 0;
  std::vector<bool> shown_materials_;
  std::set<uint32_t> copied_materials_;
  std::vector<uint32_t> object_materials_;
  PrimitiveNumbers numbers_;
  std::shared_ptr<DeviceScene> device_scene_;
};

}  // namespace promin
