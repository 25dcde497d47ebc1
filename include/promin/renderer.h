// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
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

/// How exact a picture with an error target came to be (View::error_target).
struct PictureError {
  /// The error that was asked for: the one to ask for to have the same picture again.
  float target = 0.0F;
  /// The largest claim of a pixel, of ErrorTarget::white or of its largest channel where that is more, or as it is
  /// shown (ErrorTarget::display). Claims that are no numbers are left out.
  float largest_claim = 0.0F;
  /// Pixels that have taken the most samples and claim more than the target.
  uint64_t unmet_pixels = 0;
  /// Of the picture's pixels together.
  uint64_t samples = 0;

  /// Adds what another part of the picture has come to, or another picture; the target stays.
  PictureError& operator+=(const PictureError& other) {
    largest_claim = largest_claim < other.largest_claim ? other.largest_claim : largest_claim;
    unmet_pixels += other.unmet_pixels;
    samples += other.samples;
    return *this;
  }
};

/// A picture and what it took.
struct RenderResult {
  /// Of the size of View::crop, or of View::size without one.
  Image image;
  /// What RendererOptions ask for; else empty.
  Aovs aovs;
  /// Of pictures with an error target.
  std::optional<PictureError> error;
  /// How many samples each pixel has; 0 with an error target, where the number differs from pixel to pixel.
  uint32_t samples_per_pixel = 0;
  /// Rays of the whole picture, and where Aovs::error is told of the pixels around it, which are traced for it.
  RayCounts rays;
  /// Device time of the traversal and shading dispatches alone (timestamps where the device has them, else waiting
  /// time on the host).
  double trace_ms = 0.0;
};

/// How a Renderer is made. The defaults suit most scenes.
struct RendererOptions {
  /// How the tree is built, one of builder_names() (promin/setup_stats.h): "sah" is built fast and is good, "median" is
  /// the simplest, "spatial" takes longest to build and helps where triangles are long and thin. Pictures have the same
  /// bits.
  std::string builder = "sah";
  /// A BVH file to take the tree from instead of building one.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// What the first pictures will show: its pipeline is compiled at once, others as they are asked for.
  RenderMode mode = {};
  /// Whether the first pictures have an error target, for which another pipeline is compiled. render_within begins
  /// without.
  bool has_error_target = false;
  /// About how many samples all pictures will have together, over all pixels. Where they are few, kernels are taken
  /// that are compiled sooner and trace slower. Pictures have the same bits.
  uint64_t expected_samples = std::numeric_limits<uint64_t>::max();
  /// Most bytes that the scene's images may take in device memory, with their levels: beyond it the largest ones are
  /// halved until all fit, which SetupStats::warnings tells. It decides about pictures, never the device: one that has
  /// no room for what fits is a RunError.
  uint64_t texture_bytes = kDefaultTextureBytes;
  /// Whether render() tells AovSet::of_surfaces() in RenderResult::aovs. The image's bits stay the same.
  bool with_aovs = false;
  /// What else it tells there. Where `alpha` is among them the image has no background; else its bits stay the same.
  AovSet aovs = {};
  /// Told how far building the tree is; where it returns false the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// A scene in device memory with the pipeline that its features ask for: pictures, whole or progressively, and single
/// pixels of them. The same scene and view give the same bits on the same device.
///
/// Lifetimes: the Device must outlive the Renderer; of the Scene it keeps nothing, so the scene may change or end.
/// After a move the old Renderer may only be destroyed or assigned to. Threads: one Renderer serves one thread at a
/// time; several Renderers and Casters may share a Device on several threads. Failures: what a call threw leaves the
/// Renderer as usable as before, unless the device was lost.
class PROMIN_EXPORT Renderer {
 public:
  /// Builds the tree, a bounding volume hierarchy, uploads the scene and compiles the pipeline. Throws UsageError for
  /// an unknown builder, InputError for a scene that is not valid (see validate) and for a BVH file that is bad or not
  /// the scene's, RunError where memory does not suffice, a device limit is passed or images do not fit in
  /// RendererOptions::texture_bytes even as single texels, Cancelled.
  Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options = {});
  ~Renderer();
  /// Takes all that the other has.
  Renderer(Renderer&&) noexcept;
  /// Takes all that the other has, and frees its own.
  Renderer& operator=(Renderer&&) noexcept;

  /// Traces one picture, and compiles first where its mode is another than the last one's. `progress` is called after
  /// each dispatch. Throws UsageError for a view that breaks the rules of promin/view.h, RunError, Cancelled.
  RenderResult render(const View& view, const ProgressCallback& progress = {});

  /// The best whole picture that fits into about `seconds`, compilation included. It begins with one sample a pixel.
  /// Where there is time it refines to an error of 1/8 and below, down to the view's own, in steps of the root of 2:
  /// PictureError::target has the last. With less time it takes a fixed number of samples, RenderResult::
  /// samples_per_pixel. `render` gives the same bits by either number. What takes longer than 1.15 of the time, or
  /// is foretold to when a tenth is traced, is abandoned: fewer samples come in its place, or the picture of one
  /// sample, which is never abandoned. Takes 200 bytes of memory a pixel. `seconds` is finite; at most 0: one sample.
  /// Throws as `render`, and UsageError for a view without an error target.
  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress = {});

  /// Traces the view as a window does: in few pixels at first, as many as `budget_ms` allows, then in all of them, then
  /// with 4, 16 and 64 samples a pixel or until the view has its own number, or where it has an error target with the
  /// errors of render_within until that is reached. Each picture that is complete goes to `on_picture`, with its size,
  /// and its samples or error, in the second argument's view; where that returns false, this returns. The pictures of
  /// the view's size have the bits that render() gives of that view. Throws UsageError for a view
  /// that breaks the rules of promin/view.h or has a crop, for a budget that is not a positive finite number of
  /// milliseconds and without `on_picture`; RunError.
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);

  /// Traces the pixel at these coordinates of the whole picture as `render` does, and tells each ray and light; it
  /// shows light whatever debug view the view has. Throws UsageError for a view that breaks the rules of promin/view.h
  /// and for a pixel beyond the picture, RunError where
  /// that would be too much for the device.
  Explanation explain(const View& view, const uvec2& pixel);

  // Changes of the scene that build no tree and upload no geometry. The next picture compiles where the set of features
  // that the scene uses is another than before, and else nothing does.

  /// Replaces all lights, by any number. Throws InputError as validate() finds fault, RunError.
  void set_lights(std::span<const Light> lights);
  /// Replaces all materials, by as many as the scene had. What meshes and images were made ready for holds on: which
  /// materials have textures of normals, how textures are placed and wrapped, cutoffs of masks, in which solids of
  /// glass a camera may be. Throws InputError for another number of them, as validate() finds fault, and where a
  /// material of more than 1024 identical primitives is opaque no longer: the tree has one of them. Throws RunError.
  void set_materials(std::span<const Material> materials);
  /// Replaces ambient light and background. Throws InputError as validate() finds fault.
  void set_environment(const Environment& environment);

  /// What making this has cost. Valid while the Renderer is.
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
