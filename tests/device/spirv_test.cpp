// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/spirv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>
#include <tuple>

#include "branches.spv.h"
#include "camera_stage.spv.h"
#include "cast.spv.h"
#include "core/file.h"
#include "crossings.spv.h"
#include "device/branches.h"
#include "follow_paths.spv.h"
#include "gpu/spirv_module.h"
#include "list_rays.spv.h"
#include "place_rays.spv.h"
#include "shared/layout.h"
#include "support/process.h"
#include "support/read_spirv.h"
#include "support/thorough.h"
#include "trace_shadow_rays.spv.h"

namespace promin::gpu {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Not;

/// Returns the faults that spirv-val finds in a module; empty if there are none.
std::string find_faults(std::span<const uint32_t> spirv) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("promin_spirv_test_" + std::to_string(getpid()) + ".spv");
  write_file(file, {std::as_bytes(spirv)});
  Process validator(PROMIN_SPIRV_VAL, {"--target-env", "vulkan1.1", file.string()}, {});
  const ProcessResult result = validator.wait();
  std::filesystem::remove(file);
  return result.exit_code == 0 ? "" : "spirv-val: " + result.out + result.err;
}

std::set<std::string> functions_left(std::span<const uint32_t> spirv,
                                     const std::vector<SpecializationConstant>& constants) {
  return test::SpirvModule(specialize(spirv, constants)).functions;
}

/// branches.comp as glslang writes it. k_branches_spirv has most functions inlined.
std::vector<uint32_t> branches_with_calls() {
  return read_spirv(PROMIN_BRANCHES_SPIRV);
}

TEST(SpecializeTest, WhatIsLeftIsValid) {
  for (const test::BranchConstants& constants : test::all_branch_constants()) {
    SCOPED_TRACE(testing::PrintToString(std::tuple(constants.first, constants.second, constants.third)));
    EXPECT_EQ(find_faults(specialize(k_branches_spirv, constants.list())), "");
    EXPECT_EQ(find_faults(specialize(branches_with_calls(), constants.list())), "");
    EXPECT_EQ(find_faults(specialize(read_spirv(PROMIN_BRANCHES_WITH_PHIS), constants.list())), "");
  }
}

TEST(SpecializeTest, FunctionsThatAreCalledNowhereGo) {
  EXPECT_THAT(functions_left(branches_with_calls(), test::BranchConstants{.first = 1, .second = 1}.list()),
              AllOf(Contains("with_first"), Contains("with_second"), Not(Contains("without_first"))));
  EXPECT_THAT(
      functions_left(branches_with_calls(), test::BranchConstants{.first = 0, .second = 0}.list()),
      AllOf(Contains("without_first"), Contains("is_odd"), Not(Contains("with_first")), Not(Contains("with_second"))));
}

TEST(SpecializeTest, ConstantsThatAreNotGivenHaveTheirDefaults) {
  EXPECT_EQ(specialize(k_branches_spirv, {}), specialize(k_branches_spirv, test::BranchConstants().list()));
}

TEST(SpecializeTest, WhatIsNoModuleIsRefused) {
  // The module is cut within its second instruction.
  EXPECT_THROW(specialize(std::span(k_branches_spirv).first(9), {}), std::logic_error);
  EXPECT_THROW(specialize(std::vector<uint32_t>(4), {}), std::logic_error);
  EXPECT_THROW(specialize(std::vector<uint32_t>(40), {}), std::logic_error);
}

struct Kernel {
  const char* name;
  std::span<const uint32_t> spirv;
  /// At least this many modules remain different after specialisation by masks of features; a usual run tries half as
  /// many.
  size_t least_module_count = 20;
};
const Kernel kKernels[] = {{"Cast", k_cast_spirv},
                           // This kernel depends only on the kinds of primitives and on open shapes. Each kind is
                           // present or absent.
                           {"Crossings", k_crossings_spirv, 16},
                           {"CameraStage", k_camera_stage_spirv},
                           {"FollowPaths", k_follow_paths_spirv},
                           {"TraceShadowRays", k_trace_shadow_rays_spirv}};

