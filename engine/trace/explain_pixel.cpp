// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/explain_pixel.h"

#include <array>
#include <bit>
#include <cstddef>

#include "device/device.h"
#include "device_scene/device_scene.h"
#include "promin/error.h"
#include "trace/cut_loops.h"
#include "trace/explain_sample.h"
#include "trace/film.h"
#include "trace/tile_scheduler.h"
#include "trace/tracing_kernel.h"

namespace promin {
namespace {

/// The head of a film of one pixel; its log follows (shaders/ray_log.glsl).
struct LoggedFilm {
  layout::Dispatch dispatch{};
  std::array<uvec4, layout::BLOCK_SIZE * layout::BLOCK_SIZE> ray_counts{};
  uvec4 pixel{0};
  uvec4 log_count{0};
};

/// The log may take half of what Vulkan guarantees for a storage buffer.
constexpr uint64_t kMostLogBytes = 64U << 20;

/// The size of the film with the log of one sample of the view, whatever the sample meets.
uint64_t film_bytes(const DeviceScene& scene, const View& view) {
  const uint64_t most_entries = (uint64_t{1} + view.max_depth) * (uint64_t{1} + scene.constants().light_count);
  if (most_entries > kMostLogBytes / sizeof(layout::RayLog)) {
    throw RunError({"a pixel may take " + std::to_string(most_entries) + " rays and sources, too many to explain",
                    "in this scene with so many bounces", "take a smaller depth", Setting::kDepth});
  }
  return sizeof(LoggedFilm) + most_entries * sizeof(layout::RayLog);
}

constexpr uint64_t kQueuedPathBytes = Film::kQueuedPathRecords * sizeof(uvec4);

class LoggingKernel {
 public:
  LoggingKernel(const gpu::Device& device, const DeviceScene& scene, FeatureMask features, const View& view)
      : view_constants_(device, sizeof(layout::ViewConstants), vk::BufferUsageFlagBits::eUniformBuffer),
        queue_offset_(film_bytes(scene, view)),
        film_(device, queue_offset_ + kQueuedPathBytes, vk::BufferUsageFlagBits::eStorageBuffer),
        kernel_(make_picture_kernel(device, scene, features | layout::FEATURE_RAY_LOG, 1, view_constants_, film_)) {
    const layout::ViewConstants constants = make_view_constants(scene.constants(), view);
    view_constants_.write(std::as_bytes(std::span(&constants, 1)));
  }

  /// Traces one sample of the pixel; samples are traced in their order.
  std::vector<layout::RayLog> trace(const TileSample& sample) {
    head_.log_count = uvec4(0);
    film_.write(std::as_bytes(std::span(&head_, 1)));
    kernel_.run(sample.dispatch, film_, sample.group_counts);
    film_.read(std::as_writable_bytes(std::span(&head_, 1)));
    CutLoops::of_pixels().check(were_loops_cut(std::as_bytes(std::span(head_.ray_counts))));
    std::vector<layout::RayLog> log(head_.log_count.x);
    film_.read(std::as_writable_bytes(std::span(log)), sizeof(LoggedFilm));
    return log;
  }

  /// The place of the queue, in records of the film.
  uint32_t first_queue_record() const {
    return static_cast<uint32_t>((queue_offset_ - offsetof(LoggedFilm, pixel)) / sizeof(uvec4));
  }

  /// The sum of the samples so far.
  vec3 sum() const { return std::bit_cast<vec3>(std::array{head_.pixel.x, head_.pixel.y, head_.pixel.z}); }

 private:
  gpu::Buffer view_constants_;
  /// The place of the queue of paths, behind the log.
  uint64_t queue_offset_;
  gpu::Buffer film_;
  LoggedFilm head_;
  TracingKernel kernel_;
};

}  // namespace

Explanation explain_pixel(const gpu::Device& device, const DeviceScene& scene, const PrimitiveNumbers& numbers,
                          FeatureMask features, const View& view, const uvec2& pixel) {
  LoggingKernel kernel(device, scene, features, view);
  TileScheduler samples(scene.constants(), view, {pixel, pixel + 1U},
                        {.first_queue_record = kernel.first_queue_record()});
  Explanation explanation;
  explanation.pixel = pixel;
  while (!samples.is_done()) {
    explanation.samples.push_back(explain_sample(kernel.trace(samples.next(1.0)), numbers, scene.light_numbers()));
  }
  explanation.sum = kernel.sum();
  explanation.color = explanation.sum / static_cast<float>(view.samples_per_pixel);
  return explanation;
}

}  // namespace promin
