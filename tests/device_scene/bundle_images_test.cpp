// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/bundle_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace promin {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A scene with a material of these slots, each with an image of its own.
class BundleImagesTest : public testing::Test {
 protected:
  BundleImagesTest() {
    for (uint32_t i = 0; i < 5; ++i) {
      const ImageUse use = i == 1 || i == 3 || i == 4 ? ImageUse::kColor : ImageUse::kData;
      image_.push_back(
          std::make_shared<TextureImage>(TextureImage{.name = "", .size = {2, 1}, .texels = {1, 2}, .use = use}));
      scene_.images.push_back(image_.back());
      scene_.textures.push_back({.image = i});
    }
    scene_.materials = {make_material()};
  }

  static Material make_material() {
    MetallicRoughness model;
    model.metallic_roughness_texture.texture = 0;
    model.base_color_texture.texture = 1;
    model.normal_texture.texture = 2;
    model.sheen_color_texture.texture = 4;
    Material material{.name = "", .model = model};
    material.emissive_texture.texture = 3;
    return material;
  }
  MetallicRoughness& model() { return std::get<MetallicRoughness>(scene_.materials[0].model); }
  std::vector<ImageBundle> find() const { return find_image_bundles(scene_, cutoffs_); }

  world::Scene scene_;
  std::vector<std::shared_ptr<TextureImage>> image_;
  std::vector<float> cutoffs_ = std::vector<float>(5, 0.0F);
};

TEST_F(BundleImagesTest, TwoColoursComeFirst) {
  EXPECT_THAT(find(), ElementsAre(ElementsAre(1, 4, 0, 2)));
}

TEST_F(BundleImagesTest, TheRestMakesAnotherBundle) {
  scene_.materials.push_back(make_material());
  auto& other = std::get<MetallicRoughness>(scene_.materials[1].model);
  scene_.images.push_back(image_[0]);
  scene_.textures.push_back({.image = 5});
  cutoffs_.push_back(0.0F);
  other.occlusion_texture.texture = 5;
  EXPECT_THAT(find(), ElementsAre(ElementsAre(1, 4, 0, 2), ElementsAre(3, 5)));
}

TEST_F(BundleImagesTest, OtherCoordinatesSamplersAndSizesStayApart) {
  model().sheen_color_texture = {};
  const auto changed = [&](const std::function<void(TextureSlot&, Texture&, TextureImage&)>& change) {
    const TextureSlot slot = model().normal_texture;
    const Texture texture = scene_.textures[2];
    const TextureImage image = *image_[2];
    change(model().normal_texture, scene_.textures[2], *image_[2]);
    std::vector<ImageBundle> found = find();
    model().normal_texture = slot;
    scene_.textures[2] = texture;
    *image_[2] = image;
    return found;
  };
  const auto is_apart = ElementsAre(ElementsAre(1, 3, 0));
  EXPECT_THAT(changed([](TextureSlot& slot, Texture&, TextureImage&) { slot.uv_set = 1; }), is_apart);
  EXPECT_THAT(changed([](TextureSlot& slot, Texture&, TextureImage&) { slot.to_u.z = 0.5F; }), is_apart);
  EXPECT_THAT(changed([](TextureSlot& slot, Texture&, TextureImage&) { slot.to_v.x = 0.5F; }), is_apart);
  EXPECT_THAT(
      changed([](TextureSlot&, Texture& texture, TextureImage&) { texture.wrap_v = TextureWrap::kClampToEdge; }),
      is_apart);
  EXPECT_THAT(changed([](TextureSlot&, Texture&, TextureImage& image) { image.size = {1, 2}; }), is_apart);
  EXPECT_THAT(changed([](TextureSlot&, Texture&, TextureImage& image) { image.texels.clear(); }), is_apart);
}

TEST_F(BundleImagesTest, BundlesSaveHalfOfTheLookUps) {
  // Three look-ups in place of five are too many.
  model().normal_texture.uv_set = 1;
  EXPECT_THAT(find(), IsEmpty());
  // Equal slots count once.
  model().occlusion_texture = model().metallic_roughness_texture;
  EXPECT_THAT(find(), IsEmpty());
  model().sheen_color_texture = {};
  EXPECT_THAT(find(), ElementsAre(ElementsAre(1, 3, 0)));
}

TEST_F(BundleImagesTest, ImagesOfHolesAndGlassStandAlone) {
  cutoffs_[1] = 0.5F;
  EXPECT_THAT(find(), ElementsAre(ElementsAre(4, 3, 0, 2)));
  scene_.materials.push_back(make_material());
  scene_.materials[1].alpha_mode = AlphaMode::kBlend;
  EXPECT_THAT(find(), IsEmpty());
  scene_.materials[1].alpha_mode = AlphaMode::kOpaque;
  std::get<MetallicRoughness>(scene_.materials[1].model).transmission = 1.0F;
  EXPECT_THAT(find(), IsEmpty());
}

}  // namespace
}  // namespace promin
