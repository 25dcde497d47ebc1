// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/pipeline.h"

#include <gtest/gtest.h>

#include <numeric>
#include <tuple>
#include <vector>

#include "branches.spv.h"
#include "device/branches.h"
#include "device/buffer.h"
#include "device/device.h"
#include "gpu/device_fixture.h"
#include "support/read_spirv.h"

namespace promin::gpu {
namespace {

class PipelineTest : public test::DeviceTest {
 protected:
  /// Returns the numbers that branches.comp computes from 0, 1, 2, …
  std::vector<uint32_t> run(std::span<const uint32_t> branches, const test::BranchConstants& constants) {
    std::vector<uint32_t> numbers(500);
    std::iota(numbers.begin(), numbers.end(), 0U);
    Buffer buffer(device(), numbers.size() * sizeof(uint32_t), vk::BufferUsageFlagBits::eStorageBuffer);
    buffer.write(std::as_bytes(std::span(numbers)));
    const BoundBuffer bound{.binding = 0, .buffer = &buffer};
    const ComputePipeline pipeline(device(), branches, constants.list(), {&bound, 1});
    device().run([&](const vk::raii::CommandBuffer& commands) {
      pipeline.dispatch(commands, uvec2(static_cast<uint32_t>(numbers.size()), 1));
      const vk::MemoryBarrier after(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
      commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {}, after,
                               {}, {});
    });
    buffer.read(std::as_writable_bytes(std::span(numbers)));
    return numbers;
  }
};

// Pipelines are compiled from the code that is live with the values of the constants.
TEST_F(PipelineTest, ComputesTheSameWithoutItsDeadCode) {
  const std::vector<uint32_t> with_calls = read_spirv(PROMIN_BRANCHES_SPIRV);
  const std::vector<uint32_t> with_phis = read_spirv(PROMIN_BRANCHES_WITH_PHIS);
  for (const test::BranchConstants& constants : test::all_branch_constants()) {
    SCOPED_TRACE(testing::PrintToString(std::tuple(constants.first, constants.second, constants.third)));
    std::vector<uint32_t> expected(500);
    for (uint32_t i = 0; i < expected.size(); ++i) expected[i] = test::Branches(constants).compute(i);
    EXPECT_EQ(run(k_branches_spirv, constants), expected);
    EXPECT_EQ(run(with_calls, constants), expected);
    EXPECT_EQ(run(with_phis, constants), expected);
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
