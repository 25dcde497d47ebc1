// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/pipeline.h"

#include <gtest/gtest.h>

#include <numeric>

#include "branches.spv.h"
#include "device/branches.h"
#include "device/buffer.h"
#include "device/device.h"
#include "gpu/device_fixture.h"

namespace promin::gpu {
namespace {

class PipelineTest : public test::DeviceTest {};

// A pipeline is compiled from the part of a shader that is left once its constants are known.
TEST_F(PipelineTest, ComputesTheSameWithoutItsDeadCode) {
  std::vector<uint32_t> numbers(500);
  for (const test::BranchConstants& constants : test::all_branch_constants()) {
    std::iota(numbers.begin(), numbers.end(), 0U);
    Buffer buffer(device(), numbers.size() * sizeof(uint32_t), vk::BufferUsageFlagBits::eStorageBuffer);
    buffer.write(std::as_bytes(std::span(numbers)));
    const BoundBuffer bound{.binding = 0, .buffer = &buffer};
    const ComputePipeline pipeline(device(), k_branches_spirv, constants.list(), {&bound, 1});
    device().run([&](const vk::raii::CommandBuffer& commands) {
      pipeline.dispatch(commands, uvec2(static_cast<uint32_t>(numbers.size()), 1));
      const vk::MemoryBarrier after(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
      commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {}, after,
                               {}, {});
    });
    buffer.read(std::as_writable_bytes(std::span(numbers)));
    const test::Branches branches(constants);
    for (uint32_t i = 0; i < numbers.size(); ++i) {
      ASSERT_EQ(numbers[i], branches.compute(i))
          << i << " with " << constants.first << ' ' << constants.second << ' ' << constants.third;
    }
  }
}

TEST_F(PipelineTest, AConstantThatTheShaderLacksIsRefused) {
  Buffer buffer(device(), 16, vk::BufferUsageFlagBits::eStorageBuffer);
  const BoundBuffer bound{.binding = 0, .buffer = &buffer};
  const SpecializationConstant unknown{.id = 77, .value = 1};
  EXPECT_THROW(ComputePipeline(device(), k_branches_spirv, {&unknown, 1}, {&bound, 1}), std::logic_error);
}

}  // namespace
}  // namespace promin::gpu
