// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/center_uvs.h"

#include <gtest/gtest.h>

namespace promin {
namespace {

/// Returns a triangle whose coordinates in both sets begin at `first`.
Mesh make_mesh(const vec2& first) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  for (const vec2& uv : {first, first + vec2(0.5F, 0.0F), first + vec2(0.0F, 0.75F)}) mesh.uvs.emplace_back(uv, uv);
  return mesh;
}

Texture make_texture(TextureWrap wrap_u, TextureWrap wrap_v) {
  Texture texture;
  texture.wrap_u = wrap_u;
  texture.wrap_v = wrap_v;
  return texture;
}

TextureSlot make_slot(const vec3& to_u = {1, 0, 0}, const vec3& to_v = {0, 1, 0}) {
  TextureSlot slot;
  slot.texture = 0;
  slot.to_u = to_u;
  slot.to_v = to_v;
  return slot;
}

constexpr TextureWrap kRepeat = TextureWrap::kRepeat;
constexpr TextureWrap kMirrored = TextureWrap::kMirroredRepeat;
constexpr TextureWrap kClamp = TextureWrap::kClampToEdge;

dvec4 center_of(const vec2& first, const TextureSlot& slot, TextureWrap wrap_u = kRepeat,
                TextureWrap wrap_v = kRepeat) {
  return find_uv_center(make_mesh(first), std::vector{slot}, std::vector{make_texture(wrap_u, wrap_v)});
}

TEST(CenterUvs, RepeatedOnesComeNearZero) {
  EXPECT_EQ(center_of({500.25F, -7.5F}, make_slot()), dvec4(500, -8, 0, 0));
  Mesh mesh = make_mesh({500.25F, -7.5F});
  center_uvs(mesh, {500, -8, 0, 0});
  EXPECT_EQ(mesh.uvs[0], vec4(0.25F, 0.5F, 500.25F, -7.5F));
  EXPECT_EQ(mesh.uvs[1], vec4(0.75F, 0.5F, 500.75F, -7.5F));
}

TEST(CenterUvs, NothingMovesWithoutNeed) {
  EXPECT_EQ(center_of({0.25F, 0.0F}, make_slot()), dvec4(0));
  TextureSlot second = make_slot();
  second.uv_set = 1;
  EXPECT_EQ(center_of({500, 0}, second), dvec4(0, 0, 500, 0)) << "the other set is not read";
  EXPECT_EQ(find_uv_center(make_mesh({500, 500}), {}, {}), dvec4(0));
  // The coordinates go from 0 to 1000. A move would make half of them less precise and the others more precise.
  Mesh wide = make_mesh({0, 0});
  wide.uvs = {vec4(0.1F), vec4(999.3F), vec4(500)};
  EXPECT_EQ(find_uv_center(wide, std::vector{make_slot()}, std::vector{Texture{}}), dvec4(0));
}

TEST(CenterUvs, MirroredOnesMoveByTwoWidths) {
  EXPECT_EQ(center_of({501.25F, 501.25F}, make_slot(), kMirrored, kRepeat), dvec4(500, 501, 0, 0));
  EXPECT_EQ(center_of({-3.25F, 0.0F}, make_slot(), kMirrored), dvec4(-4, 0, 0, 0));
}

TEST(CenterUvs, ClampedOnesStayWhereTheyAre) {
  EXPECT_EQ(center_of({500, 500}, make_slot(), kClamp, kRepeat), dvec4(0, 500, 0, 0));
  EXPECT_EQ(center_of({500, 500}, make_slot(), kClamp, kClamp), dvec4(0));
  // After a quarter turn, the picture's u is the mesh's v.
  EXPECT_EQ(center_of({500, 500}, make_slot({0, 1, 0}, {-1, 0, 0}), kClamp, kRepeat), dvec4(500, 0, 0, 0));
}

TEST(CenterUvs, TransformsDecideWhatIsAWidth) {
  EXPECT_EQ(center_of({501, 501}, make_slot({4, 0, 0.3F}, {0, -3, 0.1F})), dvec4(501, 501, 0, 0));
  EXPECT_EQ(center_of({501, 503}, make_slot({0.5F, 0, 0}, {0, 0.25F, 0})), dvec4(500, 500, 0, 0));
  EXPECT_EQ(center_of({501, 501}, make_slot({0.5F, 0, 0}, {0, 1, 0}), kMirrored), dvec4(500, 501, 0, 0));
  // A mesh is only moved by an integer that is also a whole number of these widths, if there is one.
  EXPECT_EQ(center_of({501, 501}, make_slot({0.1234F, 0, 0}, {0, 1, 0})), dvec4(0, 501, 0, 0));
  EXPECT_EQ(center_of({501, 501}, make_slot({0.75F, 0.5F, 0}, {-0.5F, 0.75F, 0})), dvec4(500, 500, 0, 0));
  EXPECT_EQ(center_of({501, 501}, make_slot({0.7071F, 0.7071F, 0}, {-0.7071F, 0.7071F, 0})), dvec4(0));
  // The rounding error of the cosine of 90 degrees does not prevent the move.
  EXPECT_EQ(center_of({501, 501}, make_slot({6e-17F, 1, 0}, {-1, 6e-17F, 0})), dvec4(501, 501, 0, 0));
}

TEST(CenterUvs, AllSlotsOfTheSetHaveToAgree) {
  const Mesh mesh = make_mesh({503, 503});
  TextureSlot half = make_slot({0.5F, 0, 0}, {0, 1, 0});
  TextureSlot clamped = make_slot();
  clamped.texture = 1;
  const std::vector<Texture> textures = {make_texture(kRepeat, kRepeat), make_texture(kClamp, kRepeat)};
  EXPECT_EQ(find_uv_center(mesh, std::vector{make_slot(), half}, textures), dvec4(502, 503, 0, 0));
  EXPECT_EQ(find_uv_center(mesh, std::vector{make_slot(), clamped}, textures), dvec4(0, 503, 0, 0));
  clamped.uv_set = 1;
  EXPECT_EQ(find_uv_center(mesh, std::vector{make_slot(), clamped}, textures), dvec4(503, 503, 0, 503));
}

}  // namespace
}  // namespace promin
