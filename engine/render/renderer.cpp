// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "core/unset_vector.h"
#include "device/device.h"
#include "layout.h"
#include "promin/validate.h"
#include "render/renderer_impl.h"
#include "trace/cut_loops.h"
#include "trace/explain_pixel.h"
#include "trace/film_records.h"
#include "trace/progressive_picture.h"
#include "trace/refinement.h"

namespace promin {
namespace {

/// Most records of a pixel that a film holds; larger pictures are traced in bands of rows. 64 MiB is half of what
/// Vulkan guarantees for a storage buffer.
constexpr uint32_t kMaxFilmRecords = ((64U << 20) - 4096) / sizeof(uvec4);

/// Recording this many pieces takes no time.
constexpr size_t kMostPiecesAtOnce = 64;

/// A lane's counters have 32 bits, so they are read before they can have overflowed.
constexpr double kMaxRaysALane = 2e9;

/// Samples that are traced between two looks at what they bring.
constexpr size_t kMostListed = 1U << 19;
/// The side of the parts of a picture that are refined one after the other.
constexpr uint32_t kTileSide = 256;

/// It takes so much more time for an error than is foretold.
constexpr double kCaution = 1.2;

size_t area_of(const PixelWindow& window) {
  const uvec2 size = window.hi - window.lo;
  return static_cast<size_t>(size.x) * size.y;
}

/// Takes a window's pixels out of those of a larger one.
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

/// Samples of each pixel: [first, end).
struct SampleRange {
  uint32_t first;
  uint32_t end;
};

/// Tells no progress yet, but whether to go on.
ProgressCallback keep_going(const ProgressCallback& progress) {
  if (!progress) return {};
  return [&progress](double) { return progress(0.0); };
}

PixelWindow picture_window(const View& view) {
  return view.crop.value_or(PixelWindow{uvec2(0), view.size});
}

PackedScene pack(const world::Scene& scene, const TunedRendererOptions& options) {
  PackedScene packed = options.bvh
                           ? pack_scene_with(*options.bvh, scene, options.texture_bytes)
                           : pack_scene(scene, options.builder, {.progress = options.progress}, options.texture_bytes);
  return options.repack ? options.repack(std::move(packed)) : std::move(packed);
}

void check(bool is_so, const char* what, const char* where, const char* cure) {
  if (!is_so) throw UsageError({what, where, cure});
}

void check_view(const View& view) {
  if (const std::vector<Problem> problems = validate(view); !problems.empty()) throw UsageError(problems);
}

}  // namespace

SceneOnDevice::SceneOnDevice(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options,
                             SetupStats& stats)
    : force_all_features_(options.force_all_features) {
  for (const world::Object& object : scene.objects) object_materials_.push_back(object.material);
  PackedScene packed = pack(scene, options);
  stats.bvh = packed.bvh;
  stats.bvh_ms = packed.bvh_ms;
  stats.degenerate_triangles = packed.degenerate_count;
  if (packed.surfaces.images.warning) stats.warnings.push_back(*packed.surfaces.images.warning);
  geometry_features_ = packed.features;
  shown_materials_ = packed.shown_materials;
  primitive_count_ = packed.primitive_count();
  material_features_ = promin::material_features(scene.materials, shown_materials_);
  light_features_ = promin::light_features(scene.lights);
  environment_features_ = promin::environment_features(scene.environment);
  const Stopwatch uploading;
  device_scene_ = upload_scene(
      device, packed,
      {scene.materials, scene.textures, scene.lights, scene.environment, std::make_shared<const GlassSolids>(scene)});
  stats.upload_ms = uploading.ms();
  stats.device_bytes = device_scene_->size_bytes();
  numbers_ = std::move(packed.numbers);
}

FeatureMask SceneOnDevice::features_with(FeatureMask lights, const RenderMode& mode) const {
  FeatureMask features = force_all_features_ ? all_features()
                                             : picture_features(geometry_features_, material_features_, lights,
                                                                environment_features_, primitive_count_);
  if (!mode.has_shadows) features = features.without(layout::FEATURE_SHADOWS);
  return features | features_of(mode.debug_view);
}

void SceneOnDevice::set_lights(std::span<const Light> lights) {
  device_scene_->set_lights(lights);
  light_features_ = promin::light_features(lights);
}

void SceneOnDevice::set_materials(std::span<const Material> materials) {
  device_scene_->set_materials(materials);
  material_features_ = promin::material_features(materials, shown_materials_);
}

void SceneOnDevice::set_environment(const Environment& environment) {
  device_scene_->set_environment(environment);
  environment_features_ = promin::environment_features(environment);
}

// Hidden, although the class around it is not (promin/export.h).
struct __attribute__((visibility("hidden"))) Renderer::Impl {
  Impl(const gpu::Device& the_device, const world::Scene& the_scene, const TunedRendererOptions& the_options)
      : device(the_device),
        options(the_options),
        wanted(options.with_aovs ? options.aovs | AovSet::of_surfaces() : options.aovs),
        pipelines_before(device.compiled_pipelines().size()),
        pacer(options.target_dispatch_ms.value_or(device.profile().target_dispatch_ms), TileScheduler::kMinBlocks),
        scene(device, the_scene, options, stats) {
    // The callback belonged to the constructor's caller.
    options.progress = {};
    const Stopwatch compiling;
    if (options.has_error_target) {
      prepare_refining_film(options.mode);
    } else {
      prepare_film(options.mode);
    }
    stats.pipeline_ms = compiling.ms();
    stats.features = feature_names(film_features);
  }

