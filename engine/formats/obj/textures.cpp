// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/textures.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "core/file.h"
#include "formats/obj/heights.h"
#include "formats/picture_sources.h"
#include "formats/scene_path.h"

namespace promin {
namespace {

struct MapUse {
  std::string_view keyword;
  ImageUse use;
};
/// The maps that are read. The maps of roughness and metallic are read only to be merged.
constexpr std::array<MapUse, 8> kMapUses = {{{"map_Kd", ImageUse::kColor},
                                             {"map_d", ImageUse::kData},
                                             {"map_Ks", ImageUse::kColor},
                                             {"map_Ke", ImageUse::kColor},
                                             {"map_Pr", ImageUse::kData},
                                             {"map_Pm", ImageUse::kData},
                                             {"norm", ImageUse::kNormal},
                                             {"bump", ImageUse::kData}}};

std::optional<std::vector<std::byte>> read_beside_scene(const std::string& name, LoadReport& report,
                                                        uint64_t most_bytes) {
  const auto file = find_beside_scene(name, "", true, report);
  if (!file) return std::nullopt;
  return read_file(*file, most_bytes);
}

/// Calls the task for each map of the materials that is read, with the map's use.
template <class Task>
void for_each_map(const std::vector<MtlMaterial*>& materials, const Task& task) {
  for (MtlMaterial* material : materials) {
    for (auto& [keyword, map] : material->maps) {
      const auto found = std::ranges::find(kMapUses, keyword, &MapUse::keyword);
      if (found != kMapUses.end()) task(map, found->use);
    }
  }
}

uint64_t texel_count(const uvec2& size) {
  return uint64_t{size.x} * size.y;
}

/// Returns the texel of an image at the place of a texel of a picture of this size; white if there is no image.
uint32_t texel_at(const TextureImage* image, const uvec2& texel, const uvec2& size) {
  if (image == nullptr) return 0xFFFFFFFFU;
  const uint64_t x = uint64_t{texel.x} * image->size.x / size.x;
  const uint64_t y = uint64_t{texel.y} * image->size.y / size.y;
  return image->texels[y * image->size.x + x];
}

bool has_alpha(const TextureImage& image) {
  return std::ranges::any_of(image.texels, [](uint32_t texel) { return texel >> 24 != 0xFF; });
}

}  // namespace

ObjTextures::ObjTextures(const std::vector<MtlMaterial*>& materials, LoadReport& report) : report_(report) {
  std::vector<PictureSource> sources;
  for_each_map(materials, [&](const MtlMap& map, ImageUse use) {
    const auto [known, is_new] = pictures_.try_emplace({map.file, use});
    if (!is_new) return;
    PictureSource& source = sources.emplace_back();
    source.image->use = use;
    source.image->name = map.file;
    source.title = quote(map.file);
    known->second = source.image;
    read_picture(source, report, [&](LoadReport& attempt, uint64_t most_bytes) {
      return read_beside_scene(map.file, attempt, most_bytes);
    });
  });
  decode_pictures(sources, report);
  for_each_map(materials, [&](MtlMap& map, ImageUse use) { map.is_usable = !find_picture(&map, use)->texels.empty(); });
}

TextureSlot ObjTextures::read_slot(const MtlMap* map, ImageUse use) {
  if (map == nullptr) return {};
  const ImagePointer picture = find_picture(map, use);
  const auto [known, is_new] = image_numbers_.try_emplace({picture, nullptr}, static_cast<uint32_t>(images_.size()));
  if (is_new) images_.push_back(picture);
  return place(*map, known->second);
}

TextureSlot ObjTextures::read_base_color(const MtlMap* color, const MtlMap* alpha) {
  if (alpha == nullptr || (color != nullptr && color->file == alpha->file)) return read_slot(color, ImageUse::kColor);
  if (color != nullptr &&
      (color->scale != alpha->scale || color->offset != alpha->offset || color->is_clamped != alpha->is_clamped)) {
    report_.warn("the options of map_d are ignored because they differ from those of map_Kd");
  }
  const ImagePointer alphas = find_picture(alpha, ImageUse::kData);
  // Only an image without a colour picture has the same picture twice in its key.
  const std::pair sources(color == nullptr ? alphas : find_picture(color, ImageUse::kColor), alphas);
  const auto [known, is_new] = image_numbers_.try_emplace(sources, static_cast<uint32_t>(images_.size()));
  if (is_new) images_.push_back(merge_alpha(color == nullptr ? nullptr : sources.first, alphas));
  return place(color == nullptr ? *alpha : *color, known->second);
}

TextureSlot ObjTextures::read_metallic_roughness(const MtlMap* roughness, const MtlMap* metallic) {
  const MtlMap* placed = roughness != nullptr ? roughness : metallic;
  if (placed == nullptr) return {};
  if (roughness != nullptr && metallic != nullptr &&
      (roughness->scale != metallic->scale || roughness->offset != metallic->offset ||
       roughness->is_clamped != metallic->is_clamped)) {
    report_.warn("the options of map_Pm are ignored because they differ from those of map_Pr");
  }
  const std::pair sources(find_picture(roughness, ImageUse::kData), find_picture(metallic, ImageUse::kData));
  const auto [known, is_new] = image_numbers_.try_emplace(sources, static_cast<uint32_t>(images_.size()));
  if (is_new) images_.push_back(merge(sources.first, sources.second));
  return place(*placed, known->second);
}

TextureSlot ObjTextures::read_heights(const MtlMap* map) {
  const ImagePointer picture = find_picture(map, ImageUse::kData);
  if (picture == nullptr || map->strength == 0.0 || is_flat(*picture)) return {};
  HeightMap heights = {map->strength * glm::sign(map->scale), map->channel, map->is_clamped};
  const bool is_of_normals = holds_normals(*picture);
  if (is_of_normals) {
    report_.warn("image " + quote(map->file) + " of a height map contains normals; promin uses it as a normal map");
    heights.height = dvec2(0.0);
  }
  const std::tuple key(picture, heights.height.x, heights.height.y, heights.channel, heights.is_clamped);
  const auto [known, is_new] = height_numbers_.try_emplace(key, static_cast<uint32_t>(images_.size()));
  if (is_new) {
    const auto normals = std::make_shared<TextureImage>(is_of_normals ? *picture : make_normals(*picture, heights));
    normals->use = ImageUse::kNormal;
    images_.push_back(normals);
  }
  return place(*map, known->second);
}

void ObjTextures::finish(Scene& scene) {
  scene.images = std::move(images_);
  scene.textures = std::move(textures_);
}

ObjTextures::ImagePointer ObjTextures::find_picture(const MtlMap* map, ImageUse use) const {
  return map == nullptr ? nullptr : pictures_.at({map->file, use});
}

/// Places a map. In OBJ files v increases upwards, from the lowest row of a picture; the mesh's v is 1 - v.
TextureSlot ObjTextures::place(const MtlMap& map, uint32_t image) {
  const auto [known, is_new] =
      texture_numbers_.try_emplace({image, map.is_clamped}, static_cast<uint32_t>(textures_.size()));
  if (is_new) {
    Texture& texture = textures_.emplace_back();
    texture.image = image;
    if (map.is_clamped) texture.wrap_u = texture.wrap_v = TextureWrap::kClampToEdge;
  }
  TextureSlot slot;
  slot.texture = known->second;
  slot.to_u = vec3(dvec3(map.scale.x, 0.0, map.offset.x));
  slot.to_v = vec3(dvec3(0.0, map.scale.y, 1.0 - map.scale.y - map.offset.y));
  return slot;
}

ObjTextures::ImagePointer ObjTextures::merge(const ImagePointer& roughness, const ImagePointer& metallic) {
  const auto merged = std::make_shared<TextureImage>();
  merged->use = ImageUse::kData;
  for (const ImagePointer& image : {roughness, metallic}) {
    if (image == nullptr) continue;
    merged->name += merged->name.empty() ? image->name : " and " + image->name;
    if (texel_count(image->size) > texel_count(merged->size)) merged->size = image->size;
  }
  if (roughness != nullptr && metallic != nullptr && roughness->size != metallic->size) {
    report_.warn("images " + quote(roughness->name) + " and " + quote(metallic->name) +
                 " differ in size; promin enlarges the smaller one");
  }
  merged->texels.reserve(texel_count(merged->size));
  for (uint32_t y = 0; y < merged->size.y; ++y) {
    for (uint32_t x = 0; x < merged->size.x; ++x) {
      const uint32_t green = texel_at(roughness.get(), {x, y}, merged->size) & 0xFF;
      const uint32_t blue = texel_at(metallic.get(), {x, y}, merged->size) & 0xFF;
      merged->texels.push_back(0xFFU | green << 8 | blue << 16 | 0xFF000000U);
    }
  }
  return merged;
}

ObjTextures::ImagePointer ObjTextures::merge_alpha(const ImagePointer& color, const ImagePointer& alpha) {
  const auto merged = std::make_shared<TextureImage>();
  merged->use = ImageUse::kColor;
  merged->name = alpha->name;
  merged->size = alpha->size;
  if (color != nullptr) {
    merged->name = color->name + " and " + alpha->name;
    if (texel_count(color->size) > texel_count(alpha->size)) merged->size = color->size;
  }
  const uint32_t shift = has_alpha(*alpha) ? 24 : 0;
  merged->texels.reserve(texel_count(merged->size));
  for (uint32_t y = 0; y < merged->size.y; ++y) {
    for (uint32_t x = 0; x < merged->size.x; ++x) {
      const uint32_t share = texel_at(alpha.get(), {x, y}, merged->size) >> shift & 0xFF;
      merged->texels.push_back((texel_at(color.get(), {x, y}, merged->size) & 0xFFFFFFU) | share << 24);
    }
  }
  return merged;
}

}  // namespace promin
