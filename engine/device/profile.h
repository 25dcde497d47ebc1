// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace promin::gpu {

/// The properties of a device that determine its profile.
struct DeviceTraits {
  /// True if the host's processor does the device's work.
  bool is_cpu = false;
  /// The VkDriverId; 0 if the driver reports none.
  uint32_t driver_id = 0;
  /// VkPhysicalDeviceDriverProperties::driverInfo as the driver reports it. For Mesa it begins with "Mesa " and the
  /// version.
  std::string driver_info = {};
  /// Number of cores of the host.
  uint32_t core_count = 1;
  /// True if the driver has VK_EXT_shader_object, and promin was compiled with headers that have it.
  bool has_shader_objects = false;
  /// Largest size of a texel buffer.
  uint64_t texel_buffer_bytes = 0;
};

/// The way in which shaders/trace/traversal.glsl traverses trees. Hits have the same bits for every form.
struct TraversalForm {
  /// Number of node steps that all lanes of a packet take before the lanes that have reached leaves test them. With 0
  /// each lane steps until it reaches a leaf.
  uint32_t steps_together = 0;
  /// True if solids in the leaves of a tree with more triangles wait until no lane can continue without them.
  bool waits_with_solids = false;
  /// True if triangles that a ray may hit wait too, in scenes whose textures have holes.
  bool waits_with_holes = false;
};

/// The settings for a device: all decisions that depend on its type or driver. No setting changes a bit of a picture or
/// a hit. The defaults are for a GPU, whose lanes have few registers, which hides latency by itself, and whose driver
/// kills dispatches of seconds.
struct DeviceProfile {
  // Settings for reading the scene.

  /// The largest size of a buffer in bytes for which the scene is read as texels. If a buffer is larger, the scene is
  /// read from storage buffers. A CPU driver loads storage buffers word by word, but a texel in one step.
  uint64_t most_texel_bytes = 0;
  /// True if the stream of a picture is read as texels. This needs a texel buffer that can hold a film.
  bool fetches_film_texels = false;

  /// The form of traversal for packets of rays.
  TraversalForm packet_traversal;
  /// The form of traversal for single rays.
  TraversalForm ray_traversal;

  // Settings for dividing work into dispatches and workgroups.

  /// The target duration of a dispatch in milliseconds. At the end of each dispatch, the threads of a CPU driver wait
  /// for the slowest one.
  double target_dispatch_ms = 25.0;
  /// True if the driver compiles a kernel in one thread at the kernel's first dispatch, keeps the result in a cache on
  /// the disk, and the host has another core. Kernels then compile on two devices at the same time (side_compiler.h).
  bool compiles_on_second_device = false;
  /// True if kernels are shader objects, and promin keeps their binaries on the disk (kernel_folder.h). Drivers of GPUs
  /// keep kernels themselves.
  bool keeps_kernels = false;
  /// Number of seconds after which a device that does not answer counts as lost.
  double most_silence_s = 120.0;
  /// Largest number of rows of workgroups in a dispatch (trace/kernels/group_rows.h).
  uint32_t most_group_rows = 1;
  /// True if the driver may end loops after too many iterations (trace/kernels/cut_loops.h). Code that traces then
  /// checks whether it did.
  bool may_cut_loops = false;

  // Settings for pictures.

  /// Number of pixels that a lane of the camera stage traces together: 1, 2 or 4.
  uint32_t pixel_packet_size = 1;
  /// Number of samples below which each lane traces one pixel, because that kernel compiles faster and traces slower.
  uint64_t samples_that_repay_packets = 0;
  /// Largest number of pixels whose paths are traced together, bounce by bounce (trace/kernels/path_stream.h). It must
  /// be large enough to fill the device at late bounces too.
  uint32_t most_stream_paths = 1U << 18;

  // Settings for casting rays.

  /// Number of neighbouring rays that a lane traces together: 1, or RayTiler::kPacketSize. For packets, rays are
  /// ordered in tiles.
  uint32_t ray_packet_size = 1;
  /// True if rays without similar neighbours are sorted.
  bool sorts_rays = false;

  // Settings for the frames of a window.

  /// Largest number of frames in flight. One is enough if nothing would run in parallel and the next frame would only
  /// show an older camera.
  uint32_t most_frames_in_flight = 2;
  /// True if a frame is presented only after the device has finished it, because presenting would otherwise wait.
  bool presents_late = false;
  /// True if frames usually take less time than the display's refresh interval.
  bool keeps_up_with_display = true;

  // Settings for measurements.

  /// Number of rays in a dispatch whose speed is measured. It must be large enough to fill the device.
  uint32_t measured_rays = 1U << 20;
};

/// Returns the profile for these traits. The result depends only on the traits.
DeviceProfile make_profile(const DeviceTraits& traits);

}  // namespace promin::gpu
