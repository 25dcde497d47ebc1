// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/profile.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace promin::gpu {
namespace {

/// The differences for every CPU device, whether its driver is known or not.
void suit_cpu(DeviceProfile& profile, const DeviceTraits& traits) {
  // Threads that Mesa's CPU driver has unless it is told otherwise (LP_MAX_THREADS).
  constexpr uint32_t kMostThreads = 32;
  profile.fetches_film_texels = true;
  profile.target_dispatch_ms = 100.0;
  // It compiles kernels at their first dispatch, which may take minutes if other processes use the cores. Nothing can
  // interrupt it: its threads would continue with freed memory.
  profile.most_silence_s = 3600.0;
  profile.most_group_rows = std::min(traits.core_count, kMostThreads);
  // Fewer paths make more dispatches, more do not fit in the caches (docs/performance_log.md).
  profile.most_stream_paths = 1U << 16;
  profile.sorts_rays = true;
  profile.most_frames_in_flight = 1;
  profile.presents_late = true;
  profile.keeps_up_with_display = false;
  profile.measured_rays = 1U << 14;
}

/// Packets of 4: of 1, 2, 3, 4, 6 and 8 rays and of 2, 4 and 8 pixels no other number was faster on both versions of
/// Mesa that were measured (docs/performance_log.md).
void suit_lavapipe(DeviceProfile& profile, const DeviceTraits& /*traits*/) {
  profile.pixel_packet_size = 4;
  // Compiling the showcase for packets takes 0.9 s longer with 22.3.6 and 2.6 s with 25.0.7, once on a machine; tracing
  // it by single pixels takes 0.1 and 0.24 µs longer a sample, always (docs/performance_log.md). So many samples cost a
  // tenth of a second at most where the driver's cache has either kernel, and save seconds where it has none.
  profile.samples_that_repay_packets = 1U << 19;
  profile.ray_packet_size = 4;
  profile.may_cut_loops = true;
  profile.ray_traversal = {.steps_together = 2, .waits_with_solids = true};
}

/// Packets look into their leaves after each step: pictures take 0.78 to 0.94 of the time with lavapipe 25.0.7, where
/// 22.3.6 takes 0.96 to 1.4 (docs/performance_log.md). Versions between were not measured.
void suit_newer_lavapipe(DeviceProfile& profile, const DeviceTraits& /*traits*/) {
  profile.packet_traversal = {.steps_together = 1, .waits_with_solids = true};
}

/// Returns the first number of Mesa's version in a driver's description; 0 for other drivers. Lavapipe's driverVersion
/// is 1 whatever its version.
uint32_t mesa_version(std::string_view driver_info) {
  constexpr std::string_view kName = "Mesa ";
  uint32_t version = 0;
  if (driver_info.starts_with(kName)) {
    driver_info.remove_prefix(kName.size());
    std::from_chars(driver_info.data(), driver_info.data() + driver_info.size(), version);
  }
  return version;
}

/// The differences for a driver from a version of Mesa on.
struct DriverRow {
  VkDriverId driver;
  uint32_t first_mesa_version;
  void (*suit)(DeviceProfile&, const DeviceTraits&);
};

/// The one place that knows drivers. Forms of traversal that suit a driver, or a processor under it, are chosen here
/// too: a field of DeviceProfile, where need be one of DeviceTraits, and a row. SwiftShader has none: it is
/// treated as any CPU device.
constexpr std::array kDrivers{DriverRow{VK_DRIVER_ID_MESA_LLVMPIPE, 0, suit_lavapipe},
                              DriverRow{VK_DRIVER_ID_MESA_LLVMPIPE, 25, suit_newer_lavapipe}};

}  // namespace

DeviceProfile make_profile(const DeviceTraits& traits) {
  DeviceProfile profile;
  profile.most_texel_bytes = traits.texel_buffer_bytes;
  if (traits.is_cpu) suit_cpu(profile, traits);
  const uint32_t mesa = mesa_version(traits.driver_info);
  for (const DriverRow& row : kDrivers) {
    const bool is_it = static_cast<uint32_t>(row.driver) == traits.driver_id && mesa >= row.first_mesa_version;
    if (is_it) row.suit(profile, traits);
  }
  return profile;
}

}  // namespace promin::gpu
