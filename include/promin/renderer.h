// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "promin/aovs.h"
#include "promin/explain.h"
#include "promin/export.h"
#include "promin/image.h"
#include "promin/progress.h"
#include "promin/ray_counts.h"
#include "promin/scene.h"
#include "promin/setup_stats.h"
#include "promin/view.h"

namespace promin {

namespace gpu {
class Device;
}

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
  /// How the tree is built: "sah", "median" or "spatial" (builder_names() in promin/setup_stats.h).
  std::string builder = "sah";
  /// A BVH file to take the tree from instead of building one.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// What the first pictures will show: its pipeline is compiled at once, others as they are asked for.
  RenderMode mode = {};
  /// Bring RenderResult::aovs as well. The image's bits stay the same.
  bool with_aovs = false;
  /// Of building the tree; false ends the constructor with Cancelled.
  ProgressCallback progress = {};
};

/// A scene in device memory with the pipeline that its features ask for: pictures, whole or progressively, and single
/// pixels of them. Keeps no reference to the Scene; the Device must outlive it. One Renderer serves one thread at a
/// time; several Renderers may share a Device on several threads.
class PROMIN_EXPORT Renderer {
 public:
  /// Builds the BVH, uploads, compiles. Throws UsageError for an unknown builder, InputError for a scene that is not
  /// valid (see validate) and for a BVH file that is bad or not the scene's, RunError where memory does not suffice or
  /// a device limit is passed, Cancelled.
  Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Traces one picture, and compiles first where its mode is another than the last one's. `progress` is called after
  /// each dispatch. Throws UsageError for a view that breaks the rules of promin/view.h, RunError, Cancelled.
  RenderResult render(const View& view, const ProgressCallback& progress = {});

  /// Traces the view as a window does: in few pixels at first, as many as `budget_ms` allows, then in all of them, then
  /// with 4, 16 and 64 samples a pixel or until the view has its own number. Each picture that is complete goes to
  /// `on_picture`, with `samples_per_pixel` in the second argument's view; where that returns false, this returns. The
  /// whole pictures have the bits of render().
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);

  /// Traces the pixel at these coordinates of the whole picture as `render` does, and tells each ray and light; it
  /// shows light whatever debug view the view has. Throws UsageError for a pixel beyond the picture, RunError where
  /// that would be too much for the device.
  Explanation explain(const View& view, const uvec2& pixel);

  // Changes of the scene that need no tree and upload no geometry. They compile only where the set of features that the
  // scene uses changes, with the next picture. Numbers of lights and materials in the scene stay what they are: as many
  // materials as the scene had, any number of lights. Throw InputError as validate() does.
  void set_lights(std::span<const Light> lights);
  void set_materials(std::span<const Material> materials);
  void set_environment(const Environment& environment);

  const SetupStats& setup_stats() const;
  /// What has been done since the constructor began.
  WorkDone work_done() const;

 private:
  struct Impl;
  friend struct RendererAccess;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
