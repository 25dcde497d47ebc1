// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "device_scene/device_scene.h"
#include "promin/renderer.h"
#include "scene/features.h"
#include "trace/film.h"
#include "trace/picture_shaders.h"

// Access to what is behind Renderer: for the window, which records its frames itself, and for tests and measurements.
namespace promin {

/// Options that pictures do not need: for tests and measurements.
struct TunedRendererOptions : RendererOptions {
  /// Compile every feature in, whether the scene uses it or not: for measuring what specialisation brings.
  bool force_all_features = false;
  /// The longest time that a single dispatch should take. Where it is empty, the device decides.
  std::optional<double> target_dispatch_ms = std::nullopt;
  /// The number of pixels that a lane traces together: 1, 2 or 4. Where it is empty, the device decides. The image's
  /// bits stay the same.
  std::optional<uint32_t> packet_size = std::nullopt;
  /// A fixed number of 8x8 blocks per dispatch, for tests of tile independence; 0 adapts.
  uint32_t blocks_per_dispatch = 0;
  /// Read the scene as storage buffers even where texel buffers hold it. The image's bits stay the same.
  bool avoids_texels = false;
  /// Other shaders with the same bindings; Renderer::explain does not take them.
  PictureShaders shaders = picture_shaders();
  /// A BVH file that is to be had in common with others (pack_scene_sharing). Unless `bvh` names one to take.
  std::optional<std::filesystem::path> shared_bvh = std::nullopt;
  /// Changes the packed scene before it is uploaded, for shaders that read another layout of it. Empty: nothing is
  /// changed.
  std::function<PackedScene(PackedScene)> repack = {};
};

/// A scene on a device and the features that its parts use, which decide what pipeline a picture needs.
class SceneOnDevice {
 public:
  SceneOnDevice(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options,
                SetupStats& stats);

  const std::shared_ptr<DeviceScene>& device_scene() const { return device_scene_; }
  const PrimitiveNumbers& numbers() const { return numbers_; }
  /// Whether the tree was built here, not taken from a file.
  bool is_tree_built() const { return is_tree_built_; }
  size_t material_count() const { return shown_materials_.size(); }
  /// Those of copies that are not in the tree (device_scene/drop_copies.h).
  const std::set<uint32_t>& copied_materials() const { return copied_materials_; }
  /// Of each object.
  std::span<const uint32_t> object_materials() const { return object_materials_; }

  /// The features of a picture in a mode, with the scene's lights and surroundings or with those of others.
  FeatureMask features(const RenderMode& mode) const {
    return features_with(light_features_, environment_features_, mode);
  }
  FeatureMask features_with(FeatureMask lights, FeatureMask environment, const RenderMode& mode) const;

  void set_lights(std::span<const Light> lights);
  void set_materials(std::span<const Material> materials);
  void set_environment(const Environment& environment);

 private:
  bool force_all_features_;
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

struct RendererAccess {
  /// Does what Renderer's constructor does, for a scene that is in the world already and is valid.
  static Renderer make(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options);
  static SceneOnDevice& scene_of(Renderer& renderer);
  static const SceneOnDevice& scene_of(const Renderer& renderer);
};

inline Renderer make_renderer(const gpu::Device& device, const world::Scene& scene,
                              const TunedRendererOptions& options) {
  return RendererAccess::make(device, scene, options);
}
inline Renderer make_renderer(const gpu::Device& device, const world::Scene& scene,
                              const RendererOptions& options = {}) {
  return RendererAccess::make(device, scene, TunedRendererOptions{options});
}
inline Renderer make_renderer(const gpu::Device& device, const Scene& scene, const TunedRendererOptions& options) {
  return RendererAccess::make(device, world::flatten(scene), options);
}

}  // namespace promin