std::vector<SpecializationConstant> constants_of(uint64_t features, uint32_t packet_size, uint32_t any) {
  return {{layout::CONSTANT_FEATURES, static_cast<uint32_t>(features)},
          {layout::CONSTANT_MORE_FEATURES, static_cast<uint32_t>(features >> 32)},
          {layout::CONSTANT_PACKET_SIZE, packet_size},
          {layout::CONSTANT_ALL_ASK_FOR_ANY, any},
          {layout::CONSTANT_STEPS_TOGETHER, any},
          {layout::CONSTANT_WAITS_WITH_SOLIDS, any},
          {layout::CONSTANT_WAITS_WITH_HOLES, any},
          // Only one of the kernels has this constant.
          {layout::CONSTANT_LISTS_CROSSINGS, packet_size > 1 ? 1U : 0U}};
}

class KernelTest : public testing::TestWithParam<Kernel> {};

// Scenes whose lights have no size, and cameras without a lens, do not pay for sample points: no kernel has a constant
// of their hash.
TEST(KernelsTest, OnlyFeaturesWithSamplePointsHaveTheirHash) {
  constexpr uint32_t kOfHash = 0xB82F1E52;
  constexpr uint64_t kSamples = uint64_t{1} << 55 | uint64_t{1} << 39 | uint64_t{7} << 27 | uint64_t{1} << 24;
  static_assert(static_cast<uint32_t>(layout::FEATURE_SAMPLED_LIGHT) == 55);
  static_assert(static_cast<uint32_t>(layout::FEATURE_LENS) == 39);
  static_assert(static_cast<uint32_t>(layout::FEATURE_EMITTERS) == 27);
  static_assert(static_cast<uint32_t>(layout::FEATURE_CHOSEN_LIGHTS) == 28);
  static_assert(static_cast<uint32_t>(layout::FEATURE_SCATTERING) == 29);
  static_assert(static_cast<uint32_t>(layout::FEATURE_SKY_LIGHT) == 24);
  const auto has_hash = [&](std::span<const uint32_t> spirv, uint64_t mask) {
    const std::vector<uint32_t> module = specialize(spirv, constants_of(mask, 1, 0));
    return std::ranges::count(module, kOfHash) > 0;
  };
  for (const auto& spirv :
       {std::span<const uint32_t>(k_camera_stage_spirv), std::span<const uint32_t>(k_follow_paths_spirv)}) {
    EXPECT_TRUE(has_hash(spirv, ~uint64_t{0}));
    EXPECT_FALSE(has_hash(spirv, ~kSamples));
  }
  EXPECT_FALSE(has_hash(k_trace_shadow_rays_spirv, ~uint64_t{0}));
}

// A kernel for Integrator::kWhitted has nothing of the choice of directions to the sky: not the bits of 4.25.
TEST(KernelsTest, OnlySkiesWithShadowsChooseDirections) {
  constexpr uint32_t kOfChoice = 0x40880000;
  for (const auto& spirv :
       {std::span<const uint32_t>(k_camera_stage_spirv), std::span<const uint32_t>(k_follow_paths_spirv)}) {
    EXPECT_GT(std::ranges::count(specialize(spirv, constants_of(~uint64_t{0}, 1, 0)), kOfChoice), 0);
    EXPECT_EQ(std::ranges::count(specialize(spirv, constants_of(~(uint64_t{1} << 24), 1, 0)), kOfChoice), 0);
  }
}

// Variables of code that is never reached are not left in a module.
TEST(KernelsTest, VariablesWithoutUseAreLeftOut) {
  const std::vector<uint32_t> module = specialize(k_camera_stage_spirv, constants_of(1, 1, 0));
  size_t variables = 0;
  size_t in_functions = 0;
  for (size_t i = 5; i < module.size(); i += module[i] >> 16) {
    if ((module[i] & 0xFFFFU) != 59U || module[i + 3] != 7U) continue;
    ++variables;
    in_functions += static_cast<size_t>(std::ranges::count(module, module[i + 2])) > 1 ? 1 : 0;
  }
  EXPECT_GT(variables, 0U);
  EXPECT_EQ(in_functions, variables);
}

