// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/render/picture_tracer.h"

#include "core/parallel.h"
#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "shared/layout.h"
#include "trace/film/explain_pixel.h"
#include "trace/film/progressive_picture.h"
#include "trace/kernels/cut_loops.h"

namespace promin {
namespace {

/// The largest number of pieces that are recorded together; recording so few takes almost no time.
constexpr size_t kMostPiecesAtOnce = 64;

/// The largest number of rays that a lane may count before its 32-bit counters are read.
constexpr double kMaxRaysALane = 2e9;

/// The number of samples of Aovs::ambient_occlusion in a picture with an error target.
constexpr uint32_t kOcclusionSamples = 64;

/// Extracts a window's pixels from those of a larger one.
template <typename Value>
void cut_out(std::vector<Value>& values, const PixelWindow& from, const PixelWindow& window) {
  if (values.size() == area_of(window) || values.empty()) return;
  const uvec2 size = window.hi - window.lo;
  const size_t from_width = from.hi.x - from.lo.x;
  const uvec2 corner = window.lo - from.lo;
  std::vector<Value> kept(area_of(window));
  for (size_t y = 0; y < size.y; ++y) {
    std::copy_n(&values[(corner.y + y) * from_width + corner.x], size.x, &kept[y * size.x]);
  }
  values = std::move(kept);
}

}  // namespace

ProgressCallback keep_going(const ProgressCallback& progress) {
  if (!progress) return {};
  return [&progress](double) { return progress(0.0); };
}

PixelWindow picture_window(const View& view) {
  return view.crop.value_or(PixelWindow{uvec2(0), view.size});
}

PictureTracer::PictureTracer(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options)
    : device_(device),
      options_(options),
      wanted_(options_.with_aovs ? options_.aovs | AovSet::of_surfaces() : options_.aovs),
      pipelines_before_(device_.compiled_pipelines().size()),
      pacer_(options_.target_dispatch_ms.value_or(device_.profile().target_dispatch_ms), TileScheduler::kMinBlocks),
      scene_(device_, scene, options_, stats_) {
  // The callback belongs to the caller of the constructor and must not be called later.
  options_.progress = {};
  // add_motion() reads these AOVs.
  if (wanted_.motion) wanted_.position = wanted_.object = wanted_.primitive = true;
  const Stopwatch compiling;
  if (options_.has_error_target) {
    prepare_refining_film(options_.mode, options_.has_lens);
  } else {
    prepare_film(options_.mode, options_.has_lens);
  }
  stats_.pipeline_ms = compiling.ms();
  stats_.features = feature_names(film_features_);
}

void PictureTracer::prepare_film(const RenderMode& mode, bool has_lens) {
  FeatureMask features = features_of_scene(mode) | features_of_samples(mode);
  // If steps are requested, trace_middle() also provides the AOVs of surfaces.
  if (wanted_.has_any(AovSource::kSurface) && !wanted_.steps) features |= layout::FEATURE_AOVS;
  if (estimates_errors(mode)) features |= layout::FEATURE_SAMPLE_RANGES;
  if (has_lens) features |= layout::FEATURE_LENS;
  prepare_film(features);
}

FeatureMask PictureTracer::features_of_scene(const RenderMode& mode) const {
  const FeatureMask features = scene_.features(mode);
  // A picture with alpha has no background, so it has no backdrop either.
  return wanted_.alpha ? features.without(layout::FEATURE_BACKDROP) : features;
}

bool PictureTracer::tells_unlit(const RenderMode& mode) const {
  return wanted_.unlit && shows_unlit(features_of_scene(mode), mode.debug_view);
}

FeatureMask PictureTracer::features_of_samples(const RenderMode& mode) const {
  FeatureMask features;
  if (has_parts(mode)) features |= layout::FEATURE_LIGHT_AOVS;
  if (wanted_.cryptomatte) features |= layout::FEATURE_SAMPLE_IDS;
  if (tells_unlit(mode)) features |= layout::FEATURE_UNLIT_SHARE;
  return features;
}

void PictureTracer::prepare_refining_film(const RenderMode& mode, bool has_lens) {
  FeatureMask features = features_of_scene(mode) | features_of_samples(mode) | layout::FEATURE_LISTED_SAMPLES;
  if (has_lens) features |= layout::FEATURE_LENS;
  prepare_film(features);
}

void PictureTracer::prepare_film(FeatureMask features) {
  if (film_ && features == film_features_) return;
  film_.emplace(device_, scene_.device_scene(), features, film_options());
  film_->warm_up();
  film_features_ = features;
}

FilmOptions PictureTracer::film_options() const {
  return {.packet_size = options_.packet_size,
          .expected_samples = options_.expected_samples,
          .avoids_texels = options_.avoids_texels,
          .waits_with_holes = options_.waits_with_holes,
          .shaders = options_.shaders};
}

void PictureTracer::take_change() {
  middle_film_.reset();
  occlusion_film_.reset();
  if (!film_) return;
  try {
    film_->bind_scene();
  } catch (...) {
    film_.reset();
    throw;
  }
}

template <typename Change>
void PictureTracer::change_scene(const Change& change) {
  // The shared pointer keeps the address of the scene from being used again.
  const std::shared_ptr<const DeviceScene> before = scene_.device_scene();
  const uint64_t version = before->version();
  const auto drop_films = [&] {
    film_.reset();
    middle_film_.reset();
    occlusion_film_.reset();
  };
  const auto is_other_scene = [&] { return scene_.device_scene() != before; };
  try {
    change();
  } catch (...) {
    if (is_other_scene() || before->version() != version) drop_films();
    throw;
  }
  if (is_other_scene()) return drop_films();
  if (before->version() != version) take_change();
}

void PictureTracer::set_pose(const world::Scene& posed, TreeOfPose tree) {
  // Steps show the tree, so it must be that of a new renderer.
  const bool shows_tree = wanted_.steps || options_.mode.debug_view == DebugView::kSteps;
  change_scene([&] { scene_.set_pose(device_, posed, options_, shows_tree ? TreeOfPose::kBuilt : tree, stats_); });
}

void PictureTracer::set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
  change_scene([&] { scene_.set_transforms(world_from_object); });
}