  /// Makes the film that a mode needs, unless it is there.
  void prepare_film(const RenderMode& mode) {
    FeatureMask features = scene.features(mode) | features_of_samples(mode);
    if (wanted.has_any(AovSource::kSurface)) features |= layout::FEATURE_AOVS;
    if (estimates_errors(mode)) features |= layout::FEATURE_SAMPLE_RANGES;
    prepare_film(features);
  }

  /// Of what is told of all samples.
  FeatureMask features_of_samples(const RenderMode& mode) const {
    FeatureMask features;
    if (has_parts(mode)) features |= layout::FEATURE_LIGHT_AOVS;
    if (wanted.cryptomatte) features |= layout::FEATURE_SAMPLE_IDS;
    return features;
  }

  /// Whether a picture of a fixed number of samples tells how far it may be off: a debug view does not.
  bool estimates_errors(const RenderMode& mode) const { return wanted.error && mode.debug_view == DebugView::kNone; }

  /// Whether parts of light are told: a debug view has none.
  bool has_parts(const RenderMode& mode) const {
    return wanted.has_any(AovSource::kParts) && mode.debug_view == DebugView::kNone;
  }

  /// The film on which samples of a list are traced.
  void prepare_refining_film(const RenderMode& mode) {
    prepare_film(scene.features(mode) | features_of_samples(mode) | layout::FEATURE_LISTED_SAMPLES);
  }

  void prepare_film(FeatureMask features) {
    if (film && features == film_features) return;
    film.emplace(device, scene.device_scene(), features, film_options());
    film->warm_up();
    film_features = features;
  }

  FilmOptions film_options() const {
    return {.packet_size = options.packet_size,
            .expected_samples = options.expected_samples,
            .avoids_texels = options.avoids_texels,
            .shaders = options.shaders};
  }

  /// Is called after a part of the scene has changed. A film that cannot be bound to it is made anew when it is needed.
  void take_change() {
    step_film.reset();
    if (!film) return;
    try {
      film->bind_scene();
    } catch (...) {
      film.reset();
      throw;
    }
  }

