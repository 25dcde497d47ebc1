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

/// Returns the texels of a level of an image.
std::vector<uint32_t> level_of(const PackedImages& packed, uint32_t level, size_t image = 0) {
  const PlacedImage& placed = packed.images.at(image);
  const uint32_t first = placed.first + packed.words[placed.first + level];
  EXPECT_EQ(first % placed.stride, 0U);
  std::vector<uint32_t> texels(std::max(placed.size.x >> level, 1U) * std::max(placed.size.y >> level, 1U));
  for (size_t i = 0; i < texels.size(); ++i) texels[i] = packed.words[first + i * placed.stride + placed.place];
  return texels;
}

TEST(PackImages, LevelsAreMeansOfAreas) {
  const PackedImages packed = pack(make_image({2, 2}, {0x10000000, 0x20000000, 0x30000000, 0x40000000}));
  EXPECT_EQ(packed.images.at(0).levels, 2U);
  EXPECT_THAT(level_of(packed, 0), ElementsAre(0x10000000U, 0x20000000U, 0x30000000U, 0x40000000U));
  EXPECT_THAT(level_of(packed, 1), ElementsAre(0x28000000U));
}

TEST(PackImages, ColoursAreAveragedAsLight) {
  const TextureImage image = make_image({2, 1}, {0xFF000000, 0xFFFFFFFF}, ImageUse::kColor);
  // encode(0.5) is 0.7354, which is 188 of 255; the mean of the codes is 128.
  EXPECT_THAT(level_of(pack(image), 1), ElementsAre(0xFFBCBCBCU));
  EXPECT_THAT(level_of(pack(make_image({2, 1}, image.texels)), 1), ElementsAre(0xFF808080U));
}

TEST(PackImages, OddSizesWeighTexelsByTheirShare) {
  // Three texels become one, with a third of each: (0 + 90 + 255) / 3 = 115.
  EXPECT_THAT(level_of(pack(make_image({3, 1}, {0, 90, 255})), 1), ElementsAre(115U));
  // Five texels become two: (60 + 120 + 180 / 2) / 2.5 = 108 and (180 / 2 + 240 + 30) / 2.5 = 144.
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

/// Data images of these sizes, each with a texture.
struct Collection {
  Images images;
  std::vector<Texture> textures;

  void add(const uvec2& size, bool has_levels) {
    std::vector<uint32_t> texels(size_t{size.x} * size.y);
    std::mt19937 random(size.x + static_cast<uint32_t>(images.size()));
    for (uint32_t& texel : texels) texel = static_cast<uint32_t>(random());
    images.push_back(std::make_shared<TextureImage>(make_image(size, std::move(texels))));
    Texture texture;
    texture.image = static_cast<uint32_t>(textures.size());
    texture.has_levels = has_levels;
    textures.push_back(texture);
  }
};

TEST(PackImages, TheLargestAreHalvedUntilAllFit) {
  Collection scene;
  scene.add({8, 8}, true);    // 4 levels: 4 + 64 + 16 + 4 + 1 = 89 words, then 3 + 16 + 4 + 1 = 24
  scene.add({4, 4}, true);    // 24 words, then 2 + 4 + 1 = 7
  scene.add({8, 8}, false);   // 65 words, then 17
  scene.add({16, 4}, false);  // 65 words, then 17
  const auto halvings = [&](uint64_t words) { return fit_images(scene.images, scene.textures, 4 * words).halvings; };
  EXPECT_THAT(halvings(243), ElementsAre(0U, 0U, 0U, 0U));
  EXPECT_THAT(halvings(242), ElementsAre(1U, 0U, 0U, 0U));
  EXPECT_THAT(halvings(177), ElementsAre(1U, 0U, 1U, 0U)) << "of equal ones the first";
  EXPECT_THAT(halvings(129), ElementsAre(1U, 0U, 1U, 1U));
  EXPECT_THAT(halvings(81), ElementsAre(2U, 0U, 1U, 1U));
  EXPECT_THAT(halvings(8), ElementsAre(3U, 2U, 3U, 4U)) << "single texels, each with a list of one level";
  EXPECT_THROW(halvings(7), RunError);
}

TEST(PackImages, LevelsOfMasksKeepTheirShare) {
  // A quarter of the texels is present. The means are 64 except for one, so that none would be present.
  std::vector<uint32_t> texels(16, 0);
  for (const size_t i : {0U, 2U, 8U, 10U}) texels[i] = 0xFF000000U;
  texels[1] = 0x40000000U;
  Texture texture;
  const Images images{std::make_shared<TextureImage>(make_image({4, 4}, texels))};
  const std::vector<float> cutoffs = {0.5F};
  const PackedImages packed = pack_images(images, std::vector{texture}, kDefaultTextureBytes, cutoffs);
  EXPECT_THAT(level_of(packed, 0), testing::ElementsAreArray(texels));
  const std::vector<uint32_t> means = level_of(packed, 1);
  EXPECT_GE(means[0] >> 24, 128U);
  for (size_t i = 1; i < 4; ++i) EXPECT_LT(means[i] >> 24, 128U);
  EXPECT_LT(level_of(pack_images(images, std::vector{texture}), 1)[0] >> 24, 128U);
}

TEST(PackImages, WhatIsHalvedHasTheLevelsThatItHad) {
  Collection scene;
  scene.add({13, 6}, true);
  const PackedImages whole = pack_images(scene.images, scene.textures);
  EXPECT_FALSE(whole.warning.has_value());
  const PackedImages halved = pack_images(scene.images, scene.textures, sizeof(uint32_t) * (whole.words.size() - 1));
  EXPECT_EQ(halved.images.at(0).size, uvec2(6, 3));
  ASSERT_EQ(halved.images.at(0).levels, 3U);
  for (uint32_t level = 0; level < 3; ++level) EXPECT_EQ(level_of(halved, level), level_of(whole, level + 1)) << level;
  const PackedImages quartered = pack_images(scene.images, scene.textures, sizeof(uint32_t) * 10);
  EXPECT_EQ(quartered.images.at(0).size, uvec2(3, 1));
  ASSERT_EQ(quartered.images.at(0).levels, 2U);
  for (uint32_t level = 0; level < 2; ++level) EXPECT_EQ(level_of(quartered, level), level_of(whole, level + 2));
  // Without levels only the picture itself is packed.
  scene.textures[0].has_levels = false;
  const PackedImages alone = pack_images(scene.images, scene.textures, sizeof(uint32_t) * 20);
  ASSERT_EQ(alone.images.at(0).levels, 1U);
  EXPECT_EQ(alone.words.size(), 19U);
  EXPECT_EQ(level_of(alone, 0), level_of(whole, 1));
}

TEST(PackImages, BundlesHaveTheSameTexelsSideBySide) {
  Collection scene;
  for (int i = 0; i < 6; ++i) scene.add({13, 6}, true);
  scene.add({8, 8}, true);
  const PackedImages alone = pack_images(scene.images, scene.textures);
  const std::vector<ImageBundle> bundles = {{3, 1}, {5, 0, 4}};
  const PackedImages packed = pack_images(scene.images, scene.textures, kDefaultTextureBytes, {}, bundles);
  const uint32_t strides[] = {4, 2, 1, 2, 4, 4, 1};
  const uint32_t places[] = {1, 1, 0, 0, 2, 0, 0};
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(packed.images[i].stride, strides[i]) << i;
    EXPECT_EQ(packed.images[i].place, places[i]) << i;
    for (uint32_t level = 0; level < 4; ++level) EXPECT_EQ(level_of(packed, level, i), level_of(alone, level, i)) << i;
  }
  // The missing fourth image of the second bundle is 0.
  const uint32_t first = packed.images[0].first + packed.words[packed.images[0].first];
  EXPECT_EQ(packed.words[first + 3], 0U);
}

