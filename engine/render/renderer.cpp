// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/stopwatch.h"
#include "device/device.h"
#include "device_scene/pack_scene.h"
#include "layout.h"
#include "trace/explain_pixel.h"
#include "trace/film.h"
#include "trace/sampling.h"

namespace promin {
namespace {

/// Most records of a pixel that a film holds; larger pictures are traced in bands of rows. 64 MiB is half of what
/// Vulkan guarantees for a storage buffer.
constexpr uint32_t kMaxFilmRecords = ((64U << 20) - 4096) / sizeof(uvec4);

/// So that recording them takes no time.
constexpr size_t kMostPiecesAtOnce = 64;

/// A lane's counters have 32 bits: they are taken before they may have passed that.
constexpr double kMaxRaysALane = 2e9;

}  // namespace

struct Renderer::Impl {
  Impl(const gpu::Device& the_device, const Scene& the_scene, const RendererOptions& the_options)
      : device(the_device),
        options(the_options),
        pacer(options.target_dispatch_ms.value_or(dispatch_target_ms(device)), TileScheduler::kMinBlocks) {
    PackedScene packed =
        options.bvh ? pack_scene_with(*options.bvh, the_scene) : pack_scene(the_scene, options.builder);
    if (options.repack) packed = options.repack(std::move(packed));
    stats.bvh = packed.bvh;
    stats.bvh_ms = packed.bvh_ms;
    stats.device_bytes = packed.size_bytes();
    stats.features = options.force_all_features ? all_features() : features_of(the_scene);
    stats.features &= ~options.left_out_features;
    numbers = std::move(packed.numbers);

    const Stopwatch uploading;
    scene = std::make_shared<const DeviceScene>(device, packed);
    stats.upload_ms = uploading.ms();

    const Stopwatch compiling;
    make_film(options.shading);
    stats.pipeline_ms = compiling.ms();
  }

  void make_film(Shading of) {
    const FeatureMask features = stats.features | features_of(of) | (options.with_aovs ? layout::FEATURE_AOVS : 0);
    film.emplace(
        device, scene, features,
        FilmOptions{
            .packet_size = options.packet_size, .avoids_texels = options.avoids_texels, .shaders = options.shaders});
    film->warm_up();
    shading = of;
  }

  /// Traces one band: `window` of the picture, on a film of its size.
  void trace_band(const PixelWindow& window, const View& view, RenderResult& result,
                  const std::function<void(double)>& on_progress) {
    TileOptions cut = film->piece_options();
    cut.blocks_per_piece = options.blocks_per_dispatch;
    for (;;) {
      if (!takes_many_paths) cut.most_paths_a_lane = 1;
      const FilmCounts counts = trace_pieces(window, view, cut, result.trace_ms, on_progress);
      if (!counts.has_cut_loops) {
        result.rays += counts.rays;
        return;
      }
      if (!takes_many_paths) throw make_cut_loops_error("lower --max-depth or take another device");
      takes_many_paths = false;
    }
  }

  FilmCounts trace_pieces(const PixelWindow& window, const View& view, const TileOptions& cut, double& trace_ms,
                          const std::function<void(double)>& on_progress) {
    FilmCounts counts;
    const auto collect = [&] {
      const FilmCounts taken = film->take_counts();
      counts.rays += taken.rays;
      counts.has_cut_loops = counts.has_cut_loops || taken.has_cut_loops;
    };
    TileScheduler picture = film->cut(view, window, cut);
    film->reserve(picture.pixel_count());
    film->begin(picture);
    double uncollected = 0.0;
    std::vector<TileSample> pieces;
    while (!picture.is_done()) {
      // Of a small picture a piece is less than is asked for.
      pieces.clear();
      double units = 0.0;
      do {
        pieces.push_back(picture.next(pacer.units() - units));
        units += pieces.back().units;
        uncollected += pieces.back().most_rays_a_lane;
      } while (units < pacer.units() && pieces.size() < kMostPiecesAtOnce && !picture.is_done());
      const double time_ms = film->run(pieces);
      trace_ms += time_ms;
      pacer.learn(units, time_ms);
      if (uncollected > kMaxRaysALane) {
        collect();
        uncollected = 0.0;
      }
      on_progress(picture.fraction_done());
    }
    collect();
    return counts;
  }

