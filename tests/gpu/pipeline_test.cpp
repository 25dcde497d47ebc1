// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <numeric>
#include <tuple>
#include <vector>

#include "branches.spv.h"
#include "core/file.h"
#include "device/branches.h"
#include "device/buffer.h"
#include "device/device.h"
#include "gpu/device_fixture.h"
#include "support/read_spirv.h"
#include "support/temp_folder.h"

namespace promin::gpu {
namespace {

/// Returns the numbers that branches.comp computes from 0, 1, 2, …
std::vector<uint32_t> run_branches(const Device& device, std::span<const uint32_t> branches,
                                   const test::BranchConstants& constants) {
  std::vector<uint32_t> numbers(500);
  std::iota(numbers.begin(), numbers.end(), 0U);
  Buffer buffer(device, numbers.size() * sizeof(uint32_t), vk::BufferUsageFlagBits::eStorageBuffer);
  buffer.write(std::as_bytes(std::span(numbers)));
  const BoundBuffer bound{.binding = 0, .buffer = &buffer};
  const ComputePipeline pipeline(device, branches, constants.list(), {&bound, 1});
  device.run([&](const vk::raii::CommandBuffer& commands) {
    pipeline.dispatch(commands, uvec2(static_cast<uint32_t>(numbers.size()), 1));
    const vk::MemoryBarrier after(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {}, after, {},
                             {});
  });
  buffer.read(std::as_writable_bytes(std::span(numbers)));
  return numbers;
}

std::vector<uint32_t> expected_numbers(const test::BranchConstants& constants) {
  std::vector<uint32_t> numbers(500);
  for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = test::Branches(constants).compute(i);
  return numbers;
}

using PipelineTest = test::DeviceTest;

// Pipelines are compiled from the code that is live with the values of the constants.
TEST_F(PipelineTest, ComputesTheSameWithoutItsDeadCode) {
  const std::vector<uint32_t> with_calls = read_spirv(PROMIN_BRANCHES_SPIRV);
  const std::vector<uint32_t> with_phis = read_spirv(PROMIN_BRANCHES_WITH_PHIS);
  for (const test::BranchConstants& constants : test::all_branch_constants()) {
    SCOPED_TRACE(testing::PrintToString(std::tuple(constants.first, constants.second, constants.third)));
    const std::vector<uint32_t> expected = expected_numbers(constants);
    EXPECT_EQ(run_branches(device(), k_branches_spirv, constants), expected);
    EXPECT_EQ(run_branches(device(), with_calls, constants), expected);
    EXPECT_EQ(run_branches(device(), with_phis, constants), expected);
  }
}

TEST_F(PipelineTest, AConstantThatTheShaderLacksIsRefused) {
  Buffer buffer(device(), 16, vk::BufferUsageFlagBits::eStorageBuffer);
  const BoundBuffer bound{.binding = 0, .buffer = &buffer};
  const SpecializationConstant unknown{.id = 77, .value = 1};
  EXPECT_THROW(ComputePipeline(device(), k_branches_spirv, {&unknown, 1}, {&bound, 1}), std::logic_error);
}

/// Each test opens devices that share a folder of compiled kernels.
class KeptKernelsTest : public TempFolder {
 protected:
  void SetUp() override {
    if (shader_object_extensions().empty()) GTEST_SKIP() << "Vulkan's headers do not have VK_EXT_shader_object";
    if (!open_device()->profile().keeps_kernels) GTEST_SKIP() << "kernels of this driver are not kept";
  }

  /// Runs the kernel on a new device.
  static KernelStats run_with(const std::optional<std::filesystem::path>& folder) {
    const DeviceHandle device = open_device(DeviceOptions{.kernel_folder = folder});
    const test::BranchConstants constants = test::all_branch_constants().front();
    EXPECT_EQ(run_branches(*device, k_branches_spirv, constants), expected_numbers(constants));
    EXPECT_EQ(validation_message_count(*device), 0U);
    return kernel_stats_of(*device);
  }
  void expect_compiled(const KernelStats& stats) const {
    EXPECT_EQ(stats.compiled, 1U);
    EXPECT_EQ(stats.read, 0U);
    EXPECT_EQ(stats.folder, folder_);
    EXPECT_TRUE(stats.notes.empty()) << stats.notes.front();
  }
  void expect_read(const KernelStats& stats) const {
    EXPECT_EQ(stats.compiled, 0U);
    EXPECT_EQ(stats.read, 1U);
    EXPECT_EQ(stats.folder, folder_);
    EXPECT_TRUE(stats.notes.empty()) << stats.notes.front();
  }
  std::filesystem::path file() const { return std::filesystem::directory_iterator(folder_)->path(); }
};

TEST_F(KeptKernelsTest, AreCompiledOnce) {
  expect_compiled(run_with(folder_));
  expect_read(run_with(folder_));
  std::filesystem::resize_file(file(), 1000);
  expect_compiled(run_with(folder_));
  expect_read(run_with(folder_));
}

// A driver may refuse a binary although the key says that it fits.
TEST_F(KeptKernelsTest, AreCompiledIfTheDriverRefusesTheirBinary) {
  expect_compiled(run_with(folder_));
  // The key begins after the head's four words of 8 bytes. The third one is the key's size in bytes.
  const std::vector<std::byte> bytes = read_file(file());
  std::vector<uint32_t> key(reinterpret_cast<const uint64_t*>(bytes.data())[2] / sizeof(uint32_t));
  std::memcpy(key.data(), bytes.data() + 4 * sizeof(uint64_t), key.size() * sizeof(uint32_t));
  const KernelFolder folder(folder_);
  ASSERT_FALSE(folder.find(key).empty());
  for (const size_t size : {1, 100, 10'000}) {
    folder.store(key, std::vector<std::byte>(size, std::byte{1}));
    expect_compiled(run_with(folder_));
    expect_read(run_with(folder_));
  }
}

TEST_F(KeptKernelsTest, AreNotKeptWithoutAFolder) {
  for (int i = 0; i < 2; ++i) {
    const KernelStats stats = run_with(std::nullopt);
    EXPECT_EQ(stats.compiled, 1U);
    EXPECT_EQ(stats.read, 0U);
    EXPECT_TRUE(stats.folder.empty());
    EXPECT_TRUE(stats.notes.empty());
  }
}

TEST_F(KeptKernelsTest, AnUnusableFolderIsNoted) {
  const KernelStats stats = run_with("/proc/promin");
  EXPECT_EQ(stats.compiled, 1U);
  EXPECT_THAT(stats.notes, testing::ElementsAre(testing::HasSubstr("/proc/promin cannot be created (")));
}

}  // namespace
}  // namespace promin::gpu
