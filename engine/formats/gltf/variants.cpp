// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/variants.h"

#include <algorithm>

#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "KHR_materials_variants";

size_t find_variant(const json& document, const std::string& name, const std::filesystem::path& file) {
  const std::vector<std::string> names = list_gltf_variants(document);
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  const std::string what = "the scene has no variant " + quote(name);
  if (names.empty())
    throw UsageError(
        {"scene.variant.unknown", what + ", because it has no variants", file.string(), "remove the variant"});
  std::string known;
  for (const std::string& other : names) known += (known.empty() ? "" : ", ") + quote(other);
  throw UsageError({"scene.variant.unknown", what, file.string(), "choose one of: " + known});
}

/// Returns the material of a mesh primitive in a variant; `otherwise` if the primitive has no mapping for the variant.
int material_in(const json& primitive, size_t variant, int otherwise) {
  const json* extension = find_extension(primitive, kExtension);
  if (extension == nullptr) return otherwise;
  for (const json& mapping : elements_of(*extension, "mappings")) {
    const json& variants = elements_of(mapping, "variants");
    const auto is_it = [&](const json& index) { return index.get<size_t>() == variant; };
    if (std::ranges::any_of(variants, is_it)) return mapping.value("material", otherwise);
  }
  return otherwise;
}

}  // namespace

std::vector<std::string> list_gltf_variants(const json& document) {
  std::vector<std::string> names;
  const json* extension = find_extension(document, kExtension);
  if (extension == nullptr) return names;
  // A variant that cannot be used is null (JsonCheck), and keeps its number.
  for (const json& variant : elements_of(*extension, "variants")) {
    names.push_back(variant.is_object() ? variant["name"].get<std::string>() : "");
  }
  return names;
}

void choose_gltf_variant(GltfDocument& document, const std::string& name, const std::filesystem::path& file) {
  const size_t variant = find_variant(document.json, name, file);
  for (size_t m = 0; m < document.meshes.size(); ++m) {
    std::vector<GltfPrimitive>& primitives = document.meshes[m].primitives;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const json& source = document.json["meshes"][m]["primitives"][p];
      primitives[p].material = material_in(source, variant, primitives[p].material);
    }
  }
}

}  // namespace promin
