// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>

#include "gpu/spirv_module.h"
#include "render.spv.h"

namespace promin {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

struct Layout {
  const char* name;
  std::vector<uint32_t> offsets;
};

#define OFFSET(STRUCT, MEMBER) static_cast<uint32_t>(offsetof(layout::STRUCT, MEMBER))

const Layout kLayouts[] = {
    {"Node", {OFFSET(Node, x), OFFSET(Node, y), OFFSET(Node, z), OFFSET(Node, children)}},
    {"Primitive", {OFFSET(Primitive, a), OFFSET(Primitive, b), OFFSET(Primitive, c)}},
    {"SurfaceRecord", {OFFSET(SurfaceRecord, corners_material)}},
    {"MaterialRecord",
     {OFFSET(MaterialRecord, ambient), OFFSET(MaterialRecord, diffuse), OFFSET(MaterialRecord, specular),
      OFFSET(MaterialRecord, reflection), OFFSET(MaterialRecord, emissive)}},
    {"LightRecord",
     {OFFSET(LightRecord, position), OFFSET(LightRecord, direction), OFFSET(LightRecord, diffuse),
      OFFSET(LightRecord, specular), OFFSET(LightRecord, kind)}},
    {"Frame",
     {OFFSET(Frame, eye), OFFSET(Frame, look), OFFSET(Frame, right), OFFSET(Frame, up), OFFSET(Frame, ambient),
      OFFSET(Frame, background), OFFSET(Frame, tree_bounds), OFFSET(Frame, film_center), OFFSET(Frame, first_index)}},
    {"Dispatch",
     {OFFSET(Dispatch, range), OFFSET(Dispatch, window), OFFSET(Dispatch, sampling), OFFSET(Dispatch, counts)}},
};

class LayoutTest : public testing::TestWithParam<Layout> {};

TEST_P(LayoutTest, HostOffsetsAreTheShaders) {
  const test::SpirvModule module(k_render_spirv);
  const auto variants = module.offsets_of(GetParam().name);
  ASSERT_THAT(variants, Not(IsEmpty())) << "the shader does not use " << GetParam().name;
  EXPECT_THAT(variants, Each(GetParam().offsets));
}

INSTANTIATE_TEST_SUITE_P(Structs, LayoutTest, testing::ValuesIn(kLayouts),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SpirvTest, SpecialisationConstantsAreThoseOfTheLayout) {
  const test::SpirvModule module(k_render_spirv);
  EXPECT_THAT(module.spec_ids, ElementsAre(testing::Pair("FEATURES", layout::CONSTANT_FEATURES),
                                           testing::Pair("STACK_SIZE", layout::CONSTANT_STACK_SIZE)));
}

// A driver may contract and reassociate what is not `precise`: bits and watertightness would depend on its taste.
TEST(SpirvTest, EveryFloatOperationIsPrecise) {
  const test::SpirvModule module(k_render_spirv);
  EXPECT_GT(module.float_operation_count, 200U);
  EXPECT_THAT(module.contractible, IsEmpty());
}

TEST(SpirvTest, NoMoreStorageBuffersThanVulkanGuarantees) {
  EXPECT_LE(test::SpirvModule(k_render_spirv).storage_bindings.size(), 4U);
}

}  // namespace
}  // namespace promin
