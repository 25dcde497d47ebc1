// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "device/buffer.h"
#include "device_scene/device_scene.h"
#include "promin/ray_counts.h"
#include "scene/features.h"
#include "trace/film_records.h"
#include "trace/path_stream.h"
#include "trace/picture_shaders.h"
#include "trace/refinement.h"
#include "trace/tile_scheduler.h"
#include "trace/tracing_kernel.h"

namespace promin {

struct FilmCounts {
  RayCounts rays;
  /// See were_loops_cut.
  bool has_cut_loops = false;
};

struct FilmOptions {
  /// Pixels that a lane of the camera stage takes together, 1, 2 or 4; empty: as suits the device.
  std::optional<uint32_t> packet_size = std::nullopt;
  /// See RendererOptions::expected_samples.
  uint64_t expected_samples = std::numeric_limits<uint64_t>::max();
  /// Read the scene as storage buffers even where texel buffers hold it, for tests.
  bool avoids_texels = false;
  /// Others with the same bindings are for measurements.
  PictureShaders shaders = picture_shaders();
  /// Room behind the pixels, of uvec4: FEATURE_RAY_LOG's.
  uint32_t log_records = 0;
};

/// The pixels of a picture in device memory, and the pipeline that traces a scene onto them piece by piece
/// in two stages (shaders/camera_stage.comp, and the stream of paths behind it). A picture is begun, then all of its
/// pieces run; nothing of that waits unless it says so.
class Film {
 public:
  /// Compiles unless the device has compiled the same already. `features` of the scene and of the debug view
  /// (scene/features.h), and of AOVs.
  Film(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
       const FilmOptions& options = {});

  /// Makes room for so many pixels; the device is idle with respect to the film.
  void reserve(uint32_t pixel_count);

  /// With FEATURE_LISTED_SAMPLES: puts samples on the film, where a picture of list_window() traces them; makes room
  /// for them. The device is idle with respect to the film.
  void put_list(std::span<const ListedSample> samples);
  /// What they have seen, as long as nothing else is put there or read; of the pixels of list_window().
  ReadFilm read_list();

  /// Puts the first records of a picture of this size on the film, as many as have room, as if they had been traced
  /// with one sample a pixel; the device is idle with respect to the film.
  void put_pixels(std::span<const uvec4> records, const uvec2& size);

  /// Takes note that the scene has changed parts; the device is idle with respect to the film.
  void bind_scene();

  /// How the device wants pictures of so many bounces cut.
  TileOptions piece_options(uint32_t depth) const;
  /// A picture of the film's scene, on the film as large as it is now: reserve() comes first.
  TileScheduler cut(const View& view, const PixelWindow& window, const TileOptions& options) const;

  /// Records the beginning of a picture that has room, after all that compute shaders and transfers recorded before.
  void record_begin(const vk::raii::CommandBuffer& commands, const TileScheduler& picture) const;
  /// Records one of its pieces, likewise.
  void record(const vk::raii::CommandBuffer& commands, const TileSample& piece) const;
  /// Records a copy of the counters to the start of `target`, kCountersBytes of it, and sets them to zero.
  void record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const;

  /// As the recordings above, and waits. `run` returns device milliseconds as TracingKernel::run does.
  void begin(const TileScheduler& picture) const;
  double run(std::span<const TileSample> pieces) const;
  FilmCounts take_counts() const;
  /// Traces a block of one pixel: drivers compile late, and a pipeline's first dispatch must not count as tracing.
  void warm_up();

  /// Of a pixel, each an uvec4.
  const FilmRecords& records() const { return records_; }
  /// Most pixels that a film can have on this device.
  uint32_t max_capacity() const;
  const gpu::Buffer& buffer() const { return *buffer_; }

  /// Where the pixels lie in the buffer; counters before them.
  static const vk::DeviceSize kPixelsOffset;
  static const vk::DeviceSize kCountersBytes;

 private:
  /// Whether its pixels are samples of a list.
  bool is_listed() const;
  /// Whether paths go on beyond the camera stage.
  bool has_stream() const;
  /// How many surfaces that blend a ray goes through.
  uint32_t most_layers() const;
  bool fetches_film_texels() const;
  /// Of a film of so many pixels, for a picture of this depth.
  StreamShape stream_shape(uint32_t pixel_count, uint32_t depth) const;
  /// The most that any of them takes.
  uint64_t bytes_of_stream(uint32_t pixel_count) const;
  std::array<gpu::BoundBuffer, 2> film_buffers() const;
  std::vector<gpu::BoundBuffer> buffers() const;

  const gpu::Device* device_;
  std::shared_ptr<const DeviceScene> scene_;
  FeatureMask features_;
  FilmRecords records_;
  uint32_t packet_size_;
  bool avoids_texels_;
  PictureShaders shaders_;
  uint32_t log_records_;
  gpu::Buffer view_constants_;
  std::optional<gpu::Buffer> buffer_;
  /// Of a list, on their way.
  std::vector<uvec4> list_records_;
  vk::raii::BufferView texels_{nullptr};
  uint32_t capacity_ = 0;
  std::optional<TracingKernel> kernel_;
  std::optional<PathStream> stream_;
};

/// The window of a picture that traces a list of so many samples: a block's lanes take what lies side by side.
PixelWindow list_window(size_t sample_count);

/// Pixels of a film, from their first records: what they hold over the number of samples. As many as `pixels`.
void average_samples(std::span<const uvec4> records, uint32_t samples, std::span<vec3> pixels);

/// The sum of counters as record_take_counts copies them.
RayCounts sum_counts(std::span<const std::byte> counters);
/// Whether they tell that the driver cut a lane's loops (shaders/loop_check.glsl): then pixels are wrong.
bool were_loops_cut(std::span<const std::byte> counters);

}  // namespace promin