  /// Traces samples of a window of the picture, for which the film has room.
  void trace_window(Film& onto, const PixelWindow& window, const View& view, const SampleRange& samples,
                    RenderResult& result, const ProgressCallback& on_progress) {
    TileOptions cut = onto.piece_options(view.max_depth);
    cut.blocks_per_piece = options.blocks_per_dispatch;
    cut.first_sample = samples.first;
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
      // The pieces of a small picture are smaller than what is asked for, so several run at once.
      pieces.clear();
      double units = 0.0;
      do {
        pieces.push_back(picture.next(pacer.units() - units));
        units += pieces.back().units;
        uncollected += pieces.back().most_rays_a_lane;
      } while (units < pacer.units() && pieces.size() < kMostPiecesAtOnce && !picture.is_done());
      const double time_ms = onto.run(pieces);
      result.trace_ms += time_ms;
      pacer.learn(units, time_ms);
      if (uncollected > kMaxRaysALane) {
        collect();
        uncollected = 0.0;
      }
      tell_progress(on_progress, picture.fraction_done());
    }
    collect();
  }

  /// Traces a band of the picture, samples a pixel as far as there is room for what is told of each, and adds it to
  /// the result, whose pixel `first` is the band's first.
  void trace_band(const PixelWindow& band, const View& view, size_t first, RenderResult& result,
                  const ProgressCallback& on_progress) {
    const uvec2 size = band.hi - band.lo;
    const size_t count = static_cast<size_t>(size.x) * size.y;
    const uint32_t samples = view.samples_per_pixel;
    const uint32_t samples_at_once = wanted.cryptomatte ? layout::SAMPLE_IDS : samples;
    film->reserve(size.x * size.y);
    CoverageTally tally(wanted.cryptomatte ? count : 0, scene.object_materials());
    ReadFilm read{{}, 0, film->records()};
    for (SampleRange range{0, 0}; range.end < samples;) {
      range = {range.end, std::min(samples, range.end + samples_at_once)};
      trace_window(*film, band, view, range, result, [&](double fraction) {
        return !on_progress || on_progress((range.first + fraction * (range.end - range.first)) / samples);
      });
      // What is told of all samples together is read once.
      if (!wanted.cryptomatte && range.end < samples) continue;
      read = read_film(*film, size);
      if (wanted.cryptomatte) tally_samples(read, range.end - range.first, tally);
    }
    average_samples(film_records, samples, std::span(result.image.pixels).subspan(first, count));
    if (wanted.has_any(AovSource::kSurface)) {
      read_surfaces(read, scene.numbers(), view.depth_kind, first, result.aovs);
    }
    for_each_pixel(count, [&](size_t i) {
      if (!result.aovs.samples.empty()) result.aovs.samples[first + i] = samples;
      if (estimates_errors(view.mode)) ranges[first + i] = read.range(i);
      if (wanted.cryptomatte) tally.put(i, samples, first + i, result.aovs);
      if (!has_parts(view.mode)) return;
      LightParts parts;
      parts.add(read, i);
      parts.put(samples, first + i, result.aovs, result.image.pixels[first + i]);
    });
  }

  void tally_samples(const ReadFilm& read, uint32_t samples, CoverageTally& tally) const {
    for_each_pixel(read.pixel_count, [&](size_t i) {
      // Samples of a pixel mostly show the same.
      uint32_t order = layout::NO_ORDER;
      uint32_t object = Aovs::kNoId;
      for (uint32_t sample = 0; sample < samples; ++sample) {
        const uint32_t shown = read.record(read.layout.first_ids + sample / 4, i)[static_cast<int>(sample % 4)];
        if (shown != order) object = object_of(shown);
        order = shown;
        tally.add(i, object);
      }
    });
  }

  uint32_t object_of(uint32_t order) const {
    return order == layout::NO_ORDER ? Aovs::kNoId : primitive_of_order(scene.numbers(), order).object;
  }

  /// Traces a sample of each pixel of a band for what it has met alone.
  void trace_surfaces(const PixelWindow& band, const View& view, size_t first, RenderResult& result,
                      const ProgressCallback& on_progress) {
    const uvec2 size = band.hi - band.lo;
    film->reserve(size.x * size.y);
    trace_window(*film, band, view, {0, 1}, result, on_progress);
    read_surfaces(read_film(*film, size), scene.numbers(), view.depth_kind, first, result.aovs);
  }

