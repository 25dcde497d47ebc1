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
#include "render/renderer_impl.h"
#include "trace/film.h"
#include "trace/film_records.h"
#include "trace/refinement.h"

namespace promin {

/// Samples of each pixel: [first, end).
struct SampleRange {
  uint32_t first;
  uint32_t end;
};

/// The pixels of a view that are asked for.
PixelWindow picture_window(const View& view);

/// Tells no progress yet, but whether to go on. `progress` lives longer.
ProgressCallback keep_going(const ProgressCallback& progress);

/// What a Renderer is behind its checks: a scene on a device, and the films that its pictures are traced on. Pictures
/// of fixed samples are in picture_tracer.cpp, those with an error target in refined_pictures.cpp.
class PictureTracer {
 public:
  /// As Renderer's constructor.
  PictureTracer(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options);

  SceneOnDevice& scene() { return scene_; }
  const SceneOnDevice& scene() const { return scene_; }
  const SetupStats& stats() const { return stats_; }
  /// What has been done since the constructor began.
  WorkDone work_done() const;

  /// Is called after a part of the scene has changed. A film that cannot be bound to it is made anew when it is needed.
  void take_change();

  // As Renderer has them, of views that are valid.
  RenderResult render(const View& view, const ProgressCallback& progress);
  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress);
  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture);
  Explanation explain(const View& view, const uvec2& pixel) const;

 private:
  /// Most records of a pixel that a film holds; larger pictures are traced in bands of rows. 64 MiB is half of what
  /// Vulkan guarantees for a storage buffer.
  static constexpr uint32_t kMaxFilmRecords = ((64U << 20) - 4096) / sizeof(uvec4);

  /// Makes the film that a mode needs, unless it is there.
  void prepare_film(const RenderMode& mode);
  /// Of what is told of all samples.
  FeatureMask features_of_samples(const RenderMode& mode) const;
  /// Whether a picture of a fixed number of samples tells how far it may be off: a debug view does not.
  bool estimates_errors(const RenderMode& mode) const { return wanted_.error && mode.debug_view == DebugView::kNone; }
  /// Whether parts of light are told: a debug view has none.
  bool has_parts(const RenderMode& mode) const {
    return wanted_.has_any(AovSource::kParts) && mode.debug_view == DebugView::kNone;
  }
  /// Whether Aovs::unlit is wanted and there are unlit surfaces.
  FeatureMask features_of_scene(const RenderMode& mode) const;
  bool tells_unlit(const RenderMode& mode) const;
  /// The film on which samples of a list are traced.
  void prepare_refining_film(const RenderMode& mode);
  void prepare_film(FeatureMask features);
  FilmOptions film_options() const;
  /// Traces samples of a window of the picture, for which the film has room.
  void trace_window(Film& onto, const PixelWindow& window, const View& view, const SampleRange& samples,
                    RenderResult& result, const ProgressCallback& on_progress);
  /// Traces a band of the picture, samples a pixel as far as there is room for what is told of each, and adds it to
  /// the result, whose pixel `first` is the band's first.
  void trace_band(const PixelWindow& band, const View& view, size_t first, RenderResult& result,
                  const ProgressCallback& on_progress);
  void tally_samples(const ReadFilm& read, uint32_t samples, CoverageTally& tally) const;
  uint32_t object_of(uint32_t order) const;
  /// Reads what a film holds of a window; what was read before is gone then.
  ReadFilm read_film(const Film& from, const uvec2& size);
  /// Cuts a picture into bands of whole blocks that a film has room for.
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
  /// Traces the middle sample once more, without light, for its steps and the surfaces that it has met: steps are of
  /// single rays, and packets are not; samples of a list have nothing but light.
  void trace_middle(const View& view, RenderResult& result, const ProgressCallback& on_progress);
  RenderMode mode_of_middle(RenderMode mode) const;
  void prepare_middle_film(const RenderMode& mode);
  /// A picture without pixels yet.
  RenderResult make_result(const View& view) const;
  /// A picture of a fixed number of samples a pixel.
  RenderResult render_samples(const View& view, const ProgressCallback& progress);
  /// What the samples of a window of a refined picture tell beside their colors, by pixel.
  struct RefinedAovs {
    PixelWindow window;
    std::vector<LightParts> parts;
    CoverageTally tally;
  };
  RefinedAovs begin_refined_aovs(const PixelWindow& window, const View& view) const;
  /// Takes those of a list.
  void take_aovs(std::span<const ListedSample> list, const ReadFilm& read, RefinedAovs& aovs) const;
  /// Traces samples until the refinement has what it was asked for. `on_samples` is told how many it has taken.
  void refine(Refinement& refinement, const View& view, RefinedAovs& aovs, RenderResult& result,
              const ProgressCallback& on_samples);
  /// Fills a result with what a refinement of a window has come to.
  void take_refined(const Refinement& refinement, const RefinedAovs& aovs, const View& view,
                    RenderResult& result) const;
  /// A picture without pixels yet, with what rays through the centres of pixels tell.
  RenderResult begin_refined(const View& view, const ProgressCallback& progress);
  /// Whether AOVs are wanted that rays through the pixels' centers tell.
  bool tells_of_centers() const;
  /// Compiles what is not yet.
  void prepare_to_refine(const RenderMode& mode);
  RenderResult render_to_error(const View& view, const ProgressCallback& progress);
  /// The least error that is foretold to fit into the time, the first in any case.
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
  /// Of trace_middle; there as soon as somebody has asked for what it tells.
  std::optional<Film> middle_film_;
  UnsetVector<uvec4> film_records_;
  /// Of the samples of a picture's pixels, where their errors are estimated.
  std::vector<ColorRange> ranges_;
};

}  // namespace promin
