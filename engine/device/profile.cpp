// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/profile.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/parse_number.h"

namespace promin::gpu {
namespace {

/// Changes the profile for every CPU device, whether its driver is known or not.
void suit_cpu(DeviceProfile& profile, const DeviceTraits& traits) {
  // Number of threads of Mesa's CPU driver unless the environment sets another number (LP_MAX_THREADS).
  constexpr uint32_t kMostThreads = 32;
  profile.fetches_film_texels = true;
  profile.target_dispatch_ms = 100.0;
  // The driver compiles kernels at their first dispatch, which may take minutes if other processes use the cores. A
  // dispatch cannot be interrupted: the driver's threads would continue with freed memory.
  profile.most_silence_s = 3600.0;
  profile.most_group_rows = std::min(traits.core_count, kMostThreads);
  // Fewer paths need more dispatches, and more paths do not fit into the caches (docs/performance_log.md).
  profile.most_stream_paths = 1U << 16;
  profile.sorts_rays = true;
  profile.most_frames_in_flight = 1;
  profile.presents_late = true;
  profile.keeps_up_with_display = false;
  profile.measured_rays = 1U << 14;
}

/// Sets packets of 4 rays. Packets of 1, 2, 3, 4, 6 and 8 rays and of 2, 4 and 8 pixels were measured on two versions
/// of Mesa, and no other size was faster on both (docs/performance_log.md).
void suit_lavapipe(DeviceProfile& profile, const DeviceTraits& traits) {
  profile.compiles_on_second_device = traits.core_count > 1;
  profile.pixel_packet_size = 4;
  // If a machine compiles the showcase for packets for the first time, this takes 0.9 s longer with Mesa 22.3.6 and 2.6
  // s longer with 25.0.7. Without packets, each sample takes 0.1 and 0.24 µs longer (docs/performance_log.md). This
  // number of samples costs at most a tenth of a second if the driver's cache has both kernels, and saves seconds if it
  // has neither.
  profile.samples_that_repay_packets = 1U << 19;
  profile.ray_packet_size = 4;
  profile.may_cut_loops = true;
  profile.ray_traversal = {.steps_together = 2, .waits_with_solids = true, .waits_with_holes = true};
  profile.packet_traversal.waits_with_holes = true;
}

/// Lets packets test their leaves after each step. With this, pictures take 0.78 to 0.94 of the time with lavapipe
/// 25.0.7, and 0.96 to 1.4 of the time with 22.3.6 (docs/performance_log.md). The versions in between were not
/// measured. The driver's own cache has only machine code: without binaries, each process translates SPIR-V to Mesa's
/// NIR again, which takes a quarter to two thirds of the CPU time of small pictures (docs/performance_log.md).
void suit_newer_lavapipe(DeviceProfile& profile, const DeviceTraits& traits) {
  profile.packet_traversal = {.steps_together = 1, .waits_with_solids = true};
  // These versions jump over lookups that no lane needs.
  profile.ray_traversal.waits_with_holes = false;
  profile.keeps_kernels = traits.has_shader_objects;
}

/// Returns the first number of Mesa's version in a driver's description; 0 for other drivers. Lavapipe's driverVersion
/// is 1 whatever its version.
uint32_t mesa_version(std::string_view driver_info) {
  constexpr std::string_view kName = "Mesa ";
  if (!driver_info.starts_with(kName)) return 0;
  driver_info.remove_prefix(kName.size());
  return take_number<uint32_t>(driver_info).value_or(0);
}

/// Changes of the profile for a driver, from a version of Mesa on.
struct DriverRow {
  VkDriverId driver;
  uint32_t first_mesa_version;
  void (*suit)(DeviceProfile&, const DeviceTraits&);
};

/// The table of drivers; no other code depends on the driver. A form of traversal that suits a driver or its processor
/// is chosen here too: with a field of DeviceProfile, a field of DeviceTraits if needed, and a row of this table.
/// SwiftShader has no row: it is treated like any CPU device.
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
