// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "layout.h"
#include "render.spv.h"
#include "render/pack_scene.h"
#include "render/sampling.h"

namespace promin {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;

/// Head of the film buffer (shaders/bindings.glsl).
struct FilmHead {
  layout::Dispatch dispatch{};
  /// One for each lane of a block.
  std::array<uvec4, kLanes> ray_counts{};
};

/// Most pixels that a film holds; larger pictures are traced in bands of rows. 64 MiB is half of what Vulkan
/// guarantees for a storage buffer.
constexpr uint32_t kMaxFilmPixels = (64U << 20) / sizeof(vec4) - sizeof(FilmHead) / sizeof(vec4);

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
  frame.eye = vec4(camera.eye, camera.near);
  frame.look = vec4(camera.look, 0.0F);
  dispatch.sampling.w = is_orthographic ? 1 : 0;
  frame.right = vec4(vec3(right), 0.0F);
  frame.up = vec4(vec3(up), 0.0F);
  frame.film_center.x = 0.5F * static_cast<float>(size.x);
  frame.film_center.y = 0.5F * static_cast<float>(size.y);
}

}  // namespace

struct Renderer::Impl {
  Impl(const gpu::Device& the_device, const Scene& scene, const RendererOptions& the_options)
      : device(the_device), options(the_options) {
    const PackedScene packed = pack_scene(scene, options.builder);
    frame = packed.frame;
    dispatch = packed.dispatch;
    stats.bvh = packed.bvh;
    stats.bvh_ms = packed.bvh_ms;
    stats.device_bytes = packed.size_bytes();
    stats.features = options.force_all_features ? all_features() : features_of(scene);
    stats.features &= ~options.left_out_features;

    auto start = Clock::now();
    nodes = upload(std::as_bytes(std::span(packed.nodes)));
    primitives = upload(std::as_bytes(std::span(packed.primitives)));
    shading = upload(packed.shading);
    frame_buffer.emplace(device, sizeof(layout::Frame), vk::BufferUsageFlagBits::eUniformBuffer);
    make_film(kLanes);
    stats.upload_ms = milliseconds_since(start);

    start = Clock::now();
    make_pipeline(packed.stack_size);
    compile_by_dispatch();
    stats.pipeline_ms = milliseconds_since(start);
  }

  std::optional<gpu::Buffer> upload(std::span<const std::byte> bytes) {
    std::optional<gpu::Buffer> buffer;
    buffer.emplace(device, bytes.size(), vk::BufferUsageFlagBits::eStorageBuffer);
    buffer->write(bytes);
    return buffer;
  }

  void make_film(uint32_t pixel_count) {
    if (film && film_pixels >= pixel_count) return;
    film.emplace(device, sizeof(FilmHead) + pixel_count * sizeof(vec4), vk::BufferUsageFlagBits::eStorageBuffer);
    film_pixels = pixel_count;
    if (pipeline) pipeline->bind({layout::BINDING_FILM, vk::DescriptorType::eStorageBuffer, &*film});
  }