void PictureTracer::trace_window(Film& onto, const PixelWindow& window, const View& view, const SampleRange& samples,
                                 RenderResult& result, const ProgressCallback& on_progress) {
  TileOptions cut = onto.piece_options(view.max_depth);
  cut.blocks_per_piece = options_.blocks_per_dispatch;
  cut.first_sample = samples.first;
  cut.begins_sums = only_sample_.has_value();
  cut.end_sample = samples.end;
  if (cut.refracted_rays > 0) cut.least_blocks = TileOptions::kLeastBlocksOfTrees;
  const auto collect = [&] {
    const FilmCounts taken = onto.take_counts();
    refuse_cut_loops(taken.has_cut_loops);
    result.rays += taken.rays;
  };
  TileScheduler picture = onto.cut(view, window, cut);
  onto.begin(picture);
  double uncollected = 0.0;
  std::vector<TileSample> pieces;
  while (!picture.is_done()) {
    // The pieces of a small picture are smaller than the requested size, so several run together.
    pieces.clear();
    double units = 0.0;
    do {
      pieces.push_back(picture.next(pacer_.units() - units));
      units += pieces.back().units;
      uncollected += pieces.back().most_rays_a_lane;
    } while (units < pacer_.units() && pieces.size() < kMostPiecesAtOnce && !picture.is_done());
    const double time_ms = onto.run(pieces);
    result.trace_ms += time_ms;
    pacer_.learn(units, time_ms);
    if (uncollected > kMaxRaysALane) {
      collect();
      uncollected = 0.0;
    }
    tell_progress(on_progress, picture.fraction_done());
  }
  collect();
}

void PictureTracer::trace_band(const PixelWindow& band, const View& view, size_t first, RenderResult& result,
                               const ProgressCallback& on_progress) {
  const uvec2 size = band.hi - band.lo;
  const size_t count = static_cast<size_t>(size.x) * size.y;
  const SampleRange all = samples_of(view);
  const uint32_t samples = all.end - all.first;
  const uint32_t samples_at_once = wanted_.cryptomatte ? layout::SAMPLE_IDS : samples;
  film_->reserve(size.x * size.y);
  CoverageTally tally(wanted_.cryptomatte ? count : 0, scene_.object_materials());
  ReadFilm read{{}, 0, film_->records()};
  for (SampleRange range{all.first, all.first}; range.end < all.end;) {
    range = {range.end, std::min(all.end, range.end + samples_at_once)};
    trace_window(*film_, band, view, range, result, [&](double fraction) {
      return !on_progress || on_progress((range.first - all.first + fraction * (range.end - range.first)) / samples);
    });
    read = read_film(*film_, size);
    if (wanted_.cryptomatte) tally_samples(read, range, tally);
  }
  average_samples(film_records_, samples, std::span(result.image.pixels).subspan(first, count));
  const uint32_t middle = view.samples_per_pixel / 2;
  if (film_features_.has_any(layout::FEATURE_AOVS) && all.first <= middle && middle < all.end) {
    read_surfaces(read, scene_.numbers(), view.depth_kind, first, result.aovs);
  }
  for_each_pixel(count, [&](size_t i) {
    if (!result.aovs.samples.empty()) result.aovs.samples[first + i] = samples;
    if (estimates_errors(view.mode)) ranges_[first + i] = read.range(i);
    if (wanted_.cryptomatte) tally.put(i, samples, first + i, result.aovs);
    if (tells_unlit(view.mode)) result.aovs.unlit[first + i] = read.unlit(i) / static_cast<float>(samples);
    if (!has_parts(view.mode)) return;
    LightParts parts;
    parts.add(read, i);
    parts.put(samples, first + i, result.aovs, result.image.pixels[first + i]);
  });
}

