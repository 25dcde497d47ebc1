// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

/// An extension that the loader reads.
struct Known {
  std::string_view name;
  /// Its members in a material that are not shown as they are.
  std::array<std::string_view, 2> approximated = {};
  /// What becomes of these.
  std::string_view approximation = {};
};

constexpr Known kKnown[] = {
    {.name = "EXT_mesh_gpu_instancing"}, {.name = "EXT_meshopt_compression"},
    {.name = "EXT_texture_webp"},        {.name = "KHR_draco_mesh_compression"},
    {.name = "KHR_implicit_shapes"},     {.name = "KHR_lights_punctual"},
    {.name = "KHR_materials_clearcoat"}, {.name = "KHR_materials_emissive_strength"},
    {.name = "KHR_materials_ior"},       {.name = "KHR_materials_pbrSpecularGlossiness"},
    {.name = "KHR_materials_sheen"},     {.name = "KHR_materials_specular"},
    {.name = "KHR_materials_unlit"},     {.name = "KHR_materials_variants"},
    {.name = "KHR_mesh_quantization"},   {.name = "KHR_meshopt_compression"},
    {.name = "KHR_node_visibility"},     {.name = "KHR_texture_transform"},
    {.name = "OMI_environment_sky"},     {.name = "PROMIN_lights_phong"},
    {.name = "PROMIN_materials_phong"},  {.name = "PROMIN_mesh_primitive_implicit_shape"},
};

const Known* find_known(std::string_view name) {
  const auto* const found = std::ranges::find(kKnown, name, &Known::name);
  return found == std::end(kKnown) ? nullptr : found;
}

/// What a document has of one extension.
struct Extension {
  Extension(std::string its_name, const Known* its_row) : name(std::move(its_name)), known(its_row) {}

  std::string name;
  const Known* known;
  /// Its place in extensionsRequired, or -1.
  int required = -1;
  size_t material_count = 0;
  size_t texture_count = 0;
  /// Materials that are shown by an approximation of it.
  size_t approximated_count = 0;
  /// The first part of the geometry that carries it; empty where none does.
  std::string geometry_place;
};

/// The names below all members "extensions" of an element.
void collect_names(const json& element, std::set<std::string>& names) {
  if (!element.is_structured()) return;
  for (const auto& [key, value] : element.items()) {
    if (key == "extensions" && value.is_object()) {
      for (const auto& [name, extension] : value.items()) names.insert(name);
    }
    if (key != "extras") collect_names(value, names);
  }
}

class ExtensionCensus {
 public:
  explicit ExtensionCensus(const json& document) : document_(document) {
    for (const json& name : elements_of(document, "extensionsUsed")) entry(name);
    const json& required = elements_of(document, "extensionsRequired");
    for (size_t i = 0; i < required.size(); ++i) {
      Extension& extension = entry(required[i]);
      if (extension.required < 0) extension.required = static_cast<int>(i);
    }
    for (const json& material : elements_of(document, "materials")) count_material(material);
    for (const json& texture : elements_of(document, "textures")) {
      std::set<std::string> names;
      collect_names(texture, names);
      for (const std::string& name : names) ++entry(name).texture_count;
    }
    for (const char* array : {"buffers", "bufferViews", "accessors", "nodes"}) find_places(document, array, "");
    const json& meshes = elements_of(document, "meshes");
    for (size_t i = 0; i < meshes.size(); ++i) {
      find_places(meshes[i], "primitives", "meshes[" + std::to_string(i) + "].");
    }
  }

  const std::vector<Extension>& extensions() const { return extensions_; }

 private:
  Extension& entry(const std::string& name) {
    const auto [place, is_new] = places_.try_emplace(name, extensions_.size());
    if (is_new) extensions_.emplace_back(name, find_known(name));
    return extensions_[place->second];
  }

  void count_material(const json& material) {
    std::set<std::string> names;
    collect_names(material, names);
    for (const std::string& name : names) {
      Extension& extension = entry(name);
      ++extension.material_count;
      const json* members = find_extension(material, name.c_str());
      if (extension.known == nullptr || members == nullptr) continue;
      const auto has = [&](std::string_view member) { return !member.empty() && members->contains(member); };
      if (std::ranges::any_of(extension.known->approximated, has)) ++extension.approximated_count;
    }
  }

  /// Only listed extensions are looked for: of any other nothing is said.
  void find_places(const json& parent, const char* array, const std::string& prefix) {
    const json& elements = elements_of(parent, array);
    for (size_t i = 0; i < elements.size(); ++i) {
      const auto carried = elements[i].find("extensions");
      if (carried == elements[i].end()) continue;
      for (const auto& [name, value] : carried->items()) {
        const auto listed = places_.find(name);
        if (listed == places_.end()) continue;
        std::string& place = extensions_[listed->second].geometry_place;
        if (place.empty()) place = prefix + array + "[" + std::to_string(i) + "]";
      }
    }
  }

  const json& document_;
  std::vector<Extension> extensions_;
  std::map<std::string, size_t> places_;
};

std::string say_number(size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// "3 materials use".
std::string say_users(size_t count, const std::string& noun) {
  return say_number(count, noun) + (count == 1 ? " uses " : " use ");
}

void warn_of_unknown(const Extension& extension, LoadReport& report) {
  const bool is_required = extension.required >= 0;
  const std::string& name = extension.name;
  const std::string rest = name + ", which is " + (is_required ? "required but " : "") + "not known; ";
  if (extension.material_count > 0) {
    const std::string subject = extension.material_count == 1 ? "it is" : "they are";
    report.warn(say_users(extension.material_count, "material") + rest + subject + " drawn without it");
  } else if (extension.texture_count > 0) {
    report.warn(say_users(extension.texture_count, "texture") + rest +
                "an image that is named beside it is taken, or none");
  } else if (is_required) {
    report.warn("the file requires " + name + ", which is not known; it is shown without it");
  } else if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_")) {
    report.warn("the extension " + name + " is ignored");
  }
}

void warn_of_approximation(const Extension& extension, LoadReport& report) {
  if (extension.approximated_count == 0) return;
  report.warn(say_number(extension.approximated_count, "material") +
              (extension.approximated_count == 1 ? " has" : " have") + " textures of " + extension.name + ", " +
              std::string(extension.known->approximation));
}

ExtensionUse use_of(const Extension& extension) {
  if (extension.known == nullptr) return ExtensionUse::kIgnored;
  return extension.approximated_count > 0 ? ExtensionUse::kApproximated : ExtensionUse::kUsed;
}

}  // namespace

std::vector<FileExtension> check_gltf_extensions(const json& document, bool is_strict, LoadReport& report) {
  std::vector<FileExtension> list;
  const ExtensionCensus census(document);
  for (const Extension& extension : census.extensions()) {
    list.push_back({extension.name, use_of(extension), extension.required >= 0});
    if (extension.known != nullptr) {
      warn_of_approximation(extension, report);
    } else if (is_strict && extension.required >= 0) {
      report.refuse("the required extension " + extension.name + " is not implemented",
                    "extensionsRequired[" + std::to_string(extension.required) + "]", "export the scene without it");
    } else if (extension.required >= 0 && !extension.geometry_place.empty()) {
      report.refuse("the required extension " + extension.name +
                        " is not implemented, and without it there is no telling what the geometry is",
                    extension.geometry_place, "export the scene without it");
    } else {
      warn_of_unknown(extension, report);
    }
  }
  return list;
}

}  // namespace promin
