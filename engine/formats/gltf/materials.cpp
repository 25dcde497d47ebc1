// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/materials.h"

#include <limits>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

/// Returns the base colour of a glTF material of any model.
dvec3 base_color_of(const json& source) {
  const auto pbr = source.find("pbrMetallicRoughness");
  return pbr == source.end() ? dvec3(1.0) : dvec3(vec4_of(*pbr, "baseColorFactor", dvec4(1.0)));
}

Phong phong_of(const json& extension, const dvec3& base) {
  const dvec3 diffuse = vec3_of(extension, "diffuseFactor", base);
  Phong phong;
  phong.diffuse = vec3(diffuse);
  phong.ambient = vec3(vec3_of(extension, "ambientFactor", diffuse));
  phong.specular = vec3(vec3_of(extension, "specularFactor", dvec3(0.0)));
  phong.shininess = extension.value("shininess", 0.0F);
  phong.reflection = vec3(vec3_of(extension, "reflectionFactor", dvec3(0.0)));
  phong.transmission = vec3(vec3_of(extension, "transmissionFactor", dvec3(0.0)));
  phong.ior = extension.value("ior", 1.0F);
  phong.fresnel = extension.value("fresnel", false);
  return phong;
}

float ior_of(const json& extension, const std::string& title, LoadReport& report) {
  const float ior = extension.value("ior", 1.5F);
  if (ior == 0.0F || ior >= 1.0F) return ior;
  report.warn("material " + title + ": an index of refraction is between 0 and 1; promin uses 1");
  return 1.0F;
}

void read_clearcoat(const json& extension, GltfTextures& textures, MetallicRoughness& material) {
  material.clearcoat = extension.value("clearcoatFactor", 0.0F);
  material.clearcoat_roughness = extension.value("clearcoatRoughnessFactor", 0.0F);
  material.clearcoat_texture = textures.read_slot(extension, "clearcoatTexture", ImageUse::kData);
  material.clearcoat_roughness_texture = textures.read_slot(extension, "clearcoatRoughnessTexture", ImageUse::kData);
  material.clearcoat_normal_texture = textures.read_slot(extension, "clearcoatNormalTexture", ImageUse::kNormal);
  if (const auto info = extension.find("clearcoatNormalTexture"); info != extension.end()) {
    material.clearcoat_normal_scale = info->value("scale", 1.0F);
  }
}

void read_sheen(const json& extension, GltfTextures& textures, MetallicRoughness& material) {
  material.sheen_color = vec3(vec3_of(extension, "sheenColorFactor", dvec3(0.0)));
  material.sheen_roughness = extension.value("sheenRoughnessFactor", 0.0F);
  material.sheen_color_texture = textures.read_slot(extension, "sheenColorTexture", ImageUse::kColor);
  material.sheen_roughness_texture = textures.read_slot(extension, "sheenRoughnessTexture", ImageUse::kData);
}

void read_diffuse_transmission(const json& extension, GltfTextures& textures, MetallicRoughness& material) {
  material.diffuse_transmission = extension.value("diffuseTransmissionFactor", 0.0F);
  material.diffuse_transmission_color = vec3(vec3_of(extension, "diffuseTransmissionColorFactor", dvec3(1.0)));
  material.diffuse_transmission_texture = textures.read_slot(extension, "diffuseTransmissionTexture", ImageUse::kData);
  material.diffuse_transmission_color_texture =
      textures.read_slot(extension, "diffuseTransmissionColorTexture", ImageUse::kColor);
}

void read_iridescence(const json& extension, GltfTextures& textures, MetallicRoughness& material) {
  material.iridescence = extension.value("iridescenceFactor", 0.0F);
  material.iridescence_ior = extension.value("iridescenceIor", 1.3F);
  material.iridescence_thickness_minimum = extension.value("iridescenceThicknessMinimum", 100.0F);
  material.iridescence_thickness_maximum = extension.value("iridescenceThicknessMaximum", 400.0F);
  material.iridescence_texture = textures.read_slot(extension, "iridescenceTexture", ImageUse::kData);
  material.iridescence_thickness_texture =
      textures.read_slot(extension, "iridescenceThicknessTexture", ImageUse::kData);
}

