// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "layout.h"
#include "promin/validate.h"
#include "render/renderer_impl.h"
#include "trace/cut_loops.h"
#include "trace/explain_pixel.h"
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

/// The errors that render_within asks for, one after the other.
constexpr float kFirstErrorWithin = 0.125F;
constexpr float kErrorStep = 1.41421356F;
/// It takes so much more time for an error than is foretold.
constexpr double kCaution = 1.2;

PixelWindow picture_window(const View& view) {
  return view.crop.value_or(PixelWindow{uvec2(0), view.size});
}

vec3 vec3_of(const uvec4& bits) {
  return {std::bit_cast<float>(bits.x), std::bit_cast<float>(bits.y), std::bit_cast<float>(bits.z)};
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
    FeatureMask features = scene.features(mode);
    if (options.with_aovs) features |= layout::FEATURE_AOVS;
    prepare_film(features);
  }

  /// The film on which samples of a list are traced.
  void prepare_refining_film(const RenderMode& mode) {
    prepare_film(scene.features(mode) | layout::FEATURE_LISTED_SAMPLES);
  }

  void prepare_film(FeatureMask features) {
    if (film && features == film_features) return;
    film.emplace(device, scene.device_scene(), features,
                 FilmOptions{.packet_size = options.packet_size,
                             .expected_samples = options.expected_samples,
                             .avoids_texels = options.avoids_texels,
                             .shaders = options.shaders});
    film->warm_up();
    film_features = features;
  }

  /// Is called after a part of the scene has changed. A film that cannot be bound to it is made anew when it is needed.
  void take_change() {
    if (!film) return;
    try {
      film->bind_scene();
    } catch (...) {
      film.reset();
      throw;
    }
  }

  /// Traces `window` of the picture, for which the film has room.
  void trace_window(const PixelWindow& window, const View& view, RenderResult& result,
                    const ProgressCallback& on_progress) {
    TileOptions cut = film->piece_options(view.max_depth);
    cut.blocks_per_piece = options.blocks_per_dispatch;
    if (cut.refracted_rays > 0) cut.least_blocks = TileOptions::kLeastBlocksOfTrees;
    const auto collect = [&] {
      const FilmCounts taken = film->take_counts();
      refuse_cut_loops(taken.has_cut_loops);
      result.rays += taken.rays;
    };
    TileScheduler picture = film->cut(view, window, cut);
    film->begin(picture);
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
      const double time_ms = film->run(pieces);
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

  /// Adds what the film holds of a band to the result. The band's first pixel is pixel `first` of the result.
  void read_film(size_t first, size_t count, uint32_t samples, RenderResult& result) {
    film_records.resize(count * film->records_per_pixel());
    film->buffer().read(std::as_writable_bytes(std::span(film_records)), Film::kPixelsOffset);
    average_samples(film_records, samples, std::span(result.image.pixels).subspan(first, count));
    if (!options.with_aovs) return;
    for (size_t i = 0; i < count; ++i) {
      read_aovs(film_records[i], film_records[count + i], film_records[2 * count + i], samples, first + i, result.aovs);
    }
  }

  /// Reads a pixel's AOVs from its three records (shaders/film.glsl).
  void read_aovs(const uvec4& pixel, const uvec4& normal_and_depth, const uvec4& albedo_and_material, uint32_t samples,
                 size_t at, Aovs& aovs) const {
    PrimitiveId id{Aovs::kNoId, Aovs::kNoId};
    if (pixel.w != layout::NO_ORDER) id = primitive_of_order(scene.numbers(), pixel.w);
    // Members have the names of the table, so an AOV that nothing is read into does not compile.
    const struct {
      float depth;
      vec3 normal;
      uint32_t object;
      uint32_t primitive;
      uint32_t material;
      vec3 albedo;
      uint32_t samples;
      vec3 error;
    } told{std::bit_cast<float>(normal_and_depth.w),
           vec3_of(normal_and_depth),
           id.object,
           id.primitive,
           albedo_and_material.w,
           vec3_of(albedo_and_material),
           samples,
           vec3(0.0F)};
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS) aovs.FIELD[at] = told.FIELD;
#include "promin/kinds/aovs.def"
  }

  RenderResult render(const View& view, const ProgressCallback& progress) {
    if (view.error_target) return render_to_error(view, progress);
    const PixelWindow window = picture_window(view);
    RenderResult result;
    result.image.size = window.hi - window.lo;
    const uint32_t width = result.image.size.x;
    const size_t pixel_count = static_cast<size_t>(width) * result.image.size.y;
    result.image.pixels.resize(pixel_count);
    if (options.with_aovs) result.aovs.resize(pixel_count);
    prepare_film(view.mode);
    const uint32_t film_rows = kMaxFilmRecords / film->records_per_pixel() / width;
    const uint32_t band_rows = std::max(layout::BLOCK_SIZE, film_rows / layout::BLOCK_SIZE * layout::BLOCK_SIZE);
    for (uint32_t y = window.lo.y; y < window.hi.y; y += band_rows) {
      const PixelWindow band{uvec2(window.lo.x, y), uvec2(window.hi.x, std::min(window.hi.y, y + band_rows))};
      const uint32_t rows = band.hi.y - band.lo.y;
      const double done = static_cast<double>(y - window.lo.y) / result.image.size.y;
      const double fraction_of_band = static_cast<double>(rows) / result.image.size.y;
      film->reserve(width * rows);
      trace_window(band, view, result,
                   [&](double fraction) { return !progress || progress(done + fraction_of_band * fraction); });
      read_film(static_cast<size_t>(y - window.lo.y) * width, static_cast<size_t>(rows) * width, view.samples_per_pixel,
                result);
    }
    return result;
  }

  /// Traces samples until the refinement has what it was asked for. `on_samples` is told how many it has taken.
  void refine(Refinement& refinement, const View& view, RenderResult& result, const ProgressCallback& on_samples) {
    std::vector<vec3> radiance;
    for (auto list = refinement.next(kMostListed); !list.empty(); list = refinement.next(kMostListed)) {
      film->put_list(list);
      const auto taken = static_cast<double>(refinement.sample_count());
      trace_window(list_window(list.size()), view, result, [&](double fraction) {
        return !on_samples || on_samples(taken + fraction * static_cast<double>(list.size()));
      });
      radiance.resize(list.size());
      film->read_list(radiance);
      refinement.take(radiance);
    }
  }

  /// Fills a result with what a refinement of `window` has come to.
  void take_refined(const Refinement& refinement, const PixelWindow& window, const View& view,
                    RenderResult& result) const {
    const PixelWindow whole = picture_window(view);
    const uvec2 size = window.hi - window.lo;
    for (size_t i = 0; i < refinement.pixel_count(); ++i) {
      const uvec2 place = window.lo - whole.lo + uvec2(i % size.x, i / size.x);
      const size_t at = static_cast<size_t>(place.y) * result.image.size.x + place.x;
      const PixelEstimate& estimate = refinement.estimate(i);
      const vec3 mean = estimate.mean();
      result.image.pixels[at] = mean;
      const vec3& claim = refinement.claim(i);
      result.error->largest_claim = std::max(result.error->largest_claim, refinement.relative_claim(i));
      result.error->unmet_pixels += refinement.is_near_enough(i) ? 0 : 1;
      result.error->samples += estimate.count();
      if (!options.with_aovs) continue;
      result.aovs.samples[at] = estimate.count();
      result.aovs.error[at] = claim;
    }
  }

  /// A picture without pixels yet, with its AOVs: of rays through the pixels' centres.
  RenderResult begin_refined(const View& view, const ProgressCallback& progress) {
    RenderResult result;
    if (options.with_aovs) {
      View centers = view;
      centers.error_target.reset();
      centers.samples_per_pixel = 1;
      centers.max_depth = 0;
      result = render(centers, progress);
    }
    const PixelWindow window = picture_window(view);
    result.image.size = window.hi - window.lo;
    result.image.pixels.resize(static_cast<size_t>(result.image.size.x) * result.image.size.y);
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
      const auto part_pixels = static_cast<double>(refinement.pixel_count());
      refine(refinement, view, result, [&](double of_part) {
        if (!progress) return true;
        const double left_of_part = std::max(refinement.foretell_total() - of_part, 0.0);
        const double a_pixel = (taken + of_part + left_of_part) / (pixels_done + part_pixels);
        const double left = left_of_part + a_pixel * (pixels - pixels_done - part_pixels);
        return progress((taken + of_part) / (taken + of_part + left));
      });
      taken += static_cast<double>(refinement.sample_count());
      pixels_done += part_pixels;
      take_refined(refinement, part, view, result);
    }
    return result;
  }

  RenderResult render_within(const View& view, double seconds, const ProgressCallback& progress) {
    const Stopwatch elapsed;
    View step = view;
    step.error_target->error = std::max(view.error_target->error, kFirstErrorWithin);
    RenderResult result = begin_refined(step, progress);
    const PixelWindow window = picture_window(view);
    Refinement refinement(step, window);
    const auto on_progress = [&](double) {
      return !progress || progress(std::min(1.0, 1e-3 * elapsed.ms() / seconds));
    };
    const Stopwatch tracing;
    float& error = step.error_target->error;
    for (refine(refinement, step, result, on_progress); error > view.error_target->error;) {
      const float next_error = std::max(view.error_target->error, error / kErrorStep);
      const double ms_a_sample = tracing.ms() / static_cast<double>(refinement.sample_count());
      const double ms_ahead = kCaution * ms_a_sample * refinement.foretell_samples(next_error);
      if (elapsed.ms() + ms_ahead > 1e3 * seconds) break;
      error = next_error;
      refinement.aim(error);
      refine(refinement, step, result, on_progress);
    }
    result.error->target = error;
    take_refined(refinement, window, step, result);
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
      View shown = view;
      shown.size = picture.shown()->size;
      shown.samples_per_pixel = picture.shown()->samples_per_pixel;
      if (!on_picture(picture.read(), shown)) return;
      if (picture.is_complete() && shown.samples_per_pixel >= view.samples_per_pixel) return;
    }
  }

  const gpu::Device& device;
  TunedRendererOptions options;
  size_t pipelines_before;
  Pacer pacer;
  SetupStats stats;
  SceneOnDevice scene;
  std::optional<Film> film;
  FeatureMask film_features;
  std::vector<uvec4> film_records;
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
