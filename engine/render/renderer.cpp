// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <thread>

#include "core/stopwatch.h"
#include "gpu/device.h"
#include "layout.h"
#include "render.spv.h"
#include "render/device_scene.h"
#include "render/pack_scene.h"
#include "render/sampling.h"
#include "render/tracing_kernel.h"

namespace promin {
namespace {

constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;

/// Head of the film buffer (shaders/render.comp).
struct FilmHead {
  layout::Dispatch dispatch{};
  /// One for each lane of a block.
  std::array<uvec4, kLanes> ray_counts{};
};

/// Most records of a pixel that a film holds; larger pictures are traced in bands of rows. 64 MiB is half of what
/// Vulkan guarantees for a storage buffer.
constexpr uint32_t kMaxFilmRecords = (64U << 20) / sizeof(uvec4) - sizeof(FilmHead) / sizeof(uvec4);

// A dispatch covers blocks * samples units of work; their number follows the time that the last ones took. At least
// this many blocks keep the device's cores busy.
constexpr uint32_t kMinBlocks = 64;
constexpr uint32_t kMaxBlocks = 65535;  // Vulkan's guaranteed workgroup count

uint32_t divide_up(uint32_t a, uint32_t b) {
  return (a + b - 1) / b;
}

/// The camera's part of a frame, computed in double.
void set_camera(layout::Frame& frame, layout::Dispatch& dispatch, const Camera& camera, const uvec2& size) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half_height =
      is_orthographic ? static_cast<double>(camera.ymag) : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half_height / size.y;
  const dvec3 right = glm::cross(dvec3(camera.look), dvec3(camera.up)) * pixel;
  const dvec3 up = dvec3(camera.up) * pixel;
  // A ray's interval is open, but what lies on the viewport itself is drawn.
  const float before_near = camera.near > 0.0F ? std::nextafter(camera.near, 0.0F) : 0.0F;
  frame.eye = vec4(camera.eye, before_near);
  frame.look = vec4(camera.look, 0.0F);
  dispatch.sampling.w = is_orthographic ? 1 : 0;
  frame.right = vec4(vec3(right), 0.0F);
  frame.up = vec4(vec3(up), 0.0F);
  frame.film_center.x = 0.5F * static_cast<float>(size.x);
  frame.film_center.y = 0.5F * static_cast<float>(size.y);
}

}  // namespace

struct Renderer::Impl {
  Impl(const gpu::Device& the_device, const Scene& the_scene, const RendererOptions& the_options)
      : device(the_device),
        options(the_options),
        pacer(options.target_dispatch_ms.value_or(dispatch_target_ms(device)), kMinBlocks) {
    PackedScene packed =
        options.bvh ? pack_scene_with(*options.bvh, the_scene) : pack_scene(the_scene, options.builder);
    stats.bvh = packed.bvh;
    stats.bvh_ms = packed.bvh_ms;
    stats.device_bytes = packed.size_bytes();
    stats.features = options.force_all_features ? all_features() : features_of(the_scene);
    stats.features &= ~options.left_out_features;
    numbers = std::move(packed.numbers);

    const Stopwatch uploading;
    scene.emplace(device, packed);
    frame_buffer.emplace(device, sizeof(layout::Frame), vk::BufferUsageFlagBits::eUniformBuffer);
    make_film(kLanes);
    stats.upload_ms = uploading.ms();

    const Stopwatch compiling;
    make_kernel();
    compile_by_dispatch();
    stats.pipeline_ms = compiling.ms();
  }

  uint32_t records_per_pixel() const { return options.with_aovs ? 2 : 1; }

  void make_film(uint32_t pixel_count) {
    if (film && film_pixels >= pixel_count) return;
    film.emplace(device, sizeof(FilmHead) + pixel_count * records_per_pixel() * sizeof(uvec4),
                 vk::BufferUsageFlagBits::eStorageBuffer);
    film_pixels = pixel_count;
    if (kernel) kernel->bind({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*film});
  }

  void make_kernel() {
    const FeatureMask features = stats.features | (options.with_aovs ? layout::FEATURE_AOVS : 0);
    const std::array constants{
        gpu::SpecializationConstant{layout::CONSTANT_FEATURES, features},
        gpu::SpecializationConstant{layout::CONSTANT_STACK_SIZE, scene->stack_size()},
        gpu::SpecializationConstant{layout::CONSTANT_FETCHES_TEXELS, scene->fetches_texels() ? 1U : 0U}};
    std::vector<gpu::BoundBuffer> buffers = scene->geometry();
    for (const gpu::BoundBuffer& buffer : scene->shading()) buffers.push_back(buffer);
    buffers.push_back({layout::BINDING_FRAME, vk::DescriptorType::eUniformBuffer, &*frame_buffer});
    buffers.push_back({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*film});
    kernel.emplace(device, k_render_spirv, constants, buffers);
  }

  /// Drivers compile late: the first dispatch of a pipeline must not count as tracing.
  void compile_by_dispatch() {
    layout::Frame one_pixel = scene->frame();
    layout::Dispatch one_block = scene->dispatch();
    one_block.range = uvec4(0, 0, 1, 0);
    one_block.window = uvec4(0, 0, 1, 1);
    one_block.sampling = uvec4(1, 1, 1, 0);
    one_block.share.x = 1;
    set_camera(one_pixel, one_block, Camera(), uvec2(1));
    one_pixel.film_center.z = 0.5F;
    frame_buffer->write(std::as_bytes(std::span(&one_pixel, 1)));
    kernel->run(one_block, *film, 1);
  }

