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
#include "trace/film/film_records.h"
#include "trace/film/refinement.h"
#include "trace/kernels/path_stream.h"
#include "trace/kernels/picture_shaders.h"
#include "trace/kernels/tile_scheduler.h"
#include "trace/kernels/tracing_kernel.h"

namespace promin {

struct FilmCounts {
  RayCounts rays;
  /// True if the driver has cut loops; see were_loops_cut().
  bool has_cut_loops = false;
};

struct FilmOptions {
  /// Number of pixels that a lane of the camera stage traces together, 1, 2 or 4; if empty, the device profile decides.
  std::optional<uint32_t> packet_size = std::nullopt;
  /// The number of samples that is expected; see RendererOptions::expected_samples.
  uint64_t expected_samples = std::numeric_limits<uint64_t>::max();
  /// If true, shaders read the scene from storage buffers even if texel buffers can hold it. For tests.
  bool avoids_texels = false;
  /// Replaces TraversalForm::waits_with_holes of the device profile. For tests.
  std::optional<bool> waits_with_holes = std::nullopt;
  /// The shaders. Other shaders with the same bindings are for measurements.
  PictureShaders shaders = picture_shaders();
  /// Number of uvec4 records after the pixels, for FEATURE_RAY_LOG.
  uint32_t log_records = 0;
};

/// The pixels of a picture in device memory, and the pipeline that traces a scene onto them piece by piece in two
/// stages (shaders/picture/camera_stage.comp, and the stream of paths behind it). A caller begins a picture and then
/// runs all of its pieces. A function waits for the device only if its comment says so.
class Film {
 public:
  /// Compiles the pipelines, unless the device has already compiled the same ones. `features` are the features of the
  /// scene, of the debug view (scene/features.h) and of AOVs.
  Film(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, FeatureMask features,
       const FilmOptions& options = {});

  /// Allocates memory for this number of pixels. The device must not be using the film.
  void reserve(uint32_t pixel_count);

  /// With FEATURE_LISTED_SAMPLES: allocates memory for samples and copies them to the film. A picture of list_window()
  /// traces them there. The device must not be using the film.
  void put_list(std::span<const ListedSample> samples);
  /// Returns the results of the list, for the pixels of list_window(). They are valid until the next access to the
  /// film.
  ReadFilm read_list();

  /// Copies the first records of a picture of this size to the film, as many as fit, as if they had been traced with
  /// one sample per pixel. The device must not be using the film.
  void put_pixels(std::span<const uvec4> records, const uvec2& size);

  /// Binds the scene again after parts of it have changed. The device must not be using the film.
  void bind_scene();

  /// Returns options for dividing pictures with this number of bounces into pieces for the device.
  TileOptions piece_options(uint32_t depth) const;
  /// Returns the pieces of a picture of the film's scene for the film's current size; call reserve() first.
  TileScheduler cut(const View& view, const PixelWindow& window, const TileOptions& options) const;

  /// Records the beginning of a picture, after all earlier work of compute shaders and transfers. The picture must fit
  /// on the film.
  void record_begin(const vk::raii::CommandBuffer& commands, const TileScheduler& picture) const;
  /// Records a piece of the picture, after all earlier work of compute shaders and transfers.
  void record(const vk::raii::CommandBuffer& commands, const TileSample& piece) const;
  /// Records a copy of kCountersBytes of counters to the start of `target`, and sets the counters to zero.
  void record_take_counts(const vk::raii::CommandBuffer& commands, const gpu::Buffer& target) const;

  /// Begins a picture: records the commands, runs them and waits. `run` does the same with a piece and returns device
  /// milliseconds like TracingKernel::run().
  void begin(const TileScheduler& picture) const;
  double run(std::span<const TileSample> pieces) const;
  FilmCounts take_counts() const;
  /// Traces a block of one pixel. Drivers compile in a pipeline's first dispatch, which must not count as tracing.
  void warm_up();
  /// Returns the kernel that a second device may compile during warm_up(); nullopt if the film has only one large
  /// kernel.
  std::optional<gpu::KernelSource> side_kernel() const;

  /// Returns what the samples of a view choose besides their places in the pixels. It depends on the scene and the
  /// view, and not on further features of the film.
  SampledPoints sampled_points(const View& view) const;

  /// Returns the layout of a pixel's records. Each record is a uvec4.
  const FilmRecords& records() const { return records_; }
  /// Returns the largest number of pixels of a film on this device.
  uint32_t max_capacity() const;
  const gpu::Buffer& buffer() const { return *buffer_; }

  /// Offset of the pixels in the buffer. The counters come before the pixels.
  static const vk::DeviceSize kPixelsOffset;
  static const vk::DeviceSize kCountersBytes;

 private:
  /// Returns whether the film's pixels are samples of a list.
  bool is_listed() const;
  /// Returns whether paths continue after the camera stage, in the stream.
  bool has_stream() const;
  /// Returns the largest number of surfaces that blend along a ray.
  uint32_t most_layers() const;
  bool fetches_film_texels() const;
  /// Returns the stream for a picture of this depth on a film with this number of pixels.
  StreamShape stream_shape(uint32_t pixel_count, uint32_t depth) const;
  /// Returns the size in bytes of the largest stream of a film with this number of pixels.
  uint64_t bytes_of_stream(uint32_t pixel_count) const;
  std::array<gpu::BoundBuffer, 2> film_buffers() const;
  std::vector<gpu::BoundBuffer> buffers() const;

  const gpu::Device* device_;
  std::shared_ptr<const DeviceScene> scene_;
  FeatureMask features_;
  FilmRecords records_;
  uint32_t packet_size_;
  bool avoids_texels_;
  std::optional<bool> waits_with_holes_;
  PictureShaders shaders_;
  uint32_t log_records_;
  gpu::Buffer view_constants_;
  std::optional<gpu::Buffer> buffer_;
  /// Records of a list before their upload.
  std::vector<uvec4> list_records_;
  vk::raii::BufferView texels_{nullptr};
  uint32_t capacity_ = 0;
  std::optional<TracingKernel> kernel_;
  std::optional<PathStream> stream_;
};

/// Returns the window of a picture that traces a list of this number of samples. The lanes of a block trace neighbours
/// in the list.
PixelWindow list_window(size_t sample_count);

/// Computes pixels from the first records of a film, which are sums: divides each sum by the number of samples.
/// `pixels` determines the number of pixels.
void average_samples(std::span<const uvec4> records, uint32_t samples, std::span<vec3> pixels);

/// Returns the sum of counters in the form that record_take_counts() writes.
RayCounts sum_counts(std::span<const std::byte> counters);
/// Returns whether the driver has cut the loops of a lane (shaders/shared/loop_check.glsl). Pixels are then wrong.
bool were_loops_cut(std::span<const std::byte> counters);

}  // namespace promin
