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
#include <utility>

#include "promin/aovs.h"
#include "promin/explain.h"
#include "promin/export.h"
#include "promin/image.h"
#include "promin/instances.h"
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
  /// The target error that the picture reached. render() with this target returns the same picture.
  float target = 0.0F;
  /// The largest claim of a pixel. It is relative to ErrorTarget::white, or to the pixel's largest channel if that is
  /// larger, or it is measured as displayed (ErrorTarget::display). Claims that are NaN are ignored.
  float largest_claim = 0.0F;
  /// Number of pixels that have the largest number of samples and whose claim still exceeds the target.
  uint64_t unmet_pixels = 0;
  /// Number of samples, summed over all pixels.
  uint64_t samples = 0;
  /// Number of samples that each pixel takes first. It may be larger than ErrorTarget::min_samples.
  uint32_t first_samples = 0;

  /// Adds the result of another part of the picture, or of another picture. The target does not change.
  PictureError& operator+=(const PictureError& other) {
    largest_claim = largest_claim < other.largest_claim ? other.largest_claim : largest_claim;
    unmet_pixels += other.unmet_pixels;
    samples += other.samples;
    first_samples = first_samples < other.first_samples ? other.first_samples : first_samples;
    return *this;
  }
};

/// A picture, its AOVs and statistics.
struct RenderResult {
  /// The picture. Its size is that of View::crop, or View::size without a crop.
  Image image;
  /// The AOVs that RendererOptions select; all others are empty.
  Aovs aovs;
  /// The accuracy; empty for pictures without an error target.
  std::optional<PictureError> error;
  /// Number of samples of each pixel; 0 with an error target, because pixels then have different numbers.
  uint32_t samples_per_pixel = 0;
  /// Rays traced for the picture. With Aovs::error this includes the rays of the surrounding pixels, which the estimate
  /// needs.
  RayCounts rays;
  /// Time of the traversal and shading dispatches on the device, in milliseconds. It is measured by the device's
  /// timestamps, or else as the time that the host waits.
  double trace_ms = 0.0;
};

/// Options of a Renderer. The defaults suit most scenes.
struct RendererOptions {
  /// The builder of the tree, one of builder_names() (promin/setup_stats.h): "sah" builds a good tree fast, "median" is
  /// the simplest, "spatial" takes longest and helps with long, thin triangles. The pictures' bits do not depend on the
  /// builder.
  std::string builder = "sah";
  /// A BVH file to read the tree from. Without one the tree is built.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// The objects that share the triangles of their meshes. The trees of a BVH file belong to one choice.
  Instancing instances = Instancing::kAuto;
  /// The mode of the first pictures. The constructor compiles the pipeline of this mode. Pipelines of other modes are
  /// compiled at their first use.
  RenderMode mode = {};
  /// True if the cameras of the first pictures have a lens (Camera::aperture_radius), which needs another pipeline.
  bool has_lens = false;
  /// True if the first pictures have an error target. Pictures with and without an error target need different
  /// pipelines. render_within() starts without an error target.
  bool has_error_target = false;
  /// The approximate number of samples of all pixels of all pictures together. If it is small, promin uses kernels that
  /// compile faster and trace slower. The pictures' bits do not depend on it.
  uint64_t expected_samples = std::numeric_limits<uint64_t>::max();
  /// The largest number of bytes of device memory for the scene's images and their mip levels. promin halves the
  /// largest images until all images fit, and adds a warning to SetupStats::warnings. Pictures depend on this limit but
  /// not on the size of the device's memory: if the device has no room for the images, the constructor throws RunError.
  uint64_t texture_bytes = kDefaultTextureBytes;
  /// True if render() returns AovSet::of_surfaces() in RenderResult::aovs. The image does not change.
  bool with_aovs = false;
  /// Further AOVs that render() returns in RenderResult::aovs. With `alpha` the image has no background; otherwise it
  /// does not change.
  AovSet aovs = {};
  /// Receives the progress of building the tree. If it returns false, the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// Renders a scene: whole pictures, progressive pictures and explanations of single pixels. A Renderer holds the scene
/// in device memory and the pipelines for the features that the scene uses. The same scene and view give the same bits
/// on the same device.
///
/// Lifetimes: the Device must outlive the Renderer. The Renderer keeps no reference to the Scene, which may change or
/// be destroyed. After a move the old Renderer may only be destroyed or assigned to. Threads: only one thread at a time
/// may use a Renderer. Several Renderers and Casters may share a Device on several threads. Failures: after an
/// exception the Renderer stays usable, unless the device was lost.
class PROMIN_EXPORT Renderer {
 public:
  /// Builds the tree (a bounding volume hierarchy), uploads the scene and compiles the pipeline. Throws UsageError for
  /// an unknown builder, InputError for an invalid scene (see validate) or a BVH file that is damaged or belongs to
  /// another scene, RunError if memory runs out, a device limit is exceeded or the images do not fit in
  /// RendererOptions::texture_bytes even as single texels, and Cancelled.
  Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options = {});
  ~Renderer();
  /// Moves the contents of another Renderer into a new Renderer.
  Renderer(Renderer&&) noexcept;
  /// Frees the contents of this Renderer and moves the contents of the other one here.
  Renderer& operator=(Renderer&&) noexcept;

