// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/unset_vector.h"
#include "promin/renderer.h"
#include "trace/film/film.h"
#include "trace/film/film_records.h"
#include "trace/film/refinement.h"
#include "trace/render/renderer_impl.h"

namespace promin {

/// A range of samples of each pixel: [first, end).
struct SampleRange {
  uint32_t first;
  uint32_t end;
};

/// Returns the window of pixels that a view requests.
PixelWindow picture_window(const View& view);

/// Returns a callback that always reports a progress of 0, so it only checks whether to continue. `progress` must
/// outlive it.
ProgressCallback keep_going(const ProgressCallback& progress);

/// The implementation of a Renderer without its checks: a scene on a device, and the films onto which its pictures are
/// traced. picture_tracer.cpp makes pictures with a fixed number of samples, refined_pictures.cpp pictures with an
/// error target.
class PictureTracer {
 public:
  /// Has the arguments and the exceptions of Renderer's constructor.
  PictureTracer(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options);

  SceneOnDevice& scene() { return scene_; }
  const SceneOnDevice& scene() const { return scene_; }
  const SetupStats& stats() const { return stats_; }
  /// Returns counts of the work since the start of the constructor.
  WorkDone work_done() const;

  /// Updates the films after a part of the scene has changed. If the scene cannot be bound to a film, the film is
  /// created again when it is needed.
  void take_change();

  /// Shows the scene in another pose. It has the objects, materials and cameras of the constructor's scene.
  void set_pose(const world::Scene& posed, TreeOfPose tree);
  /// SceneOnDevice::set_transforms().
  void set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object);

  const TunedRendererOptions& options() const { return options_; }