  /// Adds what the film holds of a band to the result, from its pixel `first` on.
  void read_film(size_t first, size_t count, uint32_t samples, RenderResult& result) {
    film_records.resize(count * film->records_per_pixel());
    film->buffer().read(std::as_writable_bytes(std::span(film_records)), Film::kPixelsOffset);
    average_samples(film_records, samples, std::span(result.image.pixels).subspan(first, count));
    if (!options.with_aovs) return;
    Aovs& aovs = result.aovs;
    for (size_t i = 0; i < count; ++i) {
      const uvec4& normal_and_depth = film_records[count + i];
      aovs.normal[first + i] = vec3_of(normal_and_depth);
      aovs.depth[first + i] = std::bit_cast<float>(normal_and_depth.w);
      const uint32_t order = film_records[i].w;
      if (order == layout::NO_ORDER) continue;
      const PrimitiveId id = primitive_of_order(numbers, order);
      aovs.object[first + i] = id.object;
      aovs.primitive[first + i] = id.primitive;
    }
  }

  static vec3 vec3_of(const uvec4& bits) {
    return {std::bit_cast<float>(bits.x), std::bit_cast<float>(bits.y), std::bit_cast<float>(bits.z)};
  }

  const gpu::Device& device;
  RendererOptions options;
  Pacer pacer;
  /// A lane, one after the other. Not once the driver has cut loops: the next band and picture would have it do so
  /// again.
  bool takes_many_paths = true;
  SetupStats stats;
  PrimitiveNumbers numbers;
  std::shared_ptr<const DeviceScene> scene;
  std::optional<Film> film;
  /// The film's.
  Shading shading = Shading::kFull;
  std::vector<uvec4> film_records;
};

Renderer::Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options) {
  gpu::translate_vulkan_errors([&] { impl_ = std::make_unique<Impl>(device, scene, options); });
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const SetupStats& Renderer::setup_stats() const {
  return impl_->stats;
}

Explanation Renderer::explain(const View& view, const uvec2& pixel) {
  assert(!impl_->options.repack);
  assert(pixel.x < view.size.x && pixel.y < view.size.y);
  Explanation explanation;
  gpu::translate_vulkan_errors([&] {
    explanation = explain_pixel(impl_->device, *impl_->scene, impl_->numbers, impl_->stats.features, view, pixel);
  });
  return explanation;
}

RenderResult Renderer::render(const View& view, const std::function<void(double)>& progress) {
  const PixelWindow window = view.crop.value_or(PixelWindow{uvec2(0), view.size});
  assert(window.lo.x < window.hi.x && window.lo.y < window.hi.y);
  assert(window.hi.x <= view.size.x && window.hi.y <= view.size.y);
  assert(view.samples_per_pixel >= 1 && view.samples_per_pixel <= kMaxSamplesPerPixel);

  RenderResult result;
  result.image.size = window.hi - window.lo;
  const uint32_t width = result.image.size.x;
  const size_t pixel_count = static_cast<size_t>(width) * result.image.size.y;
  result.image.pixels.resize(pixel_count);
  if (impl_->options.with_aovs) {
    result.aovs = {std::vector<float>(pixel_count), std::vector<vec3>(pixel_count),
                   std::vector<uint32_t>(pixel_count, Aovs::kNoId), std::vector<uint32_t>(pixel_count, Aovs::kNoId)};
  }
  gpu::translate_vulkan_errors([&] {
    if (view.shading != impl_->shading) impl_->make_film(view.shading);
  });
  const uint32_t film_rows = kMaxFilmRecords / impl_->film->records_per_pixel() / width;
  const uint32_t band_rows = std::max(layout::BLOCK_SIZE, film_rows / layout::BLOCK_SIZE * layout::BLOCK_SIZE);
  for (uint32_t y = window.lo.y; y < window.hi.y; y += band_rows) {
    const PixelWindow band{uvec2(window.lo.x, y), uvec2(window.hi.x, std::min(window.hi.y, y + band_rows))};
    const uint32_t rows = band.hi.y - band.lo.y;
    const double done = static_cast<double>(y - window.lo.y) / result.image.size.y;
    const double share = static_cast<double>(rows) / result.image.size.y;
    gpu::translate_vulkan_errors([&] {
      impl_->trace_band(band, view, result, [&](double fraction) {
        if (progress) progress(done + share * fraction);
      });
      impl_->read_film(static_cast<size_t>(y - window.lo.y) * width, static_cast<size_t>(rows) * width,
                       view.samples_per_pixel, result);
    });
  }
  return result;
}

}  // namespace promin