void read_anisotropy(const json& extension, GltfTextures& textures, MetallicRoughness& material) {
  material.anisotropy = extension.value("anisotropyStrength", 0.0F);
  material.anisotropy_rotation = extension.value("anisotropyRotation", 0.0F);
  material.anisotropy_texture = textures.read_slot(extension, "anisotropyTexture", ImageUse::kData);
}

void read_transmission(const json& source, GltfTextures& textures, MetallicRoughness& material) {
  if (const json* extension = find_extension(source, "KHR_materials_transmission")) {
    material.transmission = extension->value("transmissionFactor", 0.0F);
    material.transmission_texture = textures.read_slot(*extension, "transmissionTexture", ImageUse::kData);
  }
  if (const json* extension = find_extension(source, "KHR_materials_volume")) {
    material.thickness = extension->value("thicknessFactor", 0.0F);
    material.attenuation_color = vec3(vec3_of(*extension, "attenuationColor", dvec3(1.0)));
    material.attenuation_distance = extension->value("attenuationDistance", std::numeric_limits<float>::infinity());
  }
  if (const json* extension = find_extension(source, "KHR_materials_dispersion")) {
    material.dispersion = extension->value("dispersion", 0.0F);
  }
}

void read_shared_textures(const json& source, GltfTextures& textures, MetallicRoughness& material) {
  material.normal_texture = textures.read_slot(source, "normalTexture", ImageUse::kNormal);
  if (const auto info = source.find("normalTexture"); info != source.end()) {
    material.normal_scale = info->value("scale", 1.0F);
  }
  material.occlusion_texture = textures.read_slot(source, "occlusionTexture", ImageUse::kData);
  if (const auto info = source.find("occlusionTexture"); info != source.end()) {
    material.occlusion_strength = info->value("strength", 1.0F);
  }
}

MetallicRoughness metallic_roughness_of(const json& source, const std::string& title, GltfTextures& textures,
                                        LoadReport& report) {
  MetallicRoughness material;
  material.base_color = vec3(base_color_of(source));
  if (const auto pbr = source.find("pbrMetallicRoughness"); pbr != source.end()) {
    material.metallic = pbr->value("metallicFactor", 1.0F);
    material.roughness = pbr->value("roughnessFactor", 1.0F);
    material.base_color_texture = textures.read_slot(*pbr, "baseColorTexture", ImageUse::kColor);
    material.metallic_roughness_texture = textures.read_slot(*pbr, "metallicRoughnessTexture", ImageUse::kData);
  }
  read_shared_textures(source, textures, material);
  if (const json* extension = find_extension(source, "KHR_materials_ior")) {
    material.ior = ior_of(*extension, title, report);
  }
  if (const json* extension = find_extension(source, "KHR_materials_specular")) {
    material.specular = extension->value("specularFactor", 1.0F);
    material.specular_color = vec3(vec3_of(*extension, "specularColorFactor", dvec3(1.0)));
    material.specular_texture = textures.read_slot(*extension, "specularTexture", ImageUse::kData);
    material.specular_color_texture = textures.read_slot(*extension, "specularColorTexture", ImageUse::kColor);
  }
  read_transmission(source, textures, material);
  if (const json* extension = find_extension(source, "KHR_materials_diffuse_transmission")) {
    read_diffuse_transmission(*extension, textures, material);
  }
  if (const json* extension = find_extension(source, "KHR_materials_sheen")) {
    read_sheen(*extension, textures, material);
  }
  if (const json* extension = find_extension(source, "KHR_materials_clearcoat")) {
    read_clearcoat(*extension, textures, material);
  }
  if (const json* extension = find_extension(source, "KHR_materials_iridescence")) {
    read_iridescence(*extension, textures, material);
  }
  if (const json* extension = find_extension(source, "KHR_materials_anisotropy")) {
    read_anisotropy(*extension, textures, material);
  }
  return material;
}

/// Converts KHR_materials_pbrSpecularGlossiness to a dielectric whose reflectance is the specular colour. An index of
/// refraction of 0 causes this.
MetallicRoughness specular_glossiness_of(const json& source, const json& extension, GltfTextures& textures) {
  const float glossiness = extension.value("glossinessFactor", 1.0F);
  MetallicRoughness material;
  material.base_color = vec3(dvec3(vec4_of(extension, "diffuseFactor", dvec4(1.0))));
  material.metallic = 0.0F;
  material.ior = 0.0F;
  material.specular_color = vec3(vec3_of(extension, "specularFactor", dvec3(1.0)));
  material.specular_color_texture = textures.read_slot(extension, "specularGlossinessTexture", ImageUse::kColor);
  material.base_color_texture = textures.read_slot(extension, "diffuseTexture", ImageUse::kColor);
  material.metallic_roughness_texture =
      textures.read_glossiness_slot(extension, "specularGlossinessTexture", glossiness);
  // The texture's values already contain the factor.
  material.roughness = material.metallic_roughness_texture.exists() ? 1.0F : 1.0F - glossiness;
  read_shared_textures(source, textures, material);
  return material;
}