  /// Adds the device's counters to `rays` and sets them to zero.
  void collect_counts(RayCounts& rays) {
    FilmHead head;
    film->read(std::as_writable_bytes(std::span(&head, 1)));
    for (const uvec4& counter : head.ray_counts) {
      rays.primary += counter.x;
      rays.shadow += counter.y;
      rays.reflection += counter.z;
    }
    clear_counts();
  }

  void clear_counts() {
    const FilmHead zeros;
    film->write(std::as_bytes(std::span(&zeros, 1)));
  }

  /// Traces one band: `window` of the picture, on a film of its size.
  void trace_band(const PixelWindow& window, const View& view, RenderResult& result,
                  const std::function<void(double)>& on_progress) {
    const uvec2 size = window.hi - window.lo;
    layout::Frame constants = scene->frame();
    layout::Dispatch range = scene->dispatch();
    set_camera(constants, range, view.camera, view.size);
    const uint32_t samples = view.samples_per_pixel;
    const uint32_t block_columns = divide_up(size.x, layout::BLOCK_SIZE);
    const uint32_t block_total = block_columns * divide_up(size.y, layout::BLOCK_SIZE);
    constants.film_center.z = static_cast<float>(0.5 / samples);
    range.window = uvec4(window.lo, size);
    range.sampling = uvec4(samples, generator, block_columns, range.sampling.w);
    make_film(size.x * size.y);
    frame_buffer->write(std::as_bytes(std::span(&constants, 1)));
    clear_counts();

    // The counters have 32 bits: collect them before a lane's may have passed that.
    const double most_rays_a_sample = (1.0 + view.max_depth) * (1.0 + range.counts.z);
    double uncollected = 0.0;
    for (uint32_t first = 0; first < block_total;) {
      const uint32_t blocks = pick_block_count(samples, block_total - first);
      for (uint32_t sample = 0; sample < samples;) {
        const uint32_t count = pick_sample_count(blocks, samples - sample);
        uncollected += most_rays_a_sample * blocks * count;
        range.range = uvec4(first, sample, count, view.max_depth);
        const uint32_t blocks_a_group = pick_blocks_a_group(blocks);
        range.share.x = first + blocks;
        const double time_ms = kernel->run(range, *film, divide_up(blocks, blocks_a_group));
        result.trace_ms += time_ms;
        pacer.learn(static_cast<double>(blocks) * count, time_ms);
        if (uncollected > 2e9) {
          collect_counts(result.rays);
          uncollected = 0.0;
        }
        sample += count;
        on_progress((first + blocks * (static_cast<double>(sample) / samples)) / block_total);
      }
      first += blocks;
    }
    collect_counts(result.rays);
  }

  uint32_t pick_block_count(uint32_t samples, uint32_t remaining) const {
    if (options.blocks_per_dispatch > 0) return std::min({options.blocks_per_dispatch, remaining, kMaxBlocks});
    const double wanted = pacer.units() / samples;
    const auto blocks = static_cast<uint32_t>(std::clamp(wanted, double{kMinBlocks}, double{kMaxBlocks}));
    return std::min(blocks, remaining);
  }

  uint32_t pick_sample_count(uint32_t blocks, uint32_t remaining) const {
    const double wanted = std::max(1.0, pacer.units() / blocks);
    return static_cast<uint32_t>(std::min<double>(wanted, remaining));
  }

  /// Where a lane has several pixels it does not wait for its neighbours' mirror rays; but the device's cores want
  /// groups to share, and on a GPU one group waits while others work.
  uint32_t pick_blocks_a_group(uint32_t blocks) const {
    constexpr uint32_t kMostBlocks = 16;
    constexpr uint32_t kGroupsACore = 8;
    const uint32_t groups = kGroupsACore * std::max(1U, std::thread::hardware_concurrency());
    return device.is_cpu() ? std::clamp(blocks / groups, 1U, kMostBlocks) : 1;
  }

  /// Adds what the film holds of a band to the result, from its pixel `first` on.
  void read_film(size_t first, size_t count, uint32_t samples, RenderResult& result) {
    film_records.resize(count * records_per_pixel());
    film->read(std::as_writable_bytes(std::span(film_records)), sizeof(FilmHead));
    for (size_t i = 0; i < count; ++i) {
      result.image.pixels[first + i] = vec3_of(film_records[i]) / static_cast<float>(samples);
    }
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
  SetupStats stats;
  PrimitiveNumbers numbers;
  std::optional<DeviceScene> scene;
  std::optional<gpu::Buffer> frame_buffer;
  std::optional<gpu::Buffer> film;
  uint32_t film_pixels = 0;
  std::vector<uvec4> film_records;
  std::optional<TracingKernel> kernel;
  uint32_t generator = 1;
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
  impl_->generator = lattice_generator(view.samples_per_pixel);
  const uint32_t film_rows = kMaxFilmRecords / impl_->records_per_pixel() / width;
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
