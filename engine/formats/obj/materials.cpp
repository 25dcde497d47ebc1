// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/materials.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "core/file.h"
#include "formats/obj/paths.h"
#include "formats/scene_path.h"
#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// The default index of refraction of glass.
constexpr double kGlass = 1.5;

bool is_index(double number) {
  return number > kMinSize && number <= kMaxCoordinate;
}

double illum_of(const MtlMaterial& source) {
  return std::floor(source.find("illum", 2.0).x);
}

/// Returns the reason why find_beside_scene() refuses a file.
std::string reason_against(const std::string& name, LoadReport& report) {
  LoadReport attempt = report.make_attempt();
  find_beside_scene(name, "", true, attempt);
  try {
    attempt.throw_if_refused();
  } catch (const InputError& error) {
    return error.problems().front().what;
  }
  return quote(name) + " does not exist";
}

/// Returns the files that a mtllib line names: the whole rest of the line if such a file exists, because names may
/// contain spaces, or otherwise each word.
std::vector<std::string> find_library(const std::string& line, LoadReport& report) {
  if (auto whole = find_named_file(line, "", report)) return {*whole};
  std::vector<std::string> files;
  std::vector<std::string> missing;
  std::string_view rest = line;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const std::string name(word);
    auto file = find_named_file(name, "", report);
    if (!file) file = find_by_last_part(name, "", report);
    (file ? files : missing).push_back(file.value_or(name));
  }
  if (missing.empty()) return files;
  if (auto whole = find_by_last_part(line, "", report)) return {*whole};
  for (const std::string& name : missing) {
    report.warn("promin cannot read the material file " + quote(name) +
                ", so its materials are grey: " + reason_against(name, report));
  }
  return files;
}

/// Returns a colour of the file; if the file gives none, its default, or 1 if there is a map.
vec3 color_from(const MtlMaterial& source, const std::string& keyword, double otherwise) {
  return vec3(source.find(keyword, source.find_map("map_" + keyword) != nullptr ? 1.0 : otherwise));
}

void warn_of_unused_maps(const MtlMaterial& source, std::initializer_list<const char*> keywords, LoadReport& report) {
  for (const char* keyword : keywords) {
    if (source.find_map(keyword) == nullptr) continue;
    report.warn("material " + quote(source.name) + ": its " + keyword + " is ignored");
  }
}

/// Returns the opacity. If a material has both d and Tr, d counts.
float opacity_of(const MtlMaterial& source) {
  const double opacity = source.numbers.contains("d") ? source.find("d", 1.0).x : 1.0 - source.find("Tr", 0.0).x;
  return static_cast<float>(std::clamp(opacity, 0.0, 1.0));
}

/// Returns whether the material transmits and refracts light, as illum 6 and 7 do.
bool is_refracting(const MtlMaterial& source) {
  return illum_of(source) == 6.0 || illum_of(source) == 7.0;
}

/// Returns whether the filter Tf determines the transmission: always for refracting materials, and for the glass of
/// illum 4 and 9 if the file has Tf. Otherwise d determines the transmission.
bool is_filtering(const MtlMaterial& source) {
  const bool is_unbent = illum_of(source) == 4.0 || illum_of(source) == 9.0;
  return is_refracting(source) || (is_unbent && source.numbers.contains("Tf") && opacity_of(source) < 1.0F);
}

/// Returns the slot of map_Kd, combined with the alpha of map_d.
TextureSlot read_base_color(const MtlMaterial& source, ObjTextures& textures) {
  return textures.read_base_color(source.find_map("map_Kd"), source.find_map("map_d"));
}

/// Returns the slot of the normals of norm, or otherwise of the heights of bump.
TextureSlot read_normals(const MtlMaterial& source, ObjTextures& textures) {
  if (const MtlMap* normals = source.find_map("norm")) return textures.read_slot(normals, ImageUse::kNormal);
  return textures.read_heights(source.find_map("bump"));
}

bool is_metallic_roughness(const MtlMaterial& source) {
  return source.numbers.contains("Pr") || source.numbers.contains("Pm") || source.maps.contains("map_Pr") ||
         source.maps.contains("map_Pm");
}

/// Returns whether opacity applies to the whole surface, and not only to the light through Phong's glass.
bool blends(const MtlMaterial& source) {
  return !is_filtering(source) || is_metallic_roughness(source);
}