  void make_pipeline(uint32_t stack_size) {
    using vk::DescriptorType;
    const std::array constants{gpu::SpecializationConstant{layout::CONSTANT_FEATURES, stats.features},
                               gpu::SpecializationConstant{layout::CONSTANT_STACK_SIZE, stack_size}};
    const std::array buffers{gpu::BoundBuffer{layout::BINDING_FRAME, DescriptorType::eUniformBuffer, &*frame_buffer},
                             gpu::BoundBuffer{layout::BINDING_NODES, DescriptorType::eStorageBuffer, &*nodes},
                             gpu::BoundBuffer{layout::BINDING_PRIMITIVES, DescriptorType::eStorageBuffer, &*primitives},
                             gpu::BoundBuffer{layout::BINDING_SHADING, DescriptorType::eStorageBuffer, &*shading},
                             gpu::BoundBuffer{layout::BINDING_FILM, DescriptorType::eStorageBuffer, &*film}};
    pipeline.emplace(device, k_render_spirv, constants, buffers);
    if (device.timestamp_period_ns() > 0.0) {
      queries = vk::raii::QueryPool(device.handle(), vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2));
    }
  }

  /// Drivers compile late: the first dispatch of a pipeline must not count as tracing.
  void compile_by_dispatch() {
    layout::Frame one_pixel = frame;
    layout::Dispatch one_block = dispatch;
    one_block.range = uvec4(0, 0, 1, 0);
    one_block.window = uvec4(0, 0, 1, 1);
    one_block.sampling = uvec4(1, 1, 1, 0);
    set_camera(one_pixel, one_block, Camera(), uvec2(1));
    one_pixel.film_center.z = 0.5F;
    frame_buffer->write(std::as_bytes(std::span(&one_pixel, 1)));
    run(one_block, 1);
  }

  /// Returns device milliseconds.
  double run(const layout::Dispatch& constants, uint32_t block_count) {
    const auto start = Clock::now();
    device.run([&](const vk::raii::CommandBuffer& commands) {
      using Access = vk::AccessFlagBits;
      using Stage = vk::PipelineStageFlagBits;
      const vk::MemoryBarrier after_last(Access::eShaderRead | Access::eShaderWrite, Access::eTransferWrite);
      commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, after_last, {}, {});
      commands.updateBuffer<layout::Dispatch>(*film->handle(), offsetof(FilmHead, dispatch), constants);
      const vk::MemoryBarrier before(Access::eShaderWrite | Access::eTransferWrite,
                                     Access::eShaderRead | Access::eShaderWrite | Access::eUniformRead);
      commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eComputeShader, {}, before, {}, {});
      if (*queries) {
        commands.resetQueryPool(*queries, 0, 2);
        commands.writeTimestamp(Stage::eTopOfPipe, *queries, 0);
      }
      pipeline->dispatch(commands, block_count);
      if (*queries) commands.writeTimestamp(Stage::eBottomOfPipe, *queries, 1);
      const vk::MemoryBarrier after(Access::eShaderWrite, Access::eHostRead);
      commands.pipelineBarrier(Stage::eComputeShader, Stage::eHost, {}, after, {}, {});
    });
    if (!*queries) return milliseconds_since(start);
    const auto [result, ticks] = queries.getResults<uint64_t>(
        0, 2, 2 * sizeof(uint64_t), sizeof(uint64_t), vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    return static_cast<double>(device.ticks_between(ticks[0], ticks[1])) * device.timestamp_period_ns() * 1e-6;
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
    layout::Frame constants = frame;
    layout::Dispatch range = dispatch;
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
        const double time_ms = run(range, blocks);
        result.trace_ms += time_ms;
        learn_rate(static_cast<double>(blocks) * count, time_ms);
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

  // A dispatch covers blocks * samples units of work; their number follows the time that the last ones took. At least
  // this many blocks keep the device's cores busy.
  static constexpr uint32_t kMinBlocks = 64;
  static constexpr uint32_t kMaxBlocks = 65535;  // Vulkan's guaranteed workgroup count

  uint32_t pick_block_count(uint32_t samples, uint32_t remaining) const {
    if (options.blocks_per_dispatch > 0) return std::min({options.blocks_per_dispatch, remaining, kMaxBlocks});
    const double wanted = units_per_dispatch / samples;
    const auto blocks = static_cast<uint32_t>(std::clamp(wanted, double{kMinBlocks}, double{kMaxBlocks}));
    return std::min(blocks, remaining);
  }

  uint32_t pick_sample_count(uint32_t blocks, uint32_t remaining) const {
    const double wanted = std::max(1.0, units_per_dispatch / blocks);
    return static_cast<uint32_t>(std::min<double>(wanted, remaining));
  }

  void learn_rate(double units, double time_ms) {
    // No faster than fourfold a step: the next tile may be dearer than the last.
    const double ideal = units * options.target_dispatch_ms / std::max(time_ms, 1e-3);
    units_per_dispatch = std::clamp(ideal, 1.0, 4.0 * std::max(units_per_dispatch, units));
  }

  const gpu::Device& device;
  RendererOptions options;
  layout::Frame frame{};
  layout::Dispatch dispatch{};
  SetupStats stats;
  std::optional<gpu::Buffer> nodes;
  std::optional<gpu::Buffer> primitives;
  std::optional<gpu::Buffer> shading;
  std::optional<gpu::Buffer> frame_buffer;
  std::optional<gpu::Buffer> film;
  uint32_t film_pixels = 0;
  std::optional<gpu::ComputePipeline> pipeline;
  vk::raii::QueryPool queries{nullptr};
  double units_per_dispatch = kMinBlocks;
  uint32_t generator = 1;
};

Renderer::Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options) {
  gpu::translate_vulkan_errors([&] { impl_ = std::make_unique<Impl>(device, scene, options); });
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Renderer::SetupStats& Renderer::setup_stats() const {
  return impl_->stats;
}

RenderResult Renderer::render(const View& view, const std::function<void(double)>& progress) {
  const PixelWindow window = view.crop.value_or(PixelWindow{uvec2(0), view.size});
  assert(window.lo.x < window.hi.x && window.lo.y < window.hi.y);
  assert(window.hi.x <= view.size.x && window.hi.y <= view.size.y);
  assert(view.samples_per_pixel >= 1 && view.samples_per_pixel <= kMaxSamplesPerPixel);

  RenderResult result;
  result.image.size = window.hi - window.lo;
  result.image.pixels.resize(static_cast<size_t>(result.image.size.x) * result.image.size.y);
  impl_->generator = lattice_generator(view.samples_per_pixel);
  const uint32_t width = result.image.size.x;
  const uint32_t band_rows =
      std::max(layout::BLOCK_SIZE, kMaxFilmPixels / width / layout::BLOCK_SIZE * layout::BLOCK_SIZE);
  std::vector<std::byte> film;
  for (uint32_t y = window.lo.y; y < window.hi.y; y += band_rows) {
    const PixelWindow band{uvec2(window.lo.x, y), uvec2(window.hi.x, std::min(window.hi.y, y + band_rows))};
    const uint32_t rows = band.hi.y - band.lo.y;
    const double done = static_cast<double>(y - window.lo.y) / result.image.size.y;
    const double share = static_cast<double>(rows) / result.image.size.y;
    gpu::translate_vulkan_errors([&] {
      impl_->trace_band(band, view, result, [&](double fraction) {
        if (progress) progress(done + share * fraction);
      });
      film.resize(sizeof(FilmHead) + static_cast<size_t>(width) * rows * sizeof(vec4));
      impl_->film->read(film);
    });
    const auto* sums = reinterpret_cast<const vec4*>(film.data() + sizeof(FilmHead));
    const auto samples = static_cast<float>(view.samples_per_pixel);
    vec3* target = &result.image.at(0, y - window.lo.y);
    for (size_t i = 0; i < static_cast<size_t>(width) * rows; ++i) target[i] = vec3(sums[i]) / samples;
  }
  return result;
}

}  // namespace promin
