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
#include "trace/film/film.h"
#include "trace/kernels/picture_shaders.h"

// Access to the implementation of Renderer. The window needs it, because it records its own frames; tests and
// measurements need it too.
namespace promin {

/// Options for tests and measurements that pictures do not need.
struct TunedRendererOptions : RendererOptions {
  /// Features to compile even if the scene does not use them. With all features, measurements find the gain of
  /// specialisation; with the features of several small scenes, these scenes share their kernels. The image keeps its
  /// bits.
  FeatureMask more_features = {};
  /// Target for the longest time of a single dispatch. If empty, the device profile decides.
  std::optional<double> target_dispatch_ms = std::nullopt;
  /// The number of pixels that a lane traces together: 1, 2 or 4. If empty, the device profile decides. The image keeps
  /// its bits.
  std::optional<uint32_t> packet_size = std::nullopt;
  /// A fixed number of 8x8 blocks per dispatch, for tests that tiles do not change bits. If 0, the number is adapted.
  uint32_t blocks_per_dispatch = 0;
  /// If true, shaders read the scene from storage buffers even if texel buffers can hold it. The image does not change.
  bool avoids_texels = false;
  /// The shaders. Renderer::explain() does not use other shaders with the same bindings.
  PictureShaders shaders = picture_shaders();
  /// A BVH file that is shared with other processes (pack_scene_sharing). It is not used if `bvh` names a file.
  std::optional<std::filesystem::path> shared_bvh = std::nullopt;
  /// A function that changes the packed scene before it is uploaded, for shaders that read another layout. Empty for no
  /// change.
  std::function<PackedScene(PackedScene)> repack = {};
};

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

struct RendererAccess {
  /// Makes a Renderer like its constructor, for a valid scene in world space.
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
