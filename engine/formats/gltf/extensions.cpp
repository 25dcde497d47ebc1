// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/extensions.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "core/count_of.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

/// The extensions that the loader reads.
// clang-format off
constexpr std::string_view kKnown[] = {
    "EXT_lights_area",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_implicit_shapes",
    "KHR_lights",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "OMI_environment_sky",
    "PROMIN_lights_phong",
    "PROMIN_lights_size",
    "PROMIN_materials_phong",
    "PROMIN_mesh_primitive_implicit_shape",
};
// clang-format on

/// The uses of an extension in a document.
struct Extension {
  explicit Extension(std::string its_name)
      : name(std::move(its_name)), is_known(std::ranges::find(kKnown, name) != std::end(kKnown)) {}

  std::string name;
  bool is_known;
  /// Index of the extension in extensionsRequired; -1 if it is not there.
  int required = -1;
  size_t material_count = 0;
  size_t texture_count = 0;
  /// The place of the first part of the geometry that has the extension; empty if no part has it.
  std::string geometry_place;
};

/// Collects the names in all members "extensions" inside an element.
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
    if (is_new) extensions_.emplace_back(name);
    return extensions_[place->second];
  }

  void count_material(const json& material) {
    std::set<std::string> names;
    collect_names(material, names);
    for (const std::string& name : names) ++entry(name).material_count;
  }

  /// Finds the places of listed extensions. Unlisted extensions are not reported, so they are not searched for.
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

/// Returns words such as "3 materials use".
std::string say_users(size_t count, const std::string& noun) {
  return count_of(count, noun).append(" ").append(verb_of(count, "uses", "use")).append(" ");
}

void warn_of_unknown(const Extension& extension, LoadReport& report) {
  const bool is_required = extension.required >= 0;
  const std::string& name = extension.name;
  const std::string rest = name + ", which is " + (is_required ? "required but " : "") + "not known; ";
  if (extension.material_count > 0) {
    const std::string subject = extension.material_count == 1 ? "it is" : "they are";
    report.warn(say_users(extension.material_count, "material") + rest + subject + " drawn without it");
  } else if (extension.texture_count > 0) {
    report.warn(say_users(extension.texture_count, "texture") + rest + "an alternative image is used, or none");
  } else if (is_required) {
    report.warn("the file requires " + name + ", which is unknown; promin shows the scene without it");
  } else if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_")) {
    report.warn("the extension " + name + " is ignored");
  }
}

}  // namespace

std::vector<FileExtension> check_gltf_extensions(const json& document, bool is_strict, LoadReport& report) {
  std::vector<FileExtension> list;
  const ExtensionCensus census(document);
  for (const Extension& extension : census.extensions()) {
    list.push_back({extension.name, extension.is_known, extension.required >= 0});
    if (extension.is_known) continue;
    if (is_strict && extension.required >= 0) {
      report.refuse("gltf.extension.required", "the required extension " + extension.name + " is not implemented",
                    "extensionsRequired[" + std::to_string(extension.required) + "]", "export the scene without it");
    } else if (extension.required >= 0 && !extension.geometry_place.empty()) {
      report.refuse(
          "gltf.extension.required",
          "the required extension " + extension.name + " is not implemented, so promin cannot read the geometry",
          extension.geometry_place, "export the scene without it");
    } else {
      warn_of_unknown(extension, report);
    }
  }
  return list;
}

}  // namespace promin
