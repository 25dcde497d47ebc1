// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "device_scene/pack_scene.h"
#include "promin/renderer.h"
#include "scene/features.h"
#include "scene/world_scene.h"
#include "trace/kernels/picture_shaders.h"

// This header makes renderers with options for tests and measurements. It includes no header of Vulkan.
namespace promin {

class SceneOnDevice;

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
  /// Replaces TraversalForm::waits_with_holes of the device profile. The image does not change.
  std::optional<bool> waits_with_holes = std::nullopt;
  /// The shaders. Renderer::explain() does not use other shaders with the same bindings.
  PictureShaders shaders = picture_shaders();
  /// A BVH file that is shared with other processes (pack_scene_sharing). It is not used if `bvh` names a file.
  std::optional<std::filesystem::path> shared_bvh = std::nullopt;
  /// A function that changes the packed scene before it is uploaded, for shaders that read another layout. Empty for no
  /// change.
  std::function<PackedScene(PackedScene)> repack = {};
};

struct RendererAccess {
  /// Makes a Renderer like its constructor, for a valid scene in world space.
  static Renderer make(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options);
  static SceneOnDevice& scene_of(Renderer& renderer);
  static const SceneOnDevice& scene_of(const Renderer& renderer);
  /// PictureTracer::set_pose() for a valid scene.
  static void set_pose(Renderer& renderer, const world::Scene& posed, TreeOfPose tree);
  /// PictureTracer::render_sample() for a valid view.
  static RenderResult render_sample(Renderer& renderer, const View& view, uint32_t sample,
                                    const ProgressCallback& progress);
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
  return RendererAccess::make(device, world::flatten(scene, world::Purpose::kPictures, options.instances), options);
}

inline RenderResult render_sample(Renderer& renderer, const View& view, uint32_t sample,
                                  const ProgressCallback& progress) {
  return RendererAccess::render_sample(renderer, view, sample, progress);
}

}  // namespace promin
