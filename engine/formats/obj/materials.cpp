// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/file.h"
#include "formats/scene_path.h"
#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Statements with factors of light, which are checked; d and Tr, opacity and transparency, only lead to a warning.
constexpr std::array<std::string_view, 6> kFactors = {"Ka", "Kd", "Ks", "Ke", "Ns", "illum"};

/// A material as its lines have it.
struct MtlMaterial {
  std::string name;
  /// The values by keyword, the last of equal ones. Missing numbers are 0, but a single number is all three of a
  /// colour.
  std::map<std::string, dvec3> numbers = {};
  bool has_maps = false;

  dvec3 find(const std::string& keyword, double otherwise) const {
    const auto found = numbers.find(keyword);
    return found == numbers.end() ? dvec3(otherwise) : found->second;
  }
  double illum() const { return std::floor(find("illum", 2.0).x); }
};

bool is_map(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> kOthers = {"bump", "disp", "decal", "norm", "refl"};
  return keyword.starts_with("map_") || std::find(kOthers.begin(), kOthers.end(), keyword) != kOthers.end();
}

/// The files that a mtllib line names: the whole rest of the line, because names may hold spaces, or else each word.
std::vector<std::filesystem::path> find_library(const std::string& line, LoadReport& report) {
  const std::string place = "mtllib " + line;
  if (const auto file = find_beside_scene(line, place, false, report)) return {*file};
  std::vector<std::filesystem::path> files;
  std::string_view rest = line;
  for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
    if (const auto file = find_beside_scene(std::string(word), place, false, report)) {
      files.push_back(*file);
    } else {
      report.warn("the material file " + quote(word) + " does not exist: its materials are grey");
    }
  }
  return files;
}

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& file, LoadReport& report) {
  // Statements before the first material belong to none, but they are checked like the rest.
  std::vector<MtlMaterial> materials(1);
  TextLines lines(text);
  while (lines.advance()) {
    std::string_view rest = lines.line();
    const std::string keyword(take_word(rest));
    if (keyword == "newmtl") materials.push_back({.name = std::string(trim(rest))});
    MtlMaterial& material = materials.back();
    if (is_map(keyword) && !std::exchange(material.has_maps, true)) {
      report.warn("material " + quote(material.name) + ": its texture maps are ignored, the first is " + keyword +
                  " in " + file + " " + lines.place());
    }
    const bool is_factor = std::find(kFactors.begin(), kFactors.end(), keyword) != kFactors.end();
    if (!is_factor && keyword != "d" && keyword != "Tr") continue;
    dvec3 numbers(0.0);
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      // The opacity of what is seen edge-on, which is drawn as that of all.
      if (keyword == "d" && word == "-halo") word = take_word(rest);
      // An opacity that is no number counts as opaque.
      const double number = parse_number(word).value_or(is_factor ? -1.0 : keyword == "d" ? 1.0 : 0.0);
      if (count < 3) numbers[count] = number;
      if (!is_factor || (number >= 0.0 && number <= kMaxCoordinate)) continue;
      report.refuse(quote(word) + " is no factor of light", "mtllib " + file + " " + lines.place(),
                    "use numbers from 0, with a decimal point");
    }
    if (count > 0) material.numbers[keyword] = count == 1 ? dvec3(numbers.x) : numbers;
  }
  materials.erase(materials.begin());
  return materials;
}

/// Where a material has both, d holds.
float opacity_of(const MtlMaterial& source) {
  const double opacity = source.numbers.contains("d") ? source.find("d", 1.0).x : 1.0 - source.find("Tr", 0.0).x;
  return static_cast<float>(std::clamp(opacity, 0.0, 1.0));
}

Material make_material(const MtlMaterial& source) {
  const double illum = source.illum();
  const dvec3 diffuse = source.find("Kd", 0.8);
  Material material;
  material.name = source.name;
  material.emissive = vec3(source.find("Ke", 0.0));
  Phong& phong = material.phong();
  phong.diffuse = vec3(diffuse);
  phong.ambient = source.numbers.contains("Ka") ? vec3(source.find("Ka", 0.0)) : vec3(diffuse);
  if (illum == 0.0) {
    material.emissive += phong.diffuse;
    phong.ambient = phong.diffuse = vec3(0.0F);
  }
  if (illum >= 2.0) {
    phong.specular = vec3(source.find("Ks", 0.0));
    phong.shininess = static_cast<float>(source.find("Ns", 0.0).x);
  }
  if (illum >= 3.0 && illum < 10.0) phong.reflection = phong.specular;
  material.alpha = opacity_of(source);
  if (material.alpha < 1.0F) material.alpha_mode = AlphaMode::kBlend;
  return material;
}

void warn_about_what_is_ignored(const MtlMaterial& source, LoadReport& report) {
  const std::string title = "material " + quote(source.name);
  const std::array<double, 4> kTransparent = {4, 6, 7, 9};
  if (opacity_of(source) == 1.0F &&
      std::find(kTransparent.begin(), kTransparent.end(), source.illum()) != kTransparent.end()) {
    report.warn(title + " is of glass (illum " + std::to_string(static_cast<int>(source.illum())) +
                "), it is drawn opaque");
  }
  if (source.illum() == 10.0) report.warn(title + " asks for illum 10 (shadows alone), it is drawn as illum 2");
}

}  // namespace

std::map<std::string, Material> read_obj_materials(const std::vector<std::string>& libraries, LoadReport& report) {
  std::map<std::string, Material> materials;
  for (const std::string& library : libraries) {
    for (const std::filesystem::path& file : find_library(library, report)) {
      const std::vector<std::byte> bytes = read_file(file);
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      for (const MtlMaterial& source : parse_mtl(text, file.filename().string(), report)) {
        warn_about_what_is_ignored(source, report);
        materials.emplace(source.name, make_material(source));
      }
    }
  }
  return materials;
}

}  // namespace promin