bool has_texture(const json& object) {
  for (const auto& [name, value] : object.items()) {
    if (name.ends_with("Texture")) return true;
  }
  return false;
}

void warn_about_what_is_ignored(const json& source, const std::string& title, LoadReport& report) {
  const auto pbr = source.find("pbrMetallicRoughness");
  const bool is_classic = find_extension(source, "PROMIN_materials_phong") != nullptr;
  if (is_classic && (has_texture(source) || (pbr != source.end() && has_texture(*pbr)))) {
    report.warn("material " + title + ": its textures are ignored and its factors are used");
  }
  if (is_classic && source.value("alphaMode", "OPAQUE") != "OPAQUE") {
    report.warn("material " + title + ": its alphaMode is ignored and it is drawn opaque");
  }
}

Unlit unlit_of(const json& source, GltfTextures& textures) {
  Unlit unlit{vec3(base_color_of(source)), {}};
  if (const auto pbr = source.find("pbrMetallicRoughness"); pbr != source.end()) {
    unlit.color_texture = textures.read_slot(*pbr, "baseColorTexture", ImageUse::kColor);
  }
  return unlit;
}

void read_alpha(const json& source, Material& material) {
  const std::string mode = source.value("alphaMode", "OPAQUE");
  if (mode == "MASK") material.alpha_mode = AlphaMode::kMask;
  if (mode == "BLEND") material.alpha_mode = AlphaMode::kBlend;
  dvec4 base(1.0);
  if (const json* glossy = find_extension(source, "KHR_materials_pbrSpecularGlossiness")) {
    base = vec4_of(*glossy, "diffuseFactor", base);
  } else if (const auto pbr = source.find("pbrMetallicRoughness"); pbr != source.end()) {
    base = vec4_of(*pbr, "baseColorFactor", base);
  }
  material.alpha = static_cast<float>(base.w);
  material.alpha_cutoff = source.value("alphaCutoff", 0.5F);
  material.is_double_sided = source.value("doubleSided", false);
}

Material read_material(const json& source, const std::string& title, GltfTextures& textures, LoadReport& report) {
  Material material;
  material.name = source.value("name", "");
  if (const json* phong = find_extension(source, "PROMIN_materials_phong")) {
    material.model = phong_of(*phong, base_color_of(source));
  } else if (find_extension(source, "KHR_materials_unlit") != nullptr) {
    material.model = unlit_of(source, textures);
    read_alpha(source, material);
    return material;
  } else {
    const json* archived = find_extension(source, "KHR_materials_pbrSpecularGlossiness");
    material.model = archived != nullptr ? specular_glossiness_of(source, *archived, textures)
                                         : metallic_roughness_of(source, title, textures, report);
    material.emissive_texture = textures.read_slot(source, "emissiveTexture", ImageUse::kColor);
    read_alpha(source, material);
  }
  double strength = 1.0;
  if (const json* extension = find_extension(source, "KHR_materials_emissive_strength")) {
    strength = extension->value("emissiveStrength", 1.0);
  }
  material.emissive = vec3(strength * vec3_of(source, "emissiveFactor", dvec3(0.0)));
  return material;
}

}  // namespace

std::vector<Material> read_gltf_materials(const GltfDocument& document, GltfTextures& textures, LoadReport& report) {
  std::vector<Material> materials;
  for (const json& source : elements_of(document.json, "materials")) {
    const std::string title = title_of(document.json, "materials", materials.size());
    materials.push_back(read_material(source, title, textures, report));
    warn_about_what_is_ignored(source, title, report);
  }
  return materials;
}

Material default_gltf_material() {
  Material material;
  material.name = "glTF default";
  material.model = MetallicRoughness{};
  material.is_double_sided = false;
  return material;
}

}  // namespace promin
