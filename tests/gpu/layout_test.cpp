// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "shared/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "camera_stage.spv.h"
#include "cast.spv.h"
#include "crossings.spv.h"
#include "device/spirv.h"
#include "follow_paths.spv.h"
#include "gpu/spirv_module.h"
#include "list_rays.spv.h"
#include "place_rays.spv.h"
#include "support/read_spirv.h"
#include "trace_shadow_rays.spv.h"

namespace promin {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;
using testing::Not;

struct Layout {
  const char* name;
  std::vector<uint32_t> offsets;
};

#define OFFSET(STRUCT, MEMBER) static_cast<uint32_t>(offsetof(layout::STRUCT, MEMBER))

const Layout kLayouts[] = {
    {"Node", {OFFSET(Node, frame), OFFSET(Node, lo), OFFSET(Node, hi), OFFSET(Node, children)}},
    {"Primitive", {OFFSET(Primitive, a), OFFSET(Primitive, b), OFFSET(Primitive, c)}},
    {"SurfaceRecord", {OFFSET(SurfaceRecord, corners_material)}},
    {"MaterialRecord",
     {OFFSET(MaterialRecord, a), OFFSET(MaterialRecord, b), OFFSET(MaterialRecord, c), OFFSET(MaterialRecord, d),
      OFFSET(MaterialRecord, cover), OFFSET(MaterialRecord, emissive)}},
    {"ExtensionRecord",
     {OFFSET(ExtensionRecord, coat), OFFSET(ExtensionRecord, coat_slots), OFFSET(ExtensionRecord, sheen),
      OFFSET(ExtensionRecord, reflectance), OFFSET(ExtensionRecord, slots), OFFSET(ExtensionRecord, scattering),
      OFFSET(ExtensionRecord, thin_film), OFFSET(ExtensionRecord, anisotropy), OFFSET(ExtensionRecord, rare_slots),
      OFFSET(ExtensionRecord, anisotropy_slot)}},
    {"GlassRecord",
     {OFFSET(GlassRecord, transmission), OFFSET(GlassRecord, absorption), OFFSET(GlassRecord, reflectance),
      OFFSET(GlassRecord, bits)}},
    {"TextureSlotRecord",
     {OFFSET(TextureSlotRecord, to_u), OFFSET(TextureSlotRecord, to_v), OFFSET(TextureSlotRecord, image)}},
    {"LightRecord",
     {OFFSET(LightRecord, position), OFFSET(LightRecord, direction), OFFSET(LightRecord, diffuse),
      OFFSET(LightRecord, specular), OFFSET(LightRecord, kind)}},
    {"ViewConstants",
     {OFFSET(ViewConstants, eye), OFFSET(ViewConstants, look), OFFSET(ViewConstants, right), OFFSET(ViewConstants, up),
      OFFSET(ViewConstants, ambient), OFFSET(ViewConstants, background), OFFSET(ViewConstants, backdrop_top),
      OFFSET(ViewConstants, backdrop_bottom), OFFSET(ViewConstants, backdrop_rise), OFFSET(ViewConstants, tree_bounds),
      OFFSET(ViewConstants, film_center), OFFSET(ViewConstants, first_index), OFFSET(ViewConstants, first_lookup),
      OFFSET(ViewConstants, first_texture), OFFSET(ViewConstants, first_glass), OFFSET(ViewConstants, irradiance)}},
    {"Dispatch",
     {OFFSET(Dispatch, range), OFFSET(Dispatch, window), OFFSET(Dispatch, sampling), OFFSET(Dispatch, counts),
      OFFSET(Dispatch, outcome)}},
    {"StreamState",
     {OFFSET(StreamState, place), OFFSET(StreamState, turn), OFFSET(StreamState, shadow_rays),
      OFFSET(StreamState, list_groups), OFFSET(StreamState, shadow_groups), OFFSET(StreamState, path_groups)}},
    {"RayRecord", {OFFSET(RayRecord, origin_tmin), OFFSET(RayRecord, direction_tmax)}},
    {"HitRecord", {OFFSET(HitRecord, a), OFFSET(HitRecord, b)}},
    {"RayLog",
     {OFFSET(RayLog, ids), OFFSET(RayLog, origin_tmin), OFFSET(RayLog, direction_tmax), OFFSET(RayLog, hit),
      OFFSET(RayLog, position), OFFSET(RayLog, normal), OFFSET(RayLog, shading_normal), OFFSET(RayLog, weight),
      OFFSET(RayLog, own), OFFSET(RayLog, radiance)}},
};

struct Shader {
  const char* name;
  std::span<const uint32_t> spirv;
  /// A smaller number of operations would mean that the test reads the module incorrectly.
  uint32_t least_float_operation_count;
};

const Shader kShaders[] = {{"Cast", k_cast_spirv, 180},
                           {"Crossings", k_crossings_spirv, 180},
                           {"CameraStage", k_camera_stage_spirv, 270},
                           {"TraceShadowRays", k_trace_shadow_rays_spirv, 180},
                           {"FollowPaths", k_follow_paths_spirv, 270},
                           {"PlaceRays", k_place_rays_spirv, 0},
                           {"ListRays", k_list_rays_spirv, 0}};

void PrintTo(const Shader& shader, std::ostream* out) {
  *out << shader.name;
}

void PrintTo(const Layout& layout, std::ostream* out) {
  *out << layout.name;
}

class LayoutTest : public testing::TestWithParam<Layout> {};

TEST_P(LayoutTest, HostOffsetsAreTheShaders) {
  std::vector<std::vector<uint32_t>> variants;
  for (const Shader& shader : kShaders) {
    const auto more = test::SpirvModule(shader.spirv).offsets_of(GetParam().name);
    variants.insert(variants.end(), more.begin(), more.end());
  }
  ASSERT_THAT(variants, Not(IsEmpty())) << "no shader uses " << GetParam().name;
  EXPECT_THAT(variants, Each(GetParam().offsets));
}

INSTANTIATE_TEST_SUITE_P(Structs, LayoutTest, testing::ValuesIn(kLayouts),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

TEST(SpirvTest, SpecialisationConstantsAreThoseOfTheLayout) {
  const std::map<std::string, uint32_t> expected = {{"FEATURES", layout::CONSTANT_FEATURES},
                                                    {"MORE_FEATURES", layout::CONSTANT_MORE_FEATURES},
                                                    {"STACK_SIZE", layout::CONSTANT_STACK_SIZE},
                                                    {"FETCHES_TEXELS", layout::CONSTANT_FETCHES_TEXELS},
                                                    {"PACKET_SIZE", layout::CONSTANT_PACKET_SIZE},
                                                    {"ALL_ASK_FOR_ANY", layout::CONSTANT_ALL_ASK_FOR_ANY},
                                                    {"STEPS_TOGETHER", layout::CONSTANT_STEPS_TOGETHER},
                                                    {"WAITS_WITH_SOLIDS", layout::CONSTANT_WAITS_WITH_SOLIDS},
                                                    {"WAITS_WITH_HOLES", layout::CONSTANT_WAITS_WITH_HOLES}};
  EXPECT_EQ(test::SpirvModule(k_cast_spirv).spec_ids, expected);
  std::map<std::string, uint32_t> of_pictures = expected;
  of_pictures["FETCHES_FILM_TEXELS"] = layout::CONSTANT_FETCHES_FILM_TEXELS;
  EXPECT_EQ(test::SpirvModule(k_camera_stage_spirv).spec_ids, of_pictures);
  std::map<std::string, uint32_t> of_crossings = expected;
  of_crossings["LISTS_CROSSINGS"] = layout::CONSTANT_LISTS_CROSSINGS;
  EXPECT_EQ(test::SpirvModule(k_crossings_spirv).spec_ids, of_crossings);
}

class ShaderTest : public testing::TestWithParam<Shader> {};

// A driver may contract and reorder operations that are not `precise`; bits and watertightness would then depend on the
// driver.
TEST_P(ShaderTest, EveryFloatOperationIsPrecise) {
  const test::SpirvModule module(GetParam().spirv);
  EXPECT_GE(module.float_operation_count, GetParam().least_float_operation_count);
  EXPECT_THAT(module.contractible, IsEmpty());
  // The module also stays `precise` if the scene lacks features.
  const gpu::SpecializationConstant constants[] = {{layout::CONSTANT_FEATURES, 1}, {layout::CONSTANT_MORE_FEATURES, 0}};
  const test::SpirvModule left(gpu::specialize(GetParam().spirv, constants));
  EXPECT_THAT(left.contractible, IsEmpty());
  if (GetParam().least_float_operation_count == 0) return;
  EXPECT_THAT(left.float_operation_count, AllOf(Gt(50U), Lt(module.float_operation_count)));
}

// This shows that the test above can fail. Pictures cannot show this, because lavapipe without contraction renders the
// same pictures without `precise`.
TEST(SpirvTest, RemovedPreciseIsSeen) {
  const std::vector<uint32_t> words = read_spirv(std::filesystem::path(PROMIN_FAULTS_DIR) / "nothing_precise/cast.spv");
  EXPECT_THAT(test::SpirvModule(words).contractible, Contains(HasSubstr("shear_triangle")));
}

TEST_P(ShaderTest, HasNoMoreStorageBuffersThanVulkanGuarantees) {
  EXPECT_LE(test::SpirvModule(GetParam().spirv).storage_bindings.size(), 4U);
}

INSTANTIATE_TEST_SUITE_P(Shaders, ShaderTest, testing::ValuesIn(kShaders),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

}  // namespace
}  // namespace promin