void PictureTracer::tally_samples(const ReadFilm& read, const SampleRange& samples, CoverageTally& tally) const {
  for_each_pixel(read.pixel_count, [&](size_t i) {
    // The samples of a pixel usually show the same object.
    uint32_t order = layout::NO_ORDER;
    uint32_t object = Aovs::kNoId;
    for (uint32_t sample = samples.first; sample < samples.end; ++sample) {
      const uint32_t place = sample % layout::SAMPLE_IDS;
      const uint32_t shown = read.record(read.layout.first_ids + place / 4, i)[static_cast<int>(place % 4)];
      if (shown != order) object = object_of(shown);
      order = shown;
      tally.add(i, object);
    }
  });
}

uint32_t PictureTracer::object_of(uint32_t order) const {
  return order == layout::NO_ORDER ? Aovs::kNoId : primitive_of_order(scene_.numbers(), order).object;
}

ReadFilm PictureTracer::read_film(const Film& from, const uvec2& size) {
  const size_t count = static_cast<size_t>(size.x) * size.y;
  film_records_.resize(count * from.records().count);
  from.buffer().read(std::as_writable_bytes(std::span(film_records_)), Film::kPixelsOffset);
  return {film_records_, count, from.records()};
}

RenderMode PictureTracer::mode_of_middle(RenderMode mode) const {
  // These debug views compute no light.
  mode.debug_view = wanted_.steps ? DebugView::kSteps : DebugView::kNormals;
  return mode;
}

void PictureTracer::prepare_middle_film(const RenderMode& mode) {
  if (middle_film_) return;
  FeatureMask features = scene_.features(mode_of_middle(mode)) | layout::FEATURE_AOVS;
  features = features.without(layout::FEATURE_MIRRORS | layout::FEATURE_BLENDING | layout::FEATURE_GLASS);
  FilmOptions film_of_middle = film_options();
  if (wanted_.steps) film_of_middle.packet_size = 1;
  middle_film_.emplace(device_, scene_.device_scene(), features, film_of_middle);
  middle_film_->warm_up();
}

void PictureTracer::trace_middle(const View& view, RenderResult& result, const ProgressCallback& on_progress) {
  prepare_middle_film(view.mode);
  View middle_view = view;
  middle_view.max_depth = 0;
  middle_view.mode = mode_of_middle(view.mode);
  const SampleRange middle{view.samples_per_pixel / 2, view.samples_per_pixel / 2 + 1};
  for_each_band(view, middle_film_->records().count, [&](const PixelWindow& band, size_t first) {
    const uvec2 size = band.hi - band.lo;
    middle_film_->reserve(size.x * size.y);
    // Its rays are counted with the picture's rays.
    RenderResult of_middle;
    trace_window(*middle_film_, band, middle_view, middle, of_middle, on_progress);
    result.trace_ms += of_middle.trace_ms;
    const ReadFilm read = read_film(*middle_film_, size);
    read_surfaces(read, scene_.numbers(), view.depth_kind, first, result.aovs);
    if (wanted_.steps) read_steps(read, first, result.aovs);
  });
}

void PictureTracer::trace_occlusion(const View& view, RenderResult& result, const ProgressCallback& on_progress) {
  View occluded = view;
  occluded.max_depth = 0;
  occluded.mode = {.debug_view = DebugView::kOcclusion};
  if (view.error_target) occluded.samples_per_pixel = kOcclusionSamples;
  occluded.error_target.reset();
  if (!occlusion_film_) {
    FeatureMask features = scene_.features(occluded.mode).without(layout::FEATURE_MIRRORS);
    if (has_lens(view.camera)) features |= layout::FEATURE_LENS;
    occlusion_film_.emplace(device_, scene_.device_scene(), features, film_options());
    occlusion_film_->warm_up();
  }
  std::vector<vec3> shares;
  for_each_band(occluded, occlusion_film_->records().count, [&](const PixelWindow& band, size_t first) {
    const uvec2 size = band.hi - band.lo;
    occlusion_film_->reserve(size.x * size.y);
    RenderResult of_pass;
    trace_window(*occlusion_film_, band, occluded, {0, occluded.samples_per_pixel}, of_pass, on_progress);
    result.trace_ms += of_pass.trace_ms;
    read_film(*occlusion_film_, size);
    shares.resize(size_t{size.x} * size.y);
    average_samples(film_records_, occluded.samples_per_pixel, shares);
    for (size_t i = 0; i < shares.size(); ++i) result.aovs.ambient_occlusion[first + i] = shares[i].x;
  });
}