  /// Reads what a film holds of a window; what was read before is gone then.
  ReadFilm read_film(const Film& from, const uvec2& size) {
    const size_t count = static_cast<size_t>(size.x) * size.y;
    film_records.resize(count * from.records().count);
    from.buffer().read(std::as_writable_bytes(std::span(film_records)), Film::kPixelsOffset);
    return {film_records, count, from.records()};
  }

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

  /// Traces the middle sample once more, as steps are of single rays, and packets are not.
  void trace_steps(const View& view, RenderResult& result, const ProgressCallback& on_progress) {
    View step_view = view;
    step_view.max_depth = 0;
    step_view.mode.debug_view = DebugView::kSteps;
    FeatureMask features = scene.features(step_view.mode) | layout::FEATURE_AOVS;
    features = features.without(layout::FEATURE_MIRRORS | layout::FEATURE_BLENDING | layout::FEATURE_GLASS);
    if (!step_film) {
      FilmOptions film_of_steps = film_options();
      film_of_steps.packet_size = 1;
      step_film.emplace(device, scene.device_scene(), features, film_of_steps);
      step_film->warm_up();
    }
    const SampleRange middle{view.samples_per_pixel / 2, view.samples_per_pixel / 2 + 1};
    for_each_band(view, step_film->records().count, [&](const PixelWindow& band, size_t first) {
      const uvec2 size = band.hi - band.lo;
      step_film->reserve(size.x * size.y);
      // Its rays are the picture's, counted there.
      RenderResult of_steps;
      trace_window(*step_film, band, step_view, middle, of_steps, on_progress);
      result.trace_ms += of_steps.trace_ms;
      read_steps(read_film(*step_film, size), first, result.aovs);
    });
  }

  /// A picture without pixels yet.
  RenderResult make_result(const View& view) const {
    const PixelWindow window = picture_window(view);
    RenderResult result;
    result.image.size = window.hi - window.lo;
    result.image.pixels.resize(static_cast<size_t>(result.image.size.x) * result.image.size.y);
    result.aovs.resize(result.image.pixels.size(), wanted);
    return result;
  }

