// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "promin/explain.h"
#include "promin/image.h"
#include "promin/ray_counts.h"
#include "promin/scene.h"
#include "promin/setup_stats.h"
#include "promin/view.h"
#include "trace/picture_shaders.h"

namespace promin {

namespace gpu {
class Device;
}
struct PackedScene;

/// What each pixel's middle sample shows, that of index samples / 2: with an odd number of samples the pixel's centre.
/// Row by row, as the image.
struct Aovs {
  /// Distance from the eye (orthographic: from the plane through it); infinite on a miss.
  std::vector<float> depth;
  /// Geometric normal as Hit::normal: never flipped to the ray; 0 on a miss.
  std::vector<vec3> normal;
  /// As Hit::object and Hit::primitive; kNoId on a miss.
  std::vector<uint32_t> object;
  std::vector<uint32_t> primitive;

  static constexpr uint32_t kNoId = 0xFFFFFFFF;
};

struct RenderResult {
  /// Of the crop window's size.
  Image image;
  /// Empty unless RendererOptions::with_aovs.
  Aovs aovs;
  RayCounts rays;
  /// Device time of the traversal and shading dispatches alone (timestamps where the device has them, else waiting
  /// time on the host).
  double trace_ms = 0.0;
};

struct RendererOptions {
  std::string builder = "sah";
  /// A BVH file (bvh/bvh_file.h) to take the tree from instead of building one.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// Compile every feature in, whether the scene uses it or not: for measuring what specialisation brings.
  bool force_all_features = false;
  /// Features to leave out although the scene uses them, e.g. FEATURE_SHADOWS: then nothing throws a shadow.
  FeatureMask left_out_features = 0;
  /// What the first pictures will show: its pipeline is compiled at once, others as they are asked for.
  Shading shading = Shading::kFull;
  /// Bring RenderResult::aovs as well. The image's bits stay the same.
  bool with_aovs = false;
  /// A single dispatch is not meant to take longer. Where empty, dispatch_target_ms (trace/tracing_kernel.h).
  std::optional<double> target_dispatch_ms = std::nullopt;
  /// Pixels that a lane traces together: 1, 2 or 4; where empty, as suits the device. The image's bits stay the same.
  std::optional<uint32_t> packet_size = std::nullopt;
  /// Reads the scene from storage buffers although texel buffers would do, for tests. The image's bits stay the same.
  bool avoids_texels = false;
  /// Fixed number of 8x8 blocks a dispatch, for tests of tile independence; 0 adapts.
  uint32_t blocks_per_dispatch = 0;
  /// Others with the same bindings are for measurements of pictures; Renderer::explain does not take them.
  PictureShaders shaders = picture_shaders();
  /// What such shaders make of the scene before it is uploaded, where they read another layout of it; empty: nothing.
  std::function<PackedScene(PackedScene)> repack = {};
};

/// A scene in device memory with the pipeline that its features ask for. Keeps no reference to the Scene.
/// One Renderer serves one thread.
class Renderer {
 public:
  /// Builds the BVH, uploads, compiles. Throws UsageError for an unknown builder, InputError for a BVH file that is bad
  /// or not the scene's, RunError where memory does not suffice or a device limit is passed.
  Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Traces one picture, and compiles first where its shading is another than the last one's. `progress` is called
  /// after each dispatch with the fraction done, 0...1.
  RenderResult render(const View& view, const std::function<void(double)>& progress = {});

  /// Traces the pixel at these coordinates of the whole picture as `render` does, and tells each ray and source; of
  /// Shading::kFull whatever the view has. Throws RunError where that would be too much for the device.
  Explanation explain(const View& view, const uvec2& pixel);

  const SetupStats& setup_stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
