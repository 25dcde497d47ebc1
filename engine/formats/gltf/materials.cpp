// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/materials.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

/// The base colour of a glTF material, whatever its model.
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
  return phong;
}

/// Of what the specification bounds by 1, exporters write a little more.
vec3 to_shares(const dvec3& color) {
  return vec3(glm::min(color, dvec3(1.0)));
}

float ior_of(const json& extension, const std::string& place, LoadReport& report) {
  const float ior = extension.value("ior", 1.5F);
  if (ior != 0.0F && ior < 1.0F) {
    report.refuse("an index of refraction lies between 0 and 1", place + ".extensions.KHR_materials_ior.ior",
                  "use 0 or a number from 1 on");
  }
  return ior;
}

MetallicRoughness metallic_roughness_of(const json& source, const std::string& place, LoadReport& report) {
  MetallicRoughness material;
  material.base_color = to_shares(base_color_of(source));
  if (const auto pbr = source.find("pbrMetallicRoughness"); pbr != source.end()) {
    material.metallic = pbr->value("metallicFactor", 1.0F);
    material.roughness = pbr->value("roughnessFactor", 1.0F);
  }
  if (const json* extension = find_extension(source, "KHR_materials_ior")) {
    material.ior = ior_of(*extension, place, report);
  }
  if (const json* extension = find_extension(source, "KHR_materials_specular")) {
    material.specular = extension->value("specularFactor", 1.0F);
    material.specular_color = vec3(vec3_of(*extension, "specularColorFactor", dvec3(1.0)));
  }
  return material;
}

bool has_texture(const json& object) {
  for (const auto& [name, value] : object.items()) {
    if (name.ends_with("Texture")) return true;
  }
  return false;
}

constexpr std::array<std::string_view, 5> kKnown = {"PROMIN_materials_phong", "KHR_materials_unlit",
                                                    "KHR_materials_emissive_strength", "KHR_materials_ior",
                                                    "KHR_materials_specular"};

void warn_about_what_is_ignored(const json& source, const std::string& title, LoadReport& report) {
  const auto pbr = source.find("pbrMetallicRoughness");
  if (has_texture(source) || (pbr != source.end() && has_texture(*pbr))) {
    report.warn("material " + title + ": its textures are ignored, its factors are used");
  }
  const std::string alpha_mode = source.value("alphaMode", "OPAQUE");
  if (alpha_mode != "OPAQUE") report.warn("material " + title + ": alphaMode " + alpha_mode + " is drawn opaque");
  if (!source.contains("extensions")) return;
  for (const auto& [name, value] : source["extensions"].items()) {
    if (std::ranges::find(kKnown, name) == kKnown.end()) {
      report.warn("material " + title + ": " + name + " is ignored");
    }
  }
}

Material read_material(const json& source, const std::string& place, LoadReport& report) {
  Material material;
  material.name = source.value("name", "");
  if (const json* phong = find_extension(source, "PROMIN_materials_phong")) {
    material.model = phong_of(*phong, base_color_of(source));
  } else if (find_extension(source, "KHR_materials_unlit") != nullptr) {
    material.model = Unlit{vec3(base_color_of(source))};
    return material;
  } else {
    material.model = metallic_roughness_of(source, place, report);
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
    materials.push_back(read_material(source, std::string("materials[") + std::to_string(index) + "]", report));
    warn_about_what_is_ignored(source, title_of(document.json, "materials", index), report);
  }
  return materials;
}

Material default_gltf_material() {
  Material material;
  material.name = "glTF default";
  material.model = MetallicRoughness{};
  return material;
}

}  // namespace promin
