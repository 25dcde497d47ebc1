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

/// The accuracy that a picture with an error target has reached (View::error_target).
struct PictureError {
  /// The target error. A render with this target gives the same picture.
  float target = 0.0F;
  /// The largest claim of a pixel: relative to ErrorTarget::white, or to its largest channel if that is more, or as
  /// displayed (ErrorTarget::display). Claims that are NaN are ignored.
  float largest_claim = 0.0F;
  /// Number of pixels that have taken the largest number of samples and still claim more than the target.
  uint64_t unmet_pixels = 0;
  /// Number of samples of all pixels together.
  uint64_t samples = 0;

  /// Adds the result of another part of the picture, or of another picture. The target stays.
  PictureError& operator+=(const PictureError& other) {
    largest_claim = largest_claim < other.largest_claim ? other.largest_claim : largest_claim;
    unmet_pixels += other.unmet_pixels;
    samples += other.samples;
    return *this;
  }
};

/// A picture, its AOVs and statistics.
struct RenderResult {
  /// The picture, of the size of View::crop, or of View::size without a crop.
  Image image;
  /// The AOVs that RendererOptions select; all others are empty.
  Aovs aovs;
  /// Set for pictures with an error target.
  std::optional<PictureError> error;
  /// Number of samples of each pixel; 0 with an error target, because the number then differs between pixels.
  uint32_t samples_per_pixel = 0;
  /// Rays traced for the picture. With Aovs::error this includes the rays of the pixels around it, which the estimate
  /// needs.
  RayCounts rays;
  /// Milliseconds of the traversal and shading dispatches on the device: by timestamps if the device has them, else the
  /// time that the host waits.
  double trace_ms = 0.0;
};

/// Options of a Renderer. The defaults suit most scenes.
struct RendererOptions {
  /// The builder of the tree, one of builder_names() (promin/setup_stats.h): "sah" builds a good tree fast, "median" is
  /// the simplest, "spatial" takes longest and helps with long, thin triangles. The pictures have the same bits.
  std::string builder = "sah";
  /// A BVH file to read the tree from. Without one the tree is built.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// The mode of the first pictures, whose pipeline is compiled by the constructor. Pipelines of other modes are
  /// compiled when they are first used.
  RenderMode mode = {};
  /// Whether the first pictures have an error target, which needs another pipeline. render_within starts without one.
  bool has_error_target = false;
  /// The approximate number of samples of all pictures and pixels together. If it is small, kernels are used that
  /// compile faster and trace slower. The pictures have the same bits.
  uint64_t expected_samples = std::numeric_limits<uint64_t>::max();
  /// The largest number of bytes of device memory for the scene's images and their levels. The largest images are
  /// halved until all fit, with a warning in SetupStats::warnings. Pictures depend on this limit but never on the
  /// device's memory: if the device has no room for the images, the constructor throws RunError.
  uint64_t texture_bytes = kDefaultTextureBytes;
  /// Whether render() returns AovSet::of_surfaces() in RenderResult::aovs. The image keeps its bits.
  bool with_aovs = false;
  /// Further AOVs that it returns there. With `alpha` the image has no background; else it keeps its bits.
  AovSet aovs = {};
  /// Receives the progress of building the tree. If it returns false, the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// Renders a scene: whole pictures, progressive pictures and explanations of single pixels. It holds the scene in
/// device memory and the pipelines for the features that the scene uses. The same scene and view give the same bits on
/// the same device.
///
/// Lifetimes: the Device must outlive the Renderer. The Renderer keeps no reference to the Scene, which may change or
/// be destroyed. After a move the old Renderer may only be destroyed or assigned to. Threads: only one thread at a time
/// may use a Renderer. Several Renderers and Casters may share a Device on several threads. Failures: after an
/// exception the Renderer stays usable, unless the device was lost.
class PROMIN_EXPORT Renderer {
 public:
  /// Builds the tree (a bounding volume hierarchy), uploads the scene and compiles the pipeline. Throws UsageError for
  /// an unknown builder, InputError for an invalid scene (see validate) and for a BVH file that is damaged or belongs
  /// to another scene, RunError if memory runs out, a device limit is exceeded or the images do not fit in
  /// RendererOptions::texture_bytes even as single texels, and Cancelled.
  Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options = {});
  ~Renderer();
  /// Moves the other Renderer's contents here.
  Renderer(Renderer&&) noexcept;
  /// Frees its own contents and moves the other Renderer's here.
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders one picture. If its mode differs from the last one's, the pipeline is compiled first. Calls `progress`
  /// after each dispatch. Throws UsageError for a view that breaks the rules of promin/view.h, RunError and Cancelled.
  RenderResult render(const View& view, const ProgressCallback& progress = {});

  /// Renders the best whole picture that fits into about `seconds`, including compilation. It starts with one sample
  /// per pixel. If there is time, it refines to an error of 1/8 and then further, in steps of the square root of 2,
  /// down to the view's own error; PictureError::target is the last target reached. With less time it takes a fixed
  /// number of samples, RenderResult::samples_per_pixel. `render` gives the same bits for that target or number. A
  /// picture is abandoned if it takes longer than 1.15 times the limit, or if the estimate after a tenth of it says so;
  /// a picture with fewer samples replaces it. The picture of one sample is never abandoned. Needs 200 bytes of memory
  /// per pixel. `seconds` is finite; 0 or less gives one sample. Throws as `render` does, and UsageError for a view
  /// without an error target.
  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress = {});

  /// Renders the view as a window does: first as many pixels as `budget_ms` allows, then all of them, then with 4, 16
  /// and 64 samples per pixel up to the view's own number. A view with an error target is refined through the errors of
  /// render_within instead. Passes each complete picture to `on_picture`; the view of the second argument has its size
  /// and its samples or error. Returns early if `on_picture` returns false. Pictures of the view's size have the bits
  /// that render() gives for the passed view. Throws UsageError for a view that breaks the rules of promin/view.h or
  /// has a crop, for a budget that is not a positive finite number of milliseconds and for an empty `on_picture`, and
  /// RunError.
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);

  /// Traces the pixel at these coordinates of the whole picture as `render` does, and returns each of its rays and
  /// light contributions. It ignores the view's debug view. Throws UsageError for a view that breaks the rules of
  /// promin/view.h and for a pixel outside the picture, and RunError if the pixel needs more than the device can
  /// record.
  Explanation explain(const View& view, const uvec2& pixel);

  // Changes of the scene that neither rebuild the tree nor upload geometry. The next picture compiles a pipeline only
  // if the set of features that the scene uses has changed.

  /// Replaces all lights by any number of lights. Throws InputError if validate() finds problems, and RunError.
  void set_lights(std::span<const Light> lights);
  /// Replaces all materials by the same number of materials. Properties for which meshes and images were prepared stay
  /// those of the original scene: which materials have normal textures, the placement and wrapping of textures, the
  /// cutoffs of masks, and the glass solids in which a camera may be. Throws InputError for another number of
  /// materials, if validate() finds problems, and if a material of more than 1024 identical primitives stops being
  /// opaque, because the tree contains only one of them. Throws RunError.
  void set_materials(std::span<const Material> materials);
  /// Replaces ambient light and background. Throws InputError if validate() finds problems.
  void set_environment(const Environment& environment);

  /// Returns the cost of construction. The reference is valid as long as the Renderer.
  const SetupStats& setup_stats() const;
  /// Returns counts of the work since the constructor began.
  WorkDone work_done() const;

 private:
  struct Impl;
  friend struct RendererAccess;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
