// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace promin::gpu {

/// What a device says of itself, as far as its profile depends on it.
struct DeviceTraits {
  /// Whether the host's processor does the device's work.
  bool is_cpu = false;
  /// VkDriverId; 0 where the driver does not tell.
  uint32_t driver_id = 0;
  /// VkPhysicalDeviceDriverProperties::driverInfo, in the driver's own words; Mesa's begin with "Mesa " and the
  /// version.
  std::string driver_info = {};
  /// Of the host.
  uint32_t core_count = 1;
  /// Most that a texel buffer holds.
  uint64_t texel_buffer_bytes = 0;
};

/// How shaders/traversal.glsl goes through trees. No form changes a bit of a hit.
struct TraversalForm {
  /// Steps from node to node that all lanes take together before those at leaves look into them; 0: each lane steps on
  /// until it is at a leaf.
  uint32_t steps_together = 0;
  /// Whether solids in the leaves of a tree of more triangles wait until no lane can go on without them.
  bool waits_with_solids = false;
};

/// What suits a device: every decision that depends on its kind or on its driver. None of them changes a bit of a
/// picture or of a hit. The defaults are those of a GPU: its lanes have few registers, it hides latency by itself, and
/// its driver kills dispatches of seconds.
struct DeviceProfile {
  // How the scene is read.
  /// As texels where no buffer has more bytes, else from storage buffers. A CPU driver gathers a load from a storage
  /// buffer word by word, a texel at once.
  uint64_t most_texel_bytes = 0;
  /// Whether the stream of a picture is read as texels, where the texel buffers hold a film.
  bool fetches_film_texels = false;

  // How trees are traversed.
  /// By packets of rays.
  TraversalForm packet_traversal;
  /// By rays one by one.
  TraversalForm ray_traversal;

  // How work is cut into dispatches and spread over the workgroups of each.
  /// How long a dispatch should take. At the end of each the threads of a CPU driver wait for the last one.
  double target_dispatch_ms = 25.0;
  /// A device that is silent for so many seconds is gone.
  double most_silence_s = 120.0;
  /// In how many rows the workgroups of a dispatch come at most (trace/group_rows.h).
  uint32_t most_group_rows = 1;
  /// Whether the driver may end loops that turn too often (trace/cut_loops.h): whoever traces then looks whether it
  /// did.
  bool may_cut_loops = false;

  // Pictures.
  /// Pixels that a lane of the camera stage takes together: 1, 2 or 4.
  uint32_t pixel_packet_size = 1;
  /// With fewer samples a lane takes one: the kernel is compiled sooner and traces slower.
  uint64_t samples_that_repay_packets = 0;
  /// Pixels whose paths are traced together, bounce by bounce, at most (trace/path_stream.h): enough to fill the device
  /// at late bounces too.
  uint32_t most_stream_paths = 1U << 18;

  // Rays that are cast.
  /// How many a lane takes together where they run side by side: 1, or RayTiler::kPacketSize, for which they are put in
  /// tiles.
  uint32_t ray_packet_size = 1;
  /// Whether those that do not run side by side are sorted.
  bool sorts_rays = false;

  // Frames of a window.
  /// Frames that are in flight together: one where nothing would run beside it, and the next would only show an older
  /// camera.
  uint32_t most_frames_in_flight = 2;
  /// Present when the device has finished, as presenting would wait for it.
  bool presents_late = false;
  /// Whether a frame may be expected to be traced within the display's refresh interval.
  bool keeps_up_with_display = true;

  // Measurements.
  /// Rays in a dispatch whose speed is measured: enough to fill the device.
  uint32_t measured_rays = 1U << 20;
};

/// Pure: the same traits have the same profile, and no device is asked.
DeviceProfile make_profile(const DeviceTraits& traits);

}  // namespace promin::gpu