  // The following functions are like those of Renderer, for valid views.
  RenderResult render(const View& view, const ProgressCallback& progress);
  /// Renders one sample of each pixel of a view that has a fixed number of samples. The mean of the results of all
  /// samples is the picture of the view, except for rounding. Cryptomatte has the object of the sample. Only the middle
  /// sample has the AOVs of surfaces and passes of their own. The error is not that of a picture.
  RenderResult render_sample(const View& view, uint32_t sample, const ProgressCallback& progress);
  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress);
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);
  Explanation explain(const View& view, const uvec2& pixel) const;

 private:
  /// Largest number of records on a film; larger pictures are traced in bands of rows. 64 MiB is half of the size that
  /// Vulkan guarantees for a storage buffer.
  static constexpr uint32_t kMaxFilmRecords = ((64U << 20) - 4096) / sizeof(uvec4);

  /// Makes a change of the scene, and updates the films if they must be bound to it again.
  template <typename Change>
  void change_scene(const Change& change);
  /// Creates the film that a mode needs, unless it exists.
  void prepare_film(const RenderMode& mode, bool has_lens);
  /// Returns the features for AOVs of all samples.
  FeatureMask features_of_samples(const RenderMode& mode) const;
  /// Returns whether a picture of a fixed number of samples estimates its error; a debug view does not.
  bool estimates_errors(const RenderMode& mode) const { return wanted_.error && mode.debug_view == DebugView::kNone; }
  /// Returns whether parts of light are computed; a debug view has none.
  bool has_parts(const RenderMode& mode) const {
    return wanted_.has_any(AovSource::kParts) && mode.debug_view == DebugView::kNone;
  }
  /// Returns the feature for Aovs::unlit if the AOV is requested and the scene has unlit surfaces.
  FeatureMask features_of_scene(const RenderMode& mode) const;
  bool tells_unlit(const RenderMode& mode) const;
  /// Creates the film for samples of a list.
  void prepare_refining_film(const RenderMode& mode, bool has_lens);
  void prepare_film(FeatureMask features);
  FilmOptions film_options() const;
  /// Traces samples of a window of the picture. The film must have space for the window.
  void trace_window(Film& onto, const PixelWindow& window, const View& view, const SampleRange& samples,
                    RenderResult& result, const ProgressCallback& on_progress);
  /// Traces a band of the picture and adds it to the result. It traces as many samples per pixel at a time as there is
  /// space for their AOVs. The band's first pixel is the result's pixel `first`.
  void trace_band(const PixelWindow& band, const View& view, size_t first, RenderResult& result,
                  const ProgressCallback& on_progress);
  /// Counts the objects of samples, of which there are at most SAMPLE_IDS.
  void tally_samples(const ReadFilm& read, const SampleRange& samples, CoverageTally& tally) const;
  uint32_t object_of(uint32_t order) const;
  /// Reads the records of a window from a film. Results of earlier calls become invalid.
  ReadFilm read_film(const Film& from, const uvec2& size);
  /// Divides a picture into bands of whole blocks that fit on a film.
  template <typename TraceBand>
  void for_each_band(const View& view, uint32_t records_per_pixel, const TraceBand& trace_band) const {
    const PixelWindow window = picture_window(view);
    const uint32_t width = window.hi.x - window.lo.x;
    const uint32_t film_rows = kMaxFilmRecords / records_per_pixel / width;
    const uint32_t band_rows = std::max(layout::BLOCK_SIZE, film_rows / layout::BLOCK_SIZE * layout::BLOCK_SIZE);
    for (uint32_t y = window.lo.y; y < window.hi.y; y += band_rows) {
      const PixelWindow band{uvec2(window.lo.x, y), uvec2(window.hi.x, std::min(window.hi.y, y + band_rows))};
      trace_band(band, static_cast<size_t>(y - window.lo.y) * width);
    }
  }
  /// Traces the middle sample again without light, for its step counts and surfaces. Step counts need single rays and
  /// not packets, and samples of a list have only light.
  void trace_middle(const View& view, RenderResult& result, const ProgressCallback& on_progress);
  RenderMode mode_of_middle(RenderMode mode) const;
  void prepare_middle_film(const RenderMode& mode);
  /// Traces samples of the occlusion of all pixels, and adds it to the result. A picture with an error target has
  /// kOcclusionSamples of them.
  void trace_occlusion(const View& view, RenderResult& result, const ProgressCallback& on_progress);
  /// Returns a result whose picture has no pixels.
  RenderResult make_result(const View& view) const;
  /// Renders a picture with a fixed number of samples per pixel.
  RenderResult render_samples(const View& view, const ProgressCallback& progress);
  /// Returns the samples that a picture traces.
  SampleRange samples_of(const View& view) const;
  /// AOVs of the samples of a window of a refined picture, indexed by pixel.
  struct RefinedAovs {
    PixelWindow window;
    std::vector<LightParts> parts;
    CoverageTally tally;
  };
  RefinedAovs begin_refined_aovs(const PixelWindow& window, const View& view) const;
  /// Adds the AOVs of the samples of a list.
  void take_aovs(std::span<const ListedSample> list, const ReadFilm& read, RefinedAovs& aovs) const;
  /// Traces samples until the refinement reaches its error. `on_samples` receives the number of samples traced so far.
  void refine(Refinement& refinement, const View& view, RefinedAovs& aovs, RenderResult& result,
              const ProgressCallback& on_samples);
  /// Fills a result with the refinement of a window.
  void take_refined(const Refinement& refinement, const RefinedAovs& aovs, const View& view,
                    RenderResult& result) const;
  /// Returns a result without pixels, but with the AOVs of rays through the pixels' centres.
  RenderResult begin_refined(const View& view, const ProgressCallback& progress);
  /// Returns whether AOVs of rays through the pixels' centres are requested.
  bool tells_of_centers() const;
  /// Compiles the missing pipelines.
  void prepare_to_refine(const View& view);
  RenderResult render_to_error(const View& view, const ProgressCallback& progress);
  /// Refines to the smallest error that is estimated to fit into the time, but at least to the first error.
  RenderResult refine_within(const View& view, double seconds, const ProgressCallback& progress);

  const gpu::Device& device_;
  TunedRendererOptions options_;
  AovSet wanted_;
  size_t pipelines_before_;
  Pacer pacer_;
  SetupStats stats_;
  SceneOnDevice scene_;
  std::optional<Film> film_;
  FeatureMask film_features_;
  /// The film of trace_middle(), created when its AOVs are first requested.
  std::optional<Film> middle_film_;
  /// The film of trace_occlusion().
  std::optional<Film> occlusion_film_;
  UnsetVector<uvec4> film_records_;
  /// The sample to trace; empty for all samples.
  std::optional<uint32_t> only_sample_;
  /// Ranges of the colours of each pixel's samples, for estimating errors.
  std::vector<ColorRange> ranges_;
};

}  // namespace promin
