// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/drop_copies.h"

#include <gmock/gmock.h>

#include "device_scene/pack_scene.h"
#include "trace/render/copied_hits.h"

namespace promin {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// Returns a scene with this number of copies of a triangle, between two triangles beside it.
Scene make_copies(uint32_t copies, const Material& material) {
  Mesh mesh;
  mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(1, 0, 1), vec3(0, 1, 1)};
  mesh.triangles.emplace_back(3, 4, 5);
  for (uint32_t i = 0; i < copies; ++i) mesh.triangles.emplace_back(0, 1, 2);
  // A face with the same corners in another order is not a copy, because its weights differ.
  mesh.triangles.emplace_back(1, 2, 0);
  Scene scene;
  scene.add("", std::move(mesh));
  scene.materials.push_back(material);
  return scene;
}

PackedScene pack_with(const Scene& scene, const char* builder = "sah") {
  return pack_scene(world::flatten(scene, world::Purpose::kHits), builder);
}

TEST(DropCopiesTest, ManyLeaveTheTreeAndFewStay) {
  for (const char* builder : {"sah", "median", "spatial"}) {
    const PackedScene few = pack_with(make_copies(kMostCopies, {}), builder);
    EXPECT_EQ(few.bounded_count, kMostCopies + 2);
    EXPECT_THAT(few.copies.by_first, IsEmpty());
    EXPECT_THAT(few.copies.materials, IsEmpty());
    const PackedScene many = pack_with(make_copies(kMostCopies + 1, {}), builder);
    EXPECT_EQ(many.bounded_count, 3U);
    ASSERT_THAT(many.copies.by_first, SizeIs(1));
    EXPECT_THAT(many.copies.materials, ElementsAre(0));
    EXPECT_EQ(many.copies.by_first.begin()->first, 1U) << "the first stays";
    EXPECT_THAT(many.copies.by_first.begin()->second, SizeIs(kMostCopies));
    EXPECT_EQ(many.primitive_count(), kMostCopies + 3);
  }
}

/// Surfaces behind such copies are visible through them.
TEST(DropCopiesTest, WhatIsNotOpaqueStays) {
  Material blend;
  blend.alpha_mode = AlphaMode::kBlend;
  Material glass;
  glass.model = Phong{.transmission = vec3(0.5F)};
  for (const Material& material : {blend, glass}) {
    EXPECT_THAT(pack_with(make_copies(kMostCopies + 1, material)).copies.by_first, IsEmpty());
  }
}

TEST(CopiedHitsTest, CopiesAreListedInTheOrderOfHits) {
  PrimitiveNumbers numbers;
  numbers.first_order = {0, 3, 10};
  const CopiedHits copies({.by_first = {{1, {2, 4}}}, .materials = {0}}, numbers);
  const auto hit = [](float t, int32_t object, int32_t primitive) {
    Hit made;
    made.t = t;
    made.object = object;
    made.primitive = primitive;
    return made;
  };
  // Two rays hit the copies; one between these rays does not.
  const std::vector<Hit> hits = {hit(1, 0, 1), hit(1, 1, 0), hit(2, 1, 5), hit(3, 1, 5), hit(4, 0, 1)};
  const std::vector<uint64_t> offsets = {0, 3, 4, 5};
  const auto list = [&](uint64_t budget) {
    std::vector<std::string> parts;
    copies.list(
        {7, offsets, hits},
        [&](const HitList& part) {
          std::string text = std::to_string(part.first_ray) + ":";
          for (size_t i = 0; i + 1 < part.offsets.size(); ++i) {
            for (uint64_t k = part.offsets[i]; k < part.offsets[i + 1]; ++k) {
              const Hit& at = part.hits[k];
              text.append(" ").append(std::to_string(at.object)).append(".").append(std::to_string(at.primitive));
            }
            text += " |";
          }
          parts.push_back(text);
        },
        budget);
    return parts;
  };
  EXPECT_THAT(list(1 << 20), ElementsAre("7: 0.1 0.2 1.0 1.1 1.5 | 1.5 | 0.1 0.2 1.1 |"));
  EXPECT_THAT(list(1), ElementsAre("7: 0.1 0.2 1.0 1.1 1.5 |", "8: 1.5 |", "9: 0.1 0.2 1.1 |"));
}

}  // namespace
}  // namespace promin