RenderResult PictureTracer::make_result(const View& view) const {
  const PixelWindow window = picture_window(view);
  RenderResult result;
  result.image.size = window.hi - window.lo;
  result.image.pixels.resize(static_cast<size_t>(result.image.size.x) * result.image.size.y);
  result.aovs.resize(result.image.pixels.size(), wanted_);
  return result;
}

RenderResult PictureTracer::render(const View& view, const ProgressCallback& progress) {
  if (view.error_target) return render_to_error(view, progress);
  if (!estimates_errors(view.mode)) return render_samples(view, progress);
  // Errors are estimated from neighbouring pixels, so a larger window is traced.
  const PixelWindow window = picture_window(view);
  View wider = view;
  wider.crop = with_neighbors(window, view.size);
  ranges_.resize(area_of(*wider.crop));
  RenderResult result = render_samples(wider, progress);
  for_each_pixel(ranges_.size(), [&](size_t i) {
    result.aovs.error[i] = estimate_error(range_around(ranges_, result.image.size, i), view.samples_per_pixel);
  });
  cut_out(result.image.pixels, *wider.crop, window);
  result.image.size = window.hi - window.lo;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) cut_out(result.aovs.FIELD, *wider.crop, window);
#include "promin/kinds/aovs.def"
  cut_out(result.aovs.object_coverage, *wider.crop, window);
  cut_out(result.aovs.material_coverage, *wider.crop, window);
  return result;
}

SampleRange PictureTracer::samples_of(const View& view) const {
  return only_sample_ ? SampleRange{*only_sample_, *only_sample_ + 1} : SampleRange{0, view.samples_per_pixel};
}

RenderResult PictureTracer::render_sample(const View& view, uint32_t sample, const ProgressCallback& progress) {
  only_sample_ = sample;
  try {
    RenderResult result = render_samples(view, progress);
    only_sample_.reset();
    return result;
  } catch (...) {
    only_sample_.reset();
    throw;
  }
}

RenderResult PictureTracer::render_samples(const View& view, const ProgressCallback& progress) {
  RenderResult result = make_result(view);
  result.samples_per_pixel = view.samples_per_pixel;
  prepare_film(view.mode, has_lens(view.camera));
  const double steps_share = wanted_.steps ? 1.0 / (1.0 + view.samples_per_pixel) : 0.0;
  const auto pixel_count = static_cast<double>(result.image.pixels.size());
  const bool has_middle = !only_sample_ || *only_sample_ == view.samples_per_pixel / 2;
  if (wanted_.steps && has_middle) trace_middle(view, result, keep_going(progress));
  if (wanted_.ambient_occlusion && has_middle) trace_occlusion(view, result, keep_going(progress));
  for_each_band(view, film_->records().count, [&](const PixelWindow& band, size_t first) {
    const uvec2 size = band.hi - band.lo;
    trace_band(band, view, first, result, [&](double fraction) {
      const double done = (static_cast<double>(first) + fraction * size.x * size.y) / pixel_count;
      return !progress || progress(steps_share + (1.0 - steps_share) * done);
    });
  });
  return result;
}

void PictureTracer::render_progressively(const View& view, double budget_ms,
                                         const std::function<bool(const Image&, const View&)>& on_picture) {
  FeatureMask features = scene_.features(view.mode);
  if (has_lens(view.camera)) features |= layout::FEATURE_LENS;
  ProgressivePicture picture(device_, scene_.device_scene(), features, budget_ms);
  picture.resize(view.size);
  picture.want(view);
  uint64_t shown_count = 0;
  while (!picture.is_settled()) {
    picture.trace();
    if (picture.shown_count() == shown_count) continue;
    shown_count = picture.shown_count();
    const View shown = picture.shown()->view_of(view);
    if (!on_picture(picture.read(), shown)) return;
    if (view.error_target) continue;
    if (picture.is_complete() && shown.samples_per_pixel >= view.samples_per_pixel) return;
  }
}

WorkDone PictureTracer::work_done() const {
  const DeviceScene::Uploads uploads = scene_.uploads();
  return {.trees_built = scene_.trees_built(),
          .geometry_bytes_uploaded = uploads.geometry,
          .move_bytes_uploaded = uploads.moves,
          .shading_bytes_uploaded = uploads.shading,
          .pipelines_compiled = device_.compiled_pipelines().size() - pipelines_before_};
}

Explanation PictureTracer::explain(const View& view, const uvec2& pixel) const {
  FeatureMask features = scene_.features({.has_shadows = view.mode.has_shadows, .integrator = view.mode.integrator});
  if (has_lens(view.camera)) features |= layout::FEATURE_LENS;
  return explain_pixel(device_, scene_.device_scene(), scene_.numbers(), features, view, pixel);
}

}  // namespace promin
