// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/pack_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "promin/error.h"

namespace promin {
namespace {

using testing::ElementsAre;

using Images = std::vector<std::shared_ptr<const TextureImage>>;

TextureImage make_image(const uvec2& size, std::vector<uint32_t> texels, ImageUse use = ImageUse::kData) {
  return {.name = "", .size = size, .texels = std::move(texels), .use = use};
}

PackedImages pack(const TextureImage& image, bool has_levels = true) {
  Texture texture;
  texture.has_levels = has_levels;
  return pack_images(Images{std::make_shared<TextureImage>(image)}, std::vector{texture});
}

/// The texels of a level.
std::vector<uint32_t> level_of(const PackedImages& packed, uint32_t level) {
  const PlacedImage& placed = packed.images.at(0);
  const uint32_t first = placed.first + packed.words[placed.first + level];
  const uint32_t count = std::max(placed.size.x >> level, 1U) * std::max(placed.size.y >> level, 1U);
  return {packed.words.begin() + first, packed.words.begin() + first + count};
}

TEST(PackImages, LevelsAreMeansOfAreas) {
  const PackedImages packed = pack(make_image({2, 2}, {0x10000000, 0x20000000, 0x30000000, 0x40000000}));
  EXPECT_EQ(packed.images.at(0).levels, 2U);
  EXPECT_THAT(level_of(packed, 0), ElementsAre(0x10000000U, 0x20000000U, 0x30000000U, 0x40000000U));
  EXPECT_THAT(level_of(packed, 1), ElementsAre(0x28000000U));
}

TEST(PackImages, ColoursAreAveragedAsLight) {
  const TextureImage image = make_image({2, 1}, {0xFF000000, 0xFFFFFFFF}, ImageUse::kColor);
  // encode(0.5) = 0.7354 of 255, where the mean of the codes is 128.
  EXPECT_THAT(level_of(pack(image), 1), ElementsAre(0xFFBCBCBCU));
  EXPECT_THAT(level_of(pack(make_image({2, 1}, image.texels)), 1), ElementsAre(0xFF808080U));
}

TEST(PackImages, OddSizesWeighTexelsByTheirShare) {
  // Of three texels one is left, a third of each: (0 + 90 + 255) / 3 = 115.
  EXPECT_THAT(level_of(pack(make_image({3, 1}, {0, 90, 255})), 1), ElementsAre(115U));
  // Of five there are two: (60 + 120 + 180 / 2) / 2.5 = 108 and (180 / 2 + 240 + 30) / 2.5 = 144.
  EXPECT_THAT(level_of(pack(make_image({5, 1}, {60, 120, 180, 240, 30})), 1), ElementsAre(108U, 144U));
}

TEST(PackImages, LevelsEndWithOneTexel) {
  const PackedImages packed = pack(make_image({8, 2}, std::vector<uint32_t>(16, 0x01020304)));
  ASSERT_EQ(packed.images.at(0).levels, 4U);
  for (uint32_t level = 0; level < 4; ++level) {
    EXPECT_THAT(level_of(packed, level), testing::Each(0x01020304U)) << level;
  }
  EXPECT_EQ(level_of(packed, 3).size(), 1U);
}

TEST(PackImages, OnlyWhatTexturesAskForHasLevels) {
  EXPECT_EQ(pack(make_image({8, 8}, std::vector<uint32_t>(64, 0)), false).words.size(), 1U + 64U);
}

TEST(PackImages, AbsentImagesTakeNothing) {
  const PackedImages packed = pack({});
  EXPECT_TRUE(packed.words.empty());
  EXPECT_EQ(packed.images.at(0).levels, 0U);
}

TEST(PackImages, MoreThanTheBudgetIsRefused) {
  // Each texel of it is named, none is read before the sum is known.
  auto large = std::make_shared<TextureImage>(make_image({16384, 8192}, std::vector<uint32_t>(uint64_t{16384} * 8192)));
  EXPECT_THROW(pack_images(Images{large}, std::vector{Texture{}}), RunError);
}

}  // namespace
}  // namespace promin