  /// Renders one picture. If its mode differs from the last one's, the pipeline is compiled first. Calls `progress`
  /// after each dispatch. Throws UsageError for a view that breaks the rules of promin/view.h, RunError and Cancelled.
  RenderResult render(const View& view, const ProgressCallback& progress = {});

  /// Renders the best whole picture that fits into about `seconds`, including compilation. It starts with one sample
  /// per pixel. If there is time, it refines to an error of 1/8, and then divides the error by the square root of 2
  /// repeatedly, down to the view's own error; PictureError::target is the last target reached. If there is less time,
  /// the picture has a fixed number of samples, RenderResult::samples_per_pixel. render() returns the same bits for
  /// that target or number. The function abandons a picture that takes longer than 1.15 times the limit, or that will
  /// take longer according to the estimate after a tenth of the picture; it then renders a picture with fewer samples.
  /// It never abandons the picture with one sample. It needs 200 bytes of memory per pixel. `seconds` is finite; 0 or
  /// less gives one sample. Throws the same errors as render(), and UsageError for a view without an error target.
  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress = {});

  /// Renders the view as a window does: first as many pixels as `budget_ms` allows, then all of them, then with 4, 16
  /// and 64 samples per pixel up to the view's own number. A view with an error target is refined through the errors of
  /// render_within instead. Passes each complete picture to `on_picture`; the second argument is a view with this
  /// picture's size and its samples or error. Returns early if `on_picture` returns false. Pictures of the view's size
  /// have the bits that render() gives for the passed view. Throws UsageError for a view that breaks the rules of
  /// promin/view.h or has a crop, for a budget that is not a positive finite number of milliseconds and for an empty
  /// `on_picture`, and RunError.
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);

  /// Traces the pixel at these coordinates of the whole picture in the same way as render(), and returns each of its
  /// rays and light contributions. It ignores the view's debug view. Throws UsageError for a view that breaks the rules
  /// of promin/view.h and for a pixel outside the picture, and RunError if the pixel needs more than the device can
  /// record.
  Explanation explain(const View& view, const uvec2& pixel);

  // The following functions change the scene without rebuilding the tree or uploading geometry. The next picture
  // compiles a pipeline only if the set of features that the scene uses has changed.

  /// Replaces all lights. The number of lights may change. Throws InputError if validate() finds problems, and
  /// RunError.
  void set_lights(std::span<const Light> lights);
  /// Replaces all materials by the same number of materials. Some properties stay as in the original scene, because
  /// meshes and images were prepared for them: which materials have normal textures, the placement and wrapping of
  /// textures, the cutoffs of masks, and the glass solids in which a camera may be. Throws InputError for another
  /// number of materials, if validate() finds problems, and if a material of more than 1024 identical primitives stops
  /// being opaque, because the tree contains only one of them. Throws RunError.
  void set_materials(std::span<const Material> materials);
  /// Replaces the environment. Throws InputError if validate() finds problems.
  void set_environment(const Environment& environment);
  /// Shows the scene in another pose: replaces its geometry, transforms, materials, lights and environment by those of
  /// `posed`, which scene_at() (promin/motion.h) returns for the scene of the constructor. Later pictures have the same
  /// bits as those of a new Renderer of `posed`. Nothing is compiled, and images are not uploaded again, unless the
  /// pose shows a feature or an image for the first time. If only instances have moved, only the upper level of the
  /// tree is built again. Otherwise the boxes of the tree are fitted to the new triangles; the tree is built again if
  /// the pose has other primitives, or if the fitted tree would be more than a fifth worse. This choice depends on the
  /// poses alone. Framing belongs to the View, so a pose does not change it. Throws InputError if validate() finds
  /// problems or if the number of objects or of materials differs; then nothing changes. Throws RunError if memory runs
  /// out; then the pose is undefined until the next call.
  void set_pose(const Scene& posed);
  /// Gives objects other transforms. Each pair has an object's index and its transform to the world; if an object
  /// occurs several times, the last pair counts. All other objects stay. Later pictures have the same bits as those of
  /// a new Renderer of the moved scene. The objects must be instances (RendererOptions::instances). Only the upper
  /// level of the tree is built again, so 1,000 instances take a few milliseconds. A pipeline is compiled only if the
  /// upper level becomes much deeper. Throws InputError if an object does not exist or is not an instance, if a
  /// transform is not finite, not affine or singular, if it shears an instance too strongly (docs/instances.md) or
  /// moves it beyond 1e15. Throws RunError if memory runs out. In these cases nothing changes.
  void set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object);

  /// Returns the cost of construction. The reference is valid as long as the Renderer exists.
  const SetupStats& setup_stats() const;
  /// Returns counts of the work since the start of the constructor.
  WorkDone work_done() const;

 private:
  struct Impl;
  friend struct RendererAccess;
  explicit Renderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