TEST(PackImages, ThereAreNoBundlesWithoutMemoryOrOfUnequalImages) {
  Collection scene;
  for (int i = 0; i < 3; ++i) scene.add({8, 8}, true);
  scene.add({8, 8}, false);
  const auto stride_of = [&](uint64_t words, const ImageBundle& bundle) {
    const std::vector<ImageBundle> bundles = {bundle};
    return pack_images(scene.images, scene.textures, 4 * words, {}, bundles).images[0].stride;
  };
  // The bundle has 4 + 4 * 85 words, and the last image 65.
  EXPECT_EQ(stride_of(409, {0, 1, 2}), 4U);
  EXPECT_EQ(stride_of(408, {0, 1, 2}), 1U);
  EXPECT_EQ(stride_of(409, {0, 3}), 1U) << "one has no levels";
}

TEST(PackImages, WhatIsHalvedIsSaid) {
  Collection scene;
  for (const uint32_t side : {1024, 512, 16}) scene.add(uvec2(side), false);
  const std::optional<Problem> warning = pack_images(scene.images, scene.textures, 600 << 10).warning;
  ASSERT_TRUE(warning.has_value());
  EXPECT_EQ(warning->sentence(),
            "2 of 3 images of textures are halved in size, 1 of these more than once, so that 6 MiB become 1 MiB; "
            "raise the memory for textures, or make images smaller");
  EXPECT_EQ(warning->setting, Setting::kTextureMemory);
}

TEST(PackImages, TheBudgetCanBeNoMoreThanWordsAreNumbered) {
  Collection scene;
  scene.add({2, 2}, false);
  EXPECT_THAT(fit_images(scene.images, scene.textures, ~uint64_t{0}).halvings, ElementsAre(0U));
}

TEST(PackImagesTest, BytesAreToldBySizesAlone) {
  const auto image = std::make_shared<TextureImage>();
  image->size = {37, 20};
  image->texels.resize(37 * 20);
  const auto small = std::make_shared<TextureImage>();
  small->size = {1, 3};
  small->texels.resize(3);
  const auto absent = std::make_shared<TextureImage>();
  const Images images = {image, small, absent};
  const std::vector<Texture> textures = {{.image = 0}, {.image = 1, .has_levels = false}, {.image = 2}};
  const uint64_t bytes = pack_images(images, textures).words.size() * sizeof(uint32_t);
  EXPECT_EQ(packed_image_bytes(images, textures), bytes);
  image->texels.clear();
  EXPECT_EQ(packed_image_bytes(images, textures), bytes);
}

}  // namespace
}  // namespace promin