TEST_P(KernelTest, WhatIsLeftIsValidWithEachFeature) {
  std::set<std::vector<uint32_t>> modules;
  const auto add = [&](uint64_t mask, uint32_t packet_size, uint32_t any) {
    modules.insert(specialize(GetParam().spirv, constants_of(mask, packet_size, any)));
  };
  add(0, 1, 0);
  add(~uint64_t{0}, 8, 0);
  for (uint32_t bit = 0; bit < 64; ++bit) {
    const uint64_t feature = uint64_t{1} << bit;
    add(feature, bit % 4 < 2 ? 1 : 8, bit % 2);
    // Masks without one feature are many modules to validate, so only thorough tests use them.
    if (test::is_thorough()) add(~feature, bit % 4 < 2 ? 8 : 1, bit % 2);
  }
  EXPECT_GE(modules.size(), test::is_thorough() ? GetParam().least_module_count : GetParam().least_module_count / 2);
  for (const std::vector<uint32_t>& module : modules) EXPECT_EQ(find_faults(module), "");
}

// A kernel contains only the code for the shapes of its scene.
TEST_P(KernelTest, EachKindOfPrimitiveAddsCode) {
#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) uint64_t{1} << (BIT),
  const std::vector<uint64_t> kinds = {
#include "promin/kinds/primitives.def"
  };
  uint64_t all = 0;
  for (const uint64_t kind : kinds) all |= kind;
  const size_t most = specialize(GetParam().spirv, constants_of(all, 1, 0)).size();
  for (const uint64_t kind : kinds) {
    EXPECT_LT(specialize(GetParam().spirv, constants_of(all & ~kind, 1, 0)).size(), most) << kind;
    EXPECT_LT(specialize(GetParam().spirv, constants_of(kind, 1, 0)).size(), most * 3 / 4) << kind;
  }
}

// If a caller requests one more feature, only the kernels that depend on this feature are compiled.
TEST(SpecializeTest, UsesOfOneSceneShareTheKernelsThatDoNotDiffer) {
  // These are the features of a scene like scenes/showcase.gltf.
  constexpr uint64_t kScene = 0xE3FFF;
  std::vector<uint64_t> masks = {kScene};
#define PROMIN_FEATURE(NAME, BIT, LABEL)
#define PROMIN_REQUEST(NAME, BIT, LABEL) masks.push_back(kScene | uint64_t{1} << (BIT));
#include "shared/features.def"
  for (uint64_t debug_view = 1; debug_view <= layout::DEBUG_VIEW_OCCLUSION; ++debug_view) {
    masks.push_back(kScene | debug_view << (32 + layout::DEBUG_VIEW_SHIFT));
  }
  ASSERT_EQ(masks.size(), 22U);
  const auto count_kernels = [&](std::span<const uint32_t> spirv) {
    std::set<std::vector<uint32_t>> kernels;
    for (const uint64_t mask : masks) kernels.insert(specialize(spirv, constants_of(mask, 1, 0)));
    return kernels.size();
  };
  EXPECT_EQ(count_kernels(k_camera_stage_spirv), 19U);
  EXPECT_EQ(count_kernels(k_follow_paths_spirv), 9U);
  EXPECT_EQ(count_kernels(k_trace_shadow_rays_spirv), 4U);
  // Scattered paths have records of their own.
  EXPECT_EQ(count_kernels(k_list_rays_spirv), 2U);
  EXPECT_EQ(count_kernels(k_place_rays_spirv), 2U);
}

INSTANTIATE_TEST_SUITE_P(Shaders, KernelTest, testing::ValuesIn(kKernels),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace promin::gpu