/// Decides between two conventions for a Tr without d. In most programs Tr is 1 - d, so a material with Tr = 1 would be
/// invisible. A file with such a material therefore follows the other convention, in which Tr is d.
void settle_transparency(std::vector<MtlMaterial>& materials, const std::string& file, LoadReport& report) {
  const auto has_tr_alone = [](const MtlMaterial& source) {
    return source.numbers.contains("Tr") && !source.numbers.contains("d");
  };
  const auto invisible = std::ranges::find_if(materials, [&](const MtlMaterial& source) {
    return has_tr_alone(source) && opacity_of(source) == 0.0F && blends(source);
  });
  if (invisible == materials.end()) return;
  report.warn(
      "material " + quote(invisible->name) +
      " would be invisible because of its Tr without a d; promin draws it opaque, and reads each Tr without a d of " +
      file + " as d");
  for (MtlMaterial& source : materials) {
    if (!has_tr_alone(source)) continue;
    const double opacity = source.find("Tr", 1.0).x;
    source.numbers["d"] = dvec3(opacity > 0.0 ? opacity : 1.0);
  }
}

void take_alpha(const MtlMaterial& source, Material& material, LoadReport& report) {
  if (!blends(source)) return;
  material.alpha = opacity_of(source);
  if (material.alpha == 0.0F) report.warn("material " + quote(source.name) + " is invisible because its d is 0");
  const bool has_map = source.find_map("map_d") != nullptr;
  if (material.alpha < 1.0F || has_map) material.alpha_mode = AlphaMode::kBlend;
}

MetallicRoughness metallic_roughness_of_mtl(const MtlMaterial& source, ObjTextures& textures) {
  // If there is a map, it alone determines the value.
  const auto share = [&](const char* keyword, double otherwise) {
    const bool has_map = source.find_map(std::string("map_") + keyword) != nullptr;
    return has_map ? 1.0F : static_cast<float>(std::min(source.find(keyword, otherwise).x, 1.0));
  };
  MetallicRoughness model;
  model.base_color = glm::min(color_from(source, "Kd", 0.8), vec3(1.0F));
  model.base_color_texture = read_base_color(source, textures);
  model.roughness = share("Pr", 1.0);
  model.metallic = share("Pm", 0.0);
  model.metallic_roughness_texture =
      textures.read_metallic_roughness(source.find_map("map_Pr"), source.find_map("map_Pm"));
  model.normal_texture = read_normals(source, textures);
  if (const MtlMap* normals = source.find_map("norm")) model.normal_scale = static_cast<float>(normals->strength);
  return model;
}

Phong phong_of_mtl(const MtlMaterial& source, ObjTextures& textures, LoadReport& report) {
  const double illum = illum_of(source);
  Phong phong;
  phong.diffuse = color_from(source, "Kd", 0.8);
  phong.ambient = source.numbers.contains("Ka") ? vec3(source.find("Ka", 0.0)) : phong.diffuse;
  phong.diffuse_texture = read_base_color(source, textures);
  phong.normal_texture = read_normals(source, textures);
  if (illum >= 2.0) {
    phong.specular = color_from(source, "Ks", 0.0);
    phong.shininess = static_cast<float>(source.find("Ns", 0.0).x);
    phong.specular_texture = textures.read_slot(source.find_map("map_Ks"), ImageUse::kColor);
  }
  if (illum >= 3.0 && illum < 10.0) phong.reflection = phong.specular;
  if (is_filtering(source)) {
    warn_of_unused_maps(source, {"map_d"}, report);
    // A material that refracts although its d is 1 (opaque) is pure glass.
    const double through = opacity_of(source) < 1.0F ? 1.0 - static_cast<double>(opacity_of(source)) : 1.0;
    phong.transmission = vec3(through * glm::clamp(source.find("Tf", 1.0), dvec3(0.0), dvec3(kMaxCoordinate)));
  }
  phong.fresnel = illum == 5.0 || illum == 7.0;
  if (is_refracting(source) || phong.fresnel) {
    // The default is the index of glass.
    const double ior = source.find("Ni", kGlass).x;
    phong.ior = static_cast<float>(is_index(ior) ? ior : kGlass);
  }
  return phong;
}

