// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace promin::gpu {

/// The properties of a device that determine its profile.
struct DeviceTraits {
  /// Whether the host's processor does the device's work.
  bool is_cpu = false;
  /// VkDriverId; 0 if the driver reports none.
  uint32_t driver_id = 0;
  /// VkPhysicalDeviceDriverProperties::driverInfo, as the driver reports it; Mesa's begins with "Mesa " and the
  /// version.
  std::string driver_info = {};
  /// Number of cores of the host.
  uint32_t core_count = 1;
  /// Largest size of a texel buffer.
  uint64_t texel_buffer_bytes = 0;
};

/// How shaders/trace/traversal.glsl traverses trees. Hits have the same bits for every form.
struct TraversalForm {
  /// Number of node steps that all lanes take together before those at leaves test them; 0 lets each lane step until it
  /// reaches a leaf.
  uint32_t steps_together = 0;
  /// Whether solids in the leaves of a tree with more triangles wait until no lane can continue without them.
  bool waits_with_solids = false;
};

/// The settings for a device: every decision that depends on its type or driver. None of them changes a bit of a
/// picture or a hit. The defaults are for a GPU, whose lanes have few registers, which hides latency by itself, and
/// whose driver kills dispatches of seconds.
struct DeviceProfile {
  // How the scene is read.
  /// The scene is read as texels if no buffer has more bytes than this, else from storage buffers. A CPU driver loads
  /// storage buffers word by word, but a texel in one step.
  uint64_t most_texel_bytes = 0;
  /// Whether the stream of a picture is read as texels, if texel buffers can hold a film.
  bool fetches_film_texels = false;

  // How trees are traversed.
  /// By packets of rays.
  TraversalForm packet_traversal;
  /// By rays one by one.
  TraversalForm ray_traversal;

  // How work is divided into dispatches and their workgroups.
  /// How long a dispatch should take. At the end of each the threads of a CPU driver wait for the last one.
  double target_dispatch_ms = 25.0;
  /// A device counts as lost if it does not answer for this number of seconds.
  double most_silence_s = 120.0;
  /// Largest number of rows of workgroups in a dispatch (trace/kernels/group_rows.h).
  uint32_t most_group_rows = 1;
  /// Whether the driver may end loops of too many iterations (trace/kernels/cut_loops.h); callers that trace then check
  /// whether it did.
  bool may_cut_loops = false;

  // Pictures.
  /// Number of pixels that a lane of the camera stage traces together: 1, 2 or 4.
  uint32_t pixel_packet_size = 1;
  /// With fewer samples each lane traces one pixel: that kernel compiles faster and traces slower.
  uint64_t samples_that_repay_packets = 0;
  /// Largest number of pixels whose paths are traced together, bounce by bounce (trace/kernels/path_stream.h): enough
  /// to fill the device at late bounces too.
  uint32_t most_stream_paths = 1U << 18;

  // Casting rays.
  /// Number of neighbouring rays that a lane traces together: 1, or RayTiler::kPacketSize, for which rays are ordered
  /// in tiles.
  uint32_t ray_packet_size = 1;
  /// Whether rays without similar neighbours are sorted.
  bool sorts_rays = false;

  // Frames of a window.
  /// Largest number of frames in flight. One is enough if nothing would run in parallel and the next frame would only
  /// show an older camera.
  uint32_t most_frames_in_flight = 2;
  /// Whether to present only when the device has finished, because presenting would wait for it.
  bool presents_late = false;
  /// Whether frames are usually traced within the display's refresh interval.
  bool keeps_up_with_display = true;

  // Measurements.
  /// Rays in a dispatch whose speed is measured: enough to fill the device.
  uint32_t measured_rays = 1U << 20;
};

/// Returns the profile for these traits. It depends only on its argument.
DeviceProfile make_profile(const DeviceTraits& traits);

}  // namespace promin::gpu
