// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/explain_pixel.h"

#include <algorithm>
#include <array>
#include <bit>

#include "device/device.h"
#include "device_scene/device_scene.h"
#include "promin/error.h"
#include "trace/film/explain_sample.h"
#include "trace/film/film.h"
#include "trace/kernels/cut_loops.h"
#include "trace/kernels/tile_scheduler.h"

namespace promin {
namespace {

/// The largest size of the log in bytes: half of the size that Vulkan guarantees for a storage buffer.
constexpr uint64_t kMostLogBytes = 64U << 20;

/// Returns the largest number of log entries of one sample of the view, for any objects that its rays hit.
uint64_t most_entries(const DeviceScene& scene, FeatureMask features, const View& view) {
  const uint32_t layers = features.has_any(layout::FEATURE_BLENDING) ? layout::MOST_LAYERS : 0;
  const uint64_t steps = most_steps(view.max_depth, refracted_rays(features), layers);
  const uint64_t entries =
      (1 + steps) * (uint64_t{1} + std::max(scene.constants().light_count, scene.constants().direct_count));
  if (entries > kMostLogBytes / sizeof(layout::RayLog)) {
    throw RunError({"explain.rays.many",
                    "a pixel may need " + std::to_string(entries) + " rays and light sources, too many to explain", "",
                    "use a smaller depth", Setting::kDepth});
  }
  return entries;
}

/// Reads the log of the sample that was traced last. The log follows the pixel (shaders/picture/ray_log.glsl).
std::vector<layout::RayLog> read_log(const Film& film) {
  const vk::DeviceSize count_offset = Film::kPixelsOffset + sizeof(uvec4);
  uvec4 count;
  film.buffer().read(std::as_writable_bytes(std::span(&count, 1)), count_offset);
  std::vector<layout::RayLog> log(count.x);
  film.buffer().read(std::as_writable_bytes(std::span(log)), count_offset + sizeof count);
  return log;
}

/// Reads the sum of the pixel's samples so far.
vec3 read_sum(const Film& film) {
  uvec4 pixel;
  film.buffer().read(std::as_writable_bytes(std::span(&pixel, 1)), Film::kPixelsOffset);
  return std::bit_cast<vec3>(std::array{pixel.x, pixel.y, pixel.z});
}

}  // namespace

Explanation explain_pixel(const gpu::Device& device, const std::shared_ptr<const DeviceScene>& scene,
                          const PrimitiveNumbers& numbers, FeatureMask features, const View& view, const uvec2& pixel) {
  constexpr uint64_t kEntryRecords = sizeof(layout::RayLog) / sizeof(uvec4);
  // The film has packets of one ray, because rays of a packet share their steps but a log describes single rays.
  Film film(device, scene, features | layout::FEATURE_RAY_LOG,
            {.packet_size = 1,
             .log_records = static_cast<uint32_t>(1 + most_entries(*scene, features, view) * kEntryRecords)});
  TileScheduler samples = film.cut(view, {pixel, pixel + 1U}, film.piece_options(view.max_depth));
  Explanation explanation;
  explanation.pixel = pixel;
  film.begin(samples);
  while (!samples.is_done()) {
    const TileSample sample = samples.next(1.0);
    film.run({&sample, 1});
    explanation.samples.push_back(explain_sample(read_log(film), numbers, scene->source_numbers(view.mode.integrator)));
  }
  refuse_cut_loops(film.take_counts().has_cut_loops);
  explanation.sum = read_sum(film);
  explanation.color = explanation.sum / static_cast<float>(view.samples_per_pixel);
  return explanation;
}

}  // namespace promin
