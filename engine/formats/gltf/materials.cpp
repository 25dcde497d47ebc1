// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

struct MetallicRoughness {
  dvec3 base{1.0};
  double metallic = 1.0;
  double roughness = 1.0;
};

/// Phong is fitted by what the two models share: diffuse is base/pi; the specular factor is the reflectance at normal
/// incidence; the exponent's lobe is as wide as the microfacets' (Blinn's 2/r^4 - 2 around the half vector, a quarter
/// of that around the reflected ray); the mirror fades as the surface gets rough.
void shade_as_phong(const MetallicRoughness& pbr, Material& material) {
  constexpr double kDielectricReflectance = 0.04;
  constexpr double kRoughestMirror = 0.3;
  constexpr double kSharpestHighlight = 1e4;
  const dvec3 diffuse = pbr.base * (1.0 - pbr.metallic);
  const dvec3 specular = glm::mix(dvec3(kDielectricReflectance), pbr.base, pbr.metallic);
  const double exponent = (2.0 / std::pow(pbr.roughness, 4.0) - 2.0) / 4.0;
  material.ambient = vec3(diffuse);
  material.diffuse = vec3(diffuse / std::numbers::pi);
  material.specular = vec3(specular);
  material.shininess = static_cast<float>(std::clamp(exponent, 1.0, kSharpestHighlight));
  material.reflection = vec3(specular * std::max(0.0, 1.0 - pbr.roughness / kRoughestMirror));
}

void shade_as_written(const json& phong, const dvec3& base, Material& material) {
  const dvec3 diffuse = vec3_of(phong, "diffuseFactor", base);
  material.diffuse = vec3(diffuse);
  material.ambient = vec3(vec3_of(phong, "ambientFactor", diffuse));
  material.specular = vec3(vec3_of(phong, "specularFactor", dvec3(0.0)));
  material.shininess = phong.value("shininess", 0.0F);
  material.reflection = vec3(vec3_of(phong, "reflectionFactor", dvec3(0.0)));
}

bool has_texture(const json& object) {
  for (const auto& [name, value] : object.items()) {
    if (name.ends_with("Texture")) return true;
  }
  return false;
}

void warn_about_what_is_ignored(const json& source, const std::string& title, LoadReport& report) {
  const auto pbr = source.find("pbrMetallicRoughness");
  if (has_texture(source) || (pbr != source.end() && has_texture(*pbr))) {
    report.warn("material " + title + ": its textures are ignored, its factors are used");
  }
  const std::string alpha_mode = source.value("alphaMode", "OPAQUE");
  if (alpha_mode != "OPAQUE") report.warn("material " + title + ": alphaMode " + alpha_mode + " is drawn opaque");
  if (!source.contains("extensions")) return;
  for (const auto& [name, value] : source["extensions"].items()) {
    if (name != "PROMIN_materials_phong" && name != "KHR_materials_unlit" &&
        name != "KHR_materials_emissive_strength") {
      report.warn("material " + title + ": " + name + " is ignored");
    }
  }
}

MetallicRoughness metallic_roughness_of(const json& source) {
  const auto pbr = source.find("pbrMetallicRoughness");
  if (pbr == source.end()) return {};
  return {dvec3(vec4_of(*pbr, "baseColorFactor", dvec4(1.0))), pbr->value("metallicFactor", 1.0),
          pbr->value("roughnessFactor", 1.0)};
}

Material read_material(const json& source) {
  const MetallicRoughness pbr = metallic_roughness_of(source);
  Material material;
  material.name = source.value("name", "");
  if (const json* phong = find_extension(source, "PROMIN_materials_phong")) {
    shade_as_written(*phong, pbr.base, material);
  } else if (find_extension(source, "KHR_materials_unlit") != nullptr) {
    material.ambient = material.diffuse = vec3(0.0F);
    material.emissive = vec3(pbr.base);
    return material;
  } else {
    shade_as_phong(pbr, material);
  }
  double strength = 1.0;
  if (const json* extension = find_extension(source, "KHR_materials_emissive_strength")) {
    strength = extension->value("emissiveStrength", 1.0);
  }
  material.emissive = vec3(strength * vec3_of(source, "emissiveFactor", dvec3(0.0)));
  return material;
}

}  // namespace

std::vector<Material> read_gltf_materials(const GltfDocument& document, LoadReport& report) {
  std::vector<Material> materials;
  for (const json& source : elements_of(document.json, "materials")) {
    const size_t index = materials.size();
    materials.push_back(read_material(source));
    warn_about_what_is_ignored(source, title_of(document.json, "materials", index), report);
  }
  return materials;
}

Material default_gltf_material() {
  Material material;
  material.name = "glTF default";
  shade_as_phong(MetallicRoughness{}, material);
  return material;
}

}  // namespace promin
