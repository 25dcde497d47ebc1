// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/profile.h"

#include <gtest/gtest.h>

#include "rays/ray_tiles.h"

namespace promin::gpu {
namespace {

// Values of VkDriverId from Vulkan's registry.
constexpr uint32_t kNvidia = 4;
constexpr uint32_t kIntel = 6;
constexpr uint32_t kSwiftShader = 10;
constexpr uint32_t kLlvmpipe = 13;
constexpr uint32_t kNotInTheRegistry = 4711;

constexpr uint64_t kTexelBytes = uint64_t{1} << 31;

DeviceProfile profile_of(bool is_cpu, uint32_t driver_id, uint32_t core_count = 8, const char* driver_info = "") {
  return make_profile({.is_cpu = is_cpu,
                       .driver_id = driver_id,
                       .driver_info = driver_info,
                       .core_count = core_count,
                       .has_shader_objects = true,
                       .texel_buffer_bytes = kTexelBytes});
}

/// Expects the profile of a GPU, discrete or integrated.
void expect_gpu(const DeviceProfile& profile) {
  EXPECT_EQ(profile.most_texel_bytes, kTexelBytes);
  for (const TraversalForm& form : {profile.packet_traversal, profile.ray_traversal}) {
    EXPECT_EQ(form.steps_together, 0U);
    EXPECT_FALSE(form.waits_with_solids);
    EXPECT_FALSE(form.waits_with_holes);
  }
  EXPECT_EQ(profile.target_dispatch_ms, 25.0);
  EXPECT_EQ(profile.most_silence_s, 120.0);
  EXPECT_EQ(profile.most_group_rows, 1U);
  EXPECT_FALSE(profile.may_cut_loops);
  EXPECT_FALSE(profile.compiles_on_second_device);
  EXPECT_FALSE(profile.keeps_kernels);
  EXPECT_EQ(profile.pixel_packet_size, 1U);
  EXPECT_EQ(profile.samples_that_repay_packets, 0U);
  EXPECT_GE(profile.most_stream_paths, 1U << 17);
  EXPECT_FALSE(profile.fetches_film_texels);
  EXPECT_EQ(profile.ray_packet_size, 1U);
  EXPECT_FALSE(profile.sorts_rays);
  EXPECT_EQ(profile.most_frames_in_flight, 2U);
  EXPECT_FALSE(profile.presents_late);
  EXPECT_TRUE(profile.keeps_up_with_display);
  EXPECT_EQ(profile.measured_rays, 1U << 20);
}

/// Expects the profile of any CPU device with 8 cores, without the settings that are special to lavapipe.
void expect_cpu(const DeviceProfile& profile) {
  EXPECT_EQ(profile.most_texel_bytes, kTexelBytes);
  EXPECT_TRUE(profile.fetches_film_texels);
  EXPECT_EQ(profile.most_stream_paths, 1U << 16);
  EXPECT_EQ(profile.target_dispatch_ms, 100.0);
  EXPECT_EQ(profile.most_silence_s, 3600.0);
  EXPECT_EQ(profile.most_group_rows, 8U);
  EXPECT_TRUE(profile.sorts_rays);
  EXPECT_EQ(profile.most_frames_in_flight, 1U);
  EXPECT_TRUE(profile.presents_late);
  EXPECT_FALSE(profile.keeps_up_with_display);
  EXPECT_EQ(profile.measured_rays, 1U << 14);
}

void expect_cpu_without_packets(const DeviceProfile& profile) {
  expect_cpu(profile);
  EXPECT_FALSE(profile.may_cut_loops);
  EXPECT_FALSE(profile.compiles_on_second_device);
  EXPECT_FALSE(profile.keeps_kernels);
  EXPECT_EQ(profile.pixel_packet_size, 1U);
  EXPECT_EQ(profile.ray_packet_size, 1U);
}

TEST(ProfileTest, GpusTakePixelsAndRaysAsTheyCome) {
  expect_gpu(profile_of(false, kNvidia));
  expect_gpu(profile_of(false, kIntel));
  expect_gpu(profile_of(false, 0));
}

TEST(ProfileTest, LavapipeCompilesOnASecondDeviceIfThereIsAnotherCore) {
  EXPECT_TRUE(profile_of(true, kLlvmpipe, 2).compiles_on_second_device);
  EXPECT_FALSE(profile_of(true, kLlvmpipe, 1).compiles_on_second_device);
}

TEST(ProfileTest, LavapipeTakesPacketsAndMayCutLoops) {
  const DeviceProfile profile = profile_of(true, kLlvmpipe);
  expect_cpu(profile);
  EXPECT_TRUE(profile.may_cut_loops);
  EXPECT_EQ(profile.pixel_packet_size, 4U);
  EXPECT_EQ(profile.samples_that_repay_packets, 1U << 19);
  EXPECT_EQ(profile.ray_packet_size, RayTiler::kPacketSize);
}

TEST(ProfileTest, PacketsOfNewerLavapipesLookIntoLeavesAfterEachStep) {
  for (const char* older : {"", "Mesa", "Mesa 22.3.6 (LLVM 15.0.6)", "Mesa 24.3.4", "LLVM 25.0.0"}) {
    const DeviceProfile profile = profile_of(true, kLlvmpipe, 8, older);
    EXPECT_EQ(profile.packet_traversal.steps_together, 0U);
    EXPECT_EQ(profile.ray_traversal.steps_together, 2U);
    EXPECT_TRUE(profile.packet_traversal.waits_with_holes);
    EXPECT_TRUE(profile.ray_traversal.waits_with_holes);
  }
  for (const char* newer : {"Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)", "Mesa 25.1.0-devel", "Mesa 101.0"}) {
    const DeviceProfile profile = profile_of(true, kLlvmpipe, 8, newer);
    EXPECT_EQ(profile.packet_traversal.steps_together, 1U);
    EXPECT_EQ(profile.ray_traversal.steps_together, 2U);
    for (const TraversalForm& form : {profile.packet_traversal, profile.ray_traversal}) {
      EXPECT_TRUE(form.waits_with_solids);
      EXPECT_FALSE(form.waits_with_holes);
    }
    EXPECT_EQ(profile.pixel_packet_size, 4U);
  }
  EXPECT_EQ(profile_of(true, kSwiftShader, 8, "Mesa 25.0.7").ray_traversal.steps_together, 0U);
  expect_gpu(profile_of(false, kNvidia, 8, "550.163.01"));
}

TEST(ProfileTest, KernelsOfNewerLavapipesAreKeptIfTheyCanBe) {
  DeviceTraits traits{.is_cpu = true, .driver_id = kLlvmpipe, .driver_info = "Mesa 25.0.7", .has_shader_objects = true};
  EXPECT_TRUE(make_profile(traits).keeps_kernels);
  traits.has_shader_objects = false;
  EXPECT_FALSE(make_profile(traits).keeps_kernels);
  EXPECT_FALSE(profile_of(true, kLlvmpipe, 8, "Mesa 22.3.6 (LLVM 15.0.6)").keeps_kernels);
}

TEST(ProfileTest, OtherCpuDevicesTakeNoPackets) {
  expect_cpu_without_packets(profile_of(true, kSwiftShader));
  expect_cpu_without_packets(profile_of(true, kNotInTheRegistry));
  expect_cpu_without_packets(profile_of(true, 0));
}

TEST(ProfileTest, ThereAreAsManyRowsOfGroupsAsTheDriverHasThreads) {
  EXPECT_EQ(profile_of(true, kLlvmpipe, 1).most_group_rows, 1U);
  EXPECT_EQ(profile_of(true, kLlvmpipe, 64).most_group_rows, 32U);
  EXPECT_EQ(profile_of(false, kNvidia, 64).most_group_rows, 1U);
}

TEST(ProfileTest, DevicesWithoutTexelBuffersReadStorageBuffers) {
  EXPECT_EQ(make_profile({.is_cpu = true, .driver_id = kLlvmpipe}).most_texel_bytes, 0U);
}

}  // namespace
}  // namespace promin::gpu