  RenderResult render(const View& view, const ProgressCallback& progress) {
    if (view.error_target) return render_to_error(view, progress);
    if (!estimates_errors(view.mode)) return render_samples(view, progress);
    // Pixels tell of the errors of those around them.
    const PixelWindow window = picture_window(view);
    View wider = view;
    wider.crop = with_neighbors(window, view.size);
    ranges.resize(area_of(*wider.crop));
    RenderResult result = render_samples(wider, progress);
    for_each_pixel(ranges.size(), [&](size_t i) {
      result.aovs.error[i] = estimate_error(range_around(ranges, result.image.size, i), view.samples_per_pixel);
    });
    cut_out(result.image.pixels, *wider.crop, window);
    result.image.size = window.hi - window.lo;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) cut_out(result.aovs.FIELD, *wider.crop, window);
#include "promin/kinds/aovs.def"
    cut_out(result.aovs.object_coverage, *wider.crop, window);
    cut_out(result.aovs.material_coverage, *wider.crop, window);
    return result;
  }

  /// A picture of a fixed number of samples a pixel.
  RenderResult render_samples(const View& view, const ProgressCallback& progress) {
    RenderResult result = make_result(view);
    prepare_film(view.mode);
    const double steps_share = wanted.steps ? 1.0 / (1.0 + view.samples_per_pixel) : 0.0;
    const auto pixel_count = static_cast<double>(result.image.pixels.size());
    if (wanted.steps) trace_steps(view, result, keep_going(progress));
    for_each_band(view, film->records().count, [&](const PixelWindow& band, size_t first) {
      const uvec2 size = band.hi - band.lo;
      trace_band(band, view, first, result, [&](double fraction) {
        const double done = (static_cast<double>(first) + fraction * size.x * size.y) / pixel_count;
        return !progress || progress(steps_share + (1.0 - steps_share) * done);
      });
    });
    return result;
  }

  /// What the samples of a window of a refined picture tell beside their colors, by pixel.
  struct RefinedAovs {
    PixelWindow window;
    std::vector<LightParts> parts;
    CoverageTally tally;
  };

  RefinedAovs begin_refined_aovs(const PixelWindow& window, const View& view) const {
    const uvec2 size = window.hi - window.lo;
    const size_t count = static_cast<size_t>(size.x) * size.y;
    return {window, std::vector<LightParts>(has_parts(view.mode) ? count : 0),
            CoverageTally(wanted.cryptomatte ? count : 0, scene.object_materials())};
  }

  /// Takes those of a list.
  void take_aovs(std::span<const ListedSample> list, const ReadFilm& read, RefinedAovs& aovs) const {
    if (aovs.parts.empty() && !wanted.cryptomatte) return;
    const uint32_t width = aovs.window.hi.x - aovs.window.lo.x;
    for (size_t i = 0; i < list.size(); ++i) {
      const uvec2& pixel = list[i].pixel;
      // The samples of pixels around the window are theirs.
      if (glm::any(glm::lessThan(pixel, aovs.window.lo)) || glm::any(glm::greaterThanEqual(pixel, aovs.window.hi))) {
        continue;
      }
      const uvec2 place = pixel - aovs.window.lo;
      const size_t at = static_cast<size_t>(place.y) * width + place.x;
      if (!aovs.parts.empty()) aovs.parts[at].add(read, i);
      if (wanted.cryptomatte) aovs.tally.add(at, object_of(read.record(0, i).w));
    }
  }

  /// Traces samples until the refinement has what it was asked for. `on_samples` is told how many it has taken.
  void refine(Refinement& refinement, const View& view, RefinedAovs& aovs, RenderResult& result,
              const ProgressCallback& on_samples) {
    const size_t most_listed = std::min<size_t>(kMostListed, kMaxFilmRecords / film->records().count);
    std::vector<vec3> radiance;
    for (auto list = refinement.next(most_listed); !list.empty(); list = refinement.next(most_listed)) {
      film->put_list(list);
      const auto taken = static_cast<double>(refinement.sample_count());
      trace_window(*film, list_window(list.size()), view, {0, 1}, result, [&](double fraction) {
        return !on_samples || on_samples(taken + fraction * static_cast<double>(list.size()));
      });
      const ReadFilm read = film->read_list();
      radiance.resize(list.size());
      average_samples(read.records, 1, radiance);
      take_aovs(list, read, aovs);
      refinement.take(radiance);
    }
  }

  /// Fills a result with what a refinement of a window has come to.
  void take_refined(const Refinement& refinement, const RefinedAovs& aovs, const View& view,
                    RenderResult& result) const {
    const PixelWindow& window = aovs.window;
    const PixelWindow whole = picture_window(view);
    const uvec2 size = window.hi - window.lo;
    refinement.add_to(*result.error);
    for (size_t i = 0; i < refinement.pixel_count(); ++i) {
      const uvec2 place = window.lo - whole.lo + uvec2(i % size.x, i / size.x);
      const size_t at = static_cast<size_t>(place.y) * result.image.size.x + place.x;
      const PixelEstimate& estimate = refinement.estimate(i);
      result.image.pixels[at] = estimate.mean();
      if (!result.aovs.samples.empty()) result.aovs.samples[at] = estimate.count();
      if (!result.aovs.error.empty()) result.aovs.error[at] = refinement.claim(i);
      if (!aovs.parts.empty()) aovs.parts[i].put(estimate.count(), at, result.aovs, result.image.pixels[at]);
      if (wanted.cryptomatte) aovs.tally.put(i, estimate.count(), at, result.aovs);
    }
  }

  /// A picture without pixels yet, with what rays through the centres of pixels tell.
  RenderResult begin_refined(const View& view, const ProgressCallback& progress) {
    RenderResult result = make_result(view);
    View centers = view;
    centers.error_target.reset();
    centers.samples_per_pixel = 1;
    centers.max_depth = 0;
    const ProgressCallback goes_on = keep_going(progress);
    if (wanted.has_any(AovSource::kSurface)) {
      prepare_film(scene.features(view.mode) | layout::FEATURE_AOVS);
      for_each_band(centers, film->records().count, [&](const PixelWindow& band, size_t first) {
        trace_surfaces(band, centers, first, result, goes_on);
      });
    }
    if (wanted.steps) trace_steps(centers, result, goes_on);
    result.error.emplace(PictureError{.target = view.error_target->error});
    prepare_refining_film(view.mode);
    return result;
  }

  RenderResult render_to_error(const View& view, const ProgressCallback& progress) {
    RenderResult result = begin_refined(view, progress);
    const PixelWindow window = picture_window(view);
    const uvec2 tiles = (result.image.size + kTileSide - 1U) / kTileSide;
    // All tiles take what those before have taken, as far as is known.
    double taken = 0.0;
    double pixels_done = 0.0;
    const auto pixels = static_cast<double>(result.image.pixels.size());
    for (uint32_t tile = 0; tile < tiles.x * tiles.y; ++tile) {
      const uvec2 lo = window.lo + kTileSide * uvec2(tile % tiles.x, tile / tiles.x);
      const PixelWindow part{lo, glm::min(window.hi, lo + kTileSide)};
      Refinement refinement(view, part);
      RefinedAovs aovs = begin_refined_aovs(part, view);
      const auto part_pixels = static_cast<double>(refinement.pixel_count());
      refine(refinement, view, aovs, result, [&](double of_part) {
        if (!progress) return true;
        const double left_of_part = std::max(refinement.foretell_total() - of_part, 0.0);
        const double a_pixel = (taken + of_part + left_of_part) / (pixels_done + part_pixels);
        const double left = left_of_part + a_pixel * (pixels - pixels_done - part_pixels);
        return progress((taken + of_part) / (taken + of_part + left));
      });
      taken += static_cast<double>(refinement.sample_count());
      pixels_done += part_pixels;
      take_refined(refinement, aovs, view, result);
    }
    return result;
  }

  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress) {
    const Stopwatch elapsed;
    View step = view;
    step.error_target->error = first_error(*view.error_target);
    RenderResult result = begin_refined(step, progress);
    const PixelWindow window = picture_window(view);
    Refinement refinement(step, window);
    RefinedAovs aovs = begin_refined_aovs(window, step);
    const auto on_progress = [&](double) {
      return !progress || progress(std::min(1.0, 1e-3 * elapsed.ms() / seconds));
    };
    const Stopwatch tracing;
    float& error = step.error_target->error;
    for (refine(refinement, step, aovs, result, on_progress); error > view.error_target->error;) {
      const float less = next_error(*view.error_target, error);
      const double ms_a_sample = tracing.ms() / static_cast<double>(refinement.sample_count());
      const double ms_ahead = kCaution * ms_a_sample * refinement.foretell_samples(less);
      if (elapsed.ms() + ms_ahead > 1e3 * seconds) break;
      error = less;
      refinement.aim(error);
      refine(refinement, step, aovs, result, on_progress);
    }
    result.error->target = error;
    take_refined(refinement, aovs, step, result);
    return result;
  }

  void render_progressively(const View& view, double budget_ms,
                            const std::function<bool(const Image&, const View&)>& on_picture) {
    ProgressivePicture picture(device, scene.device_scene(), scene.features(view.mode), budget_ms);
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

  const gpu::Device& device;
  TunedRendererOptions options;
  AovSet wanted;
  size_t pipelines_before;
  Pacer pacer;
  SetupStats stats;
  SceneOnDevice scene;
  std::optional<Film> film;
  FeatureMask film_features;
  /// Counts steps; there as soon as somebody has asked for them.
  std::optional<Film> step_film;
  UnsetVector<uvec4> film_records;
  /// Of the samples of a picture's pixels, where their errors are estimated.
  std::vector<ColorRange> ranges;
};

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options) {
  throw_if_invalid(scene);
  *this = RendererAccess::make(device, world::flatten(scene), TunedRendererOptions{options});
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Renderer RendererAccess::make(const gpu::Device& device, const world::Scene& scene,
                              const TunedRendererOptions& options) {
  std::unique_ptr<Renderer::Impl> impl;
  gpu::translate_vulkan_errors([&] { impl = std::make_unique<Renderer::Impl>(device, scene, options); });
  return Renderer(std::move(impl));
}

SceneOnDevice& RendererAccess::scene_of(Renderer& renderer) {
  return renderer.impl_->scene;
}
const SceneOnDevice& RendererAccess::scene_of(const Renderer& renderer) {
  return renderer.impl_->scene;
}

const SetupStats& Renderer::setup_stats() const {
  return impl_->stats;
}

WorkDone Renderer::work_done() const {
  const DeviceScene::Uploads& uploads = impl_->scene.device_scene()->uploads();
  return {.trees_built = impl_->options.bvh ? 0U : 1U,
          .geometry_bytes_uploaded = uploads.geometry,
          .shading_bytes_uploaded = uploads.shading,
          .pipelines_compiled = impl_->device.compiled_pipelines().size() - impl_->pipelines_before};
}

void Renderer::set_lights(std::span<const Light> lights) {
  throw_if_invalid(lights);
  gpu::translate_vulkan_errors([&] {
    impl_->scene.set_lights(lights);
    impl_->take_change();
  });
}

void Renderer::set_materials(std::span<const Material> materials) {
  throw_if_invalid(materials);
  if (materials.size() != impl_->scene.material_count()) {
    throw InputError({"there are " + std::to_string(materials.size()) + " materials for a scene of " +
                          std::to_string(impl_->scene.material_count()),
                      "in set_materials", "change the scene's own, in their order"});
  }
  gpu::translate_vulkan_errors([&] {
    impl_->scene.set_materials(materials);
    impl_->take_change();
  });
}

void Renderer::set_environment(const Environment& environment) {
  throw_if_invalid(environment);
  gpu::translate_vulkan_errors([&] {
    impl_->scene.set_environment(environment);
    impl_->take_change();
  });
}

Explanation Renderer::explain(const View& view, const uvec2& pixel) {
  check_view(view);
  check(pixel.x < view.size.x && pixel.y < view.size.y, "the pixel to explain lies beyond the picture", "pixel",
        "stay within its size");
  Explanation explanation;
  gpu::translate_vulkan_errors([&] {
    const SceneOnDevice& scene = impl_->scene;
    const FeatureMask features = scene.features({.has_shadows = view.mode.has_shadows});
    explanation = explain_pixel(impl_->device, scene.device_scene(), scene.numbers(), features, view, pixel);
  });
  return explanation;
}

RenderResult Renderer::render_within(const View& view, double seconds, const ProgressCallback& progress) {
  check_view(view);
  check(view.error_target.has_value(), "there is no error to refine to", "view.error_target", "set one");
  check(seconds > 0.0 && std::isfinite(seconds), "the time is not positive and finite", "seconds",
        "give a picture some seconds");
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = impl_->render_within(view, seconds, progress); });
  return result;
}

RenderResult Renderer::render(const View& view, const ProgressCallback& progress) {
  check_view(view);
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = impl_->render(view, progress); });
  return result;
}

void Renderer::render_progressively(const View& view, double budget_ms,
                                    const std::function<bool(const Image&, const View&)>& on_picture) {
  check_view(view);
  check(!view.crop, "render_progressively takes no crop", "view.crop", "show the whole picture, or render the crop");
  check(budget_ms > 0.0 && std::isfinite(budget_ms), "the budget is not positive and finite", "budget_ms",
        "give a picture some milliseconds");
  check(static_cast<bool>(on_picture), "there is nobody to take the pictures", "on_picture", "give a function");
  gpu::translate_vulkan_errors([&] { impl_->render_progressively(view, budget_ms, on_picture); });
}

}  // namespace promin