/// Makes the material of illum 0: the colour of Kd, to which Ke is added.
void make_colored(const MtlMaterial& source, ObjTextures& textures, Material& material, LoadReport& report) {
  warn_of_unused_maps(source, {"map_Ks", "map_Ke", "norm", "bump"}, report);
  material.emissive = vec3(source.find("Ke", 0.0));
  const vec3 color = color_from(source, "Kd", 0.8);
  if (const TextureSlot slot = read_base_color(source, textures); slot.exists()) {
    material.model = Unlit{color, slot};
    return;
  }
  material.emissive += color;
  material.phong().ambient = material.phong().diffuse = vec3(0.0F);
}

void warn_about_ignored_lines(const MtlMaterial& source, LoadReport& report) {
  const std::string title = "material " + quote(source.name);
  if (opacity_of(source) == 1.0F && (illum_of(source) == 4.0 || illum_of(source) == 9.0)) {
    report.warn(title + " is glass (illum " + std::to_string(static_cast<int>(illum_of(source))) +
                ") and has a d of 1; promin draws it opaque");
  }
  const bool is_bending = is_refracting(source) || illum_of(source) == 5.0;
  if (is_bending && source.numbers.contains("Ni") && !is_index(source.find("Ni", kGlass).x)) {
    report.warn(title + ": its Ni is not an index of refraction; promin uses 1.5");
  }
  if (illum_of(source) == 10.0) report.warn(title + " has illum 10 (only shadows); promin draws it like illum 2");
  // Most exporters name the same file for map_Ka and map_Kd.
  const MtlMap* ambient = source.find_map("map_Ka");
  const MtlMap* diffuse = source.find_map("map_Kd");
  if (ambient != nullptr && (diffuse == nullptr || diffuse->file != ambient->file)) {
    report.warn(title + ": its map_Ka is ignored; ambient light uses map_Kd");
  }
}

/// Returns the folder of a file relative to the scene's folder, with a slash at its end; empty if both are the same.
std::string folder_of(const std::filesystem::path& file, const std::filesystem::path& scene) {
  const std::filesystem::path folder = file.lexically_relative(scene.parent_path()).parent_path();
  return folder.empty() || folder == "." ? "" : folder.string() + "/";
}

/// Returns the materials of a file of this name beside the scene; empty if the file cannot be read.
std::vector<MtlMaterial> read_mtl_file(const std::string& name, LoadReport& report) {
  const auto file = find_beside_scene(name, "mtllib " + name, true, report);
  if (!file) return {};
  try {
    const std::vector<std::byte> bytes = read_file(*file);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string short_name = file->filename().string();
    std::vector<MtlMaterial> materials = parse_mtl(text, short_name, folder_of(*file, report.file()), report);
    settle_transparency(materials, short_name, report);
    return materials;
  } catch (const InputError& error) {
    report.warn("the material file " + quote(name) + " is ignored: " + error.problems().front().what);
  }
  return {};
}

}  // namespace

std::map<std::string, MtlMaterial> read_mtl_files(const std::vector<std::string>& libraries, LoadReport& report) {
  std::map<std::string, MtlMaterial> materials;
  for (const std::string& library : libraries) {
    for (const std::string& file : find_library(library, report)) {
      for (MtlMaterial& source : read_mtl_file(file, report)) {
        warn_about_ignored_lines(source, report);
        materials.emplace(source.name, std::move(source));
      }
    }
  }
  // If no material has the whole name, the code looks for the name without a comment.
  std::map<std::string, MtlMaterial> shorter;
  for (const auto& [name, source] : materials) shorter.emplace(without_comment(name), source);
  for (auto& [name, source] : shorter) source.name = name;
  materials.merge(shorter);
  return materials;
}

void add_obj_material(const MtlMaterial& source, ObjTextures& textures, Scene& scene, LoadReport& report) {
  Material& material = scene.materials.emplace_back();
  material.name = source.name;
  take_alpha(source, material, report);
  if (is_metallic_roughness(source)) {
    warn_of_unused_maps(source, {"map_Ks"}, report);
    material.model = metallic_roughness_of_mtl(source, textures);
  } else if (illum_of(source) == 0.0) {
    make_colored(source, textures, material, report);
    return;
  } else {
    material.model = phong_of_mtl(source, textures, report);
  }
  material.emissive = color_from(source, "Ke", 0.0);
  material.emissive_texture = textures.read_slot(source.find_map("map_Ke"), ImageUse::kColor);
}

}  // namespace promin
