// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/textures.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/gltf/image_bytes.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/specular_glossiness.h"

namespace promin {
namespace {

using nlohmann::json;

// Values of samplers (glTF 2.0, section 5.26), which are the values of OpenGL.
constexpr int kNearest = 9728;
constexpr int kLinear = 9729;
constexpr int kNearestMipmapNearest = 9984;
constexpr int kLinearMipmapNearest = 9985;
constexpr int kNearestMipmapLinear = 9986;
constexpr int kLinearMipmapLinear = 9987;
constexpr int kClampToEdge = 33071;
constexpr int kMirroredRepeat = 33648;
constexpr int kRepeat = 10497;

TextureWrap wrap_of(int value) {
  if (value == kClampToEdge) return TextureWrap::kClampToEdge;
  return value == kMirroredRepeat ? TextureWrap::kMirroredRepeat : TextureWrap::kRepeat;
}

/// Sets the texture's filters. A filter that the file leaves out is linear, with levels.
void take_sampler(const json& sampler, Texture& texture) {
  texture.wrap_u = wrap_of(sampler.value("wrapS", kRepeat));
  texture.wrap_v = wrap_of(sampler.value("wrapT", kRepeat));
  texture.is_magnified_linearly = sampler.value("magFilter", kLinear) != kNearest;
  const int minified = sampler.value("minFilter", kLinearMipmapLinear);
  texture.is_minified_linearly =
      minified == kLinear || minified == kLinearMipmapNearest || minified == kLinearMipmapLinear;
  texture.has_levels = minified >= kNearestMipmapNearest;
  texture.are_levels_linear = minified == kNearestMipmapLinear || minified == kLinearMipmapLinear;
}

/// Sets the slot's transform from KHR_texture_transform: the coordinates are scaled, then rotated, then moved. The
/// matrix in the extension's text rotates in the opposite direction to the extension's pictures and to all viewers
/// (glTF#1563).
void take_transform(const json& transform, TextureSlot& slot) {
  const json offset = transform.value("offset", json::array({0.0, 0.0}));
  const json scale = transform.value("scale", json::array({1.0, 1.0}));
  const double angle = transform.value("rotation", 0.0);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  const dvec2 s(scale[0].get<double>(), scale[1].get<double>());
  const dvec2 o(offset[0].get<double>(), offset[1].get<double>());
  slot.to_u = vec3(dvec3(cosine * s.x, sine * s.y, o.x));
  slot.to_v = vec3(dvec3(-sine * s.x, cosine * s.y, o.y));
}

/// Returns the image of a texture, or -1. The image of core glTF is preferred; the image of an extension has the same
/// content.
int image_of(const json& texture) {
  if (texture.contains("source")) return texture["source"];
  for (const char* name : {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu"}) {
    const json* extension = find_extension(texture, name);
    if (extension != nullptr && extension->contains("source")) return (*extension)["source"];
  }
  return -1;
}

}  // namespace

TextureSlot GltfTextures::read_slot(const json& object, const char* name, ImageUse use) {
  return read_slot_for(object, name, {use, std::nullopt});
}

TextureSlot GltfTextures::read_glossiness_slot(const json& object, const char* name, float glossiness_factor) {
  return read_slot_for(object, name, {ImageUse::kData, glossiness_factor});
}

TextureSlot GltfTextures::read_slot_for(const json& object, const char* name, const Purpose& purpose) {
  TextureSlot slot;
  const auto found = object.find(name);
  if (found == object.end()) return slot;
  const json& info = *found;
  slot.uv_set = info.value("texCoord", 0U);
  if (const json* transform = find_extension(info, "KHR_texture_transform")) {
    take_transform(*transform, slot);
    slot.uv_set = transform->value("texCoord", slot.uv_set);
  }
  if (slot.uv_set > 1) {
    report_.warn(std::string(name) + " of texture coordinates " + std::to_string(slot.uv_set) +
                 " is ignored because only sets 0 and 1 are supported");
    return slot;
  }
  slot.texture = find_texture(info["index"].get<size_t>(), purpose);
  return slot;
}

uint32_t GltfTextures::find_texture(size_t index, const Purpose& purpose) {
  const auto [known, is_new] = texture_numbers_.try_emplace({index, purpose}, TextureSlot::kNone);
  if (!is_new) return known->second;
  const json& source = document_.json["textures"][index];
  const int image = image_of(source);
  if (image < 0) {
    textures_without_image_.insert(index);
    return TextureSlot::kNone;
  }
  Texture texture;
  texture.image = find_image(image, purpose);
  if (source.contains("sampler")) {
    take_sampler(document_.json["samplers"][source["sampler"].get<size_t>()], texture);
  }
  textures_.push_back(texture);
  known->second = static_cast<uint32_t>(textures_.size() - 1);
  return known->second;
}

uint32_t GltfTextures::find_image(int index, const Purpose& purpose) {
  const auto [known, is_new] = image_numbers_.try_emplace({index, purpose}, static_cast<uint32_t>(images_.size()));
  if (!is_new) return known->second;
  if (purpose.second) glossiness_factors_[known->second] = *purpose.second;
  PictureSource& source = images_.emplace_back();
  source.image->use = purpose.first;
  source.takes_texels = decodes_images_;
  source.title = title_of(document_.json, "images", static_cast<size_t>(index));
  source.image->name = document_.json["images"][static_cast<size_t>(index)].value("name", "");
  read_gltf_image(document_, static_cast<size_t>(index), source, report_);
  return known->second;
}

/// Restores the roughness factor of a material if the image that contains the factor is absent.
void GltfTextures::restore_roughness(Material& material) const {
  auto* model = std::get_if<MetallicRoughness>(&material.model);
  if (model == nullptr || !model->metallic_roughness_texture.exists()) return;
  const uint32_t image = textures_[model->metallic_roughness_texture.texture].image;
  const auto factor = glossiness_factors_.find(image);
  if (factor != glossiness_factors_.end() && images_[image].image->texels.empty()) {
    model->roughness = 1.0F - factor->second;
  }
}

void GltfTextures::finish(Scene& scene) {
  decode_pictures(images_, report_);
  for (const auto& [image, factor] : glossiness_factors_) {
    take_glossiness(images_[image].image->texels, static_cast<double>(factor));
  }
  for (const PictureSource& source : images_) scene.images.push_back(source.image);
  scene.textures = textures_;
  for (Material& material : scene.materials) restore_roughness(material);
  if (const size_t count = textures_without_image_.size(); count > 0) {
    report_.warn(std::to_string(count) + (count == 1 ? " texture has" : " textures have") +
                 " no image of a known format; promin draws materials without these textures");
  }
}

}  // namespace promin
