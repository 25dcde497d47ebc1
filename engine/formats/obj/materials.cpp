// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/materials.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>

#include "core/file.h"
#include "formats/obj/text_lines.h"
#include "formats/scene_path.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// tinyobjloader takes what a material leaves out for black, illum 0 and Ns 1: state the defaults first.
constexpr const char* kDefaults = "Ka -1 -1 -1\nKd 0.8 0.8 0.8\nillum 2\nNs 0\n";
constexpr std::array<std::string_view, 6> kNumeric = {"Ka", "Kd", "Ks", "Ke", "Ns", "illum"};

bool is_map(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> kOthers = {"bump", "disp", "decal", "norm", "refl"};
  return keyword.starts_with("map_") || std::find(kOthers.begin(), kOthers.end(), keyword) != kOthers.end();
}

/// The files that a mtllib line names: all of it, as names may hold spaces, or else each word.
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

/// An MTL file as tinyobjloader is to see it: defaults stated, numbers checked, which it would read as 0, and its
/// materials numbered, because its versions differ in what they take of a name with spaces.
struct PreparedMtl {
  std::string text;
  std::vector<std::string> names;
};

PreparedMtl prepare(std::string_view text, const std::string& file, LoadReport& report) {
  PreparedMtl prepared;
  std::string_view material;
  bool has_maps = false;
  TextLines lines(text);
  while (lines.advance()) {
    std::string_view rest = lines.line();
    const std::string_view keyword = take_word(rest);
    if (keyword == "newmtl") {
      material = trim(rest);
      has_maps = false;
      prepared.text += "newmtl " + std::to_string(prepared.names.size()) + '\n' + kDefaults;
      prepared.names.emplace_back(material);
      continue;
    }
    prepared.text.append(lines.line());
    // Of a colour with one number, that is all three: tinyobjloader would take the others for 0.
    std::string_view numbers = rest;
    const std::string_view first = take_word(numbers);
    const bool is_color = keyword.size() == 2 && keyword[0] == 'K';
    if (is_color && !first.empty() && trim(numbers).empty())
      prepared.text.append(" ").append(first).append(" ").append(first);
    prepared.text += '\n';
    if (is_map(keyword) && !has_maps) {
      has_maps = true;
      report.warn("material " + quote(material) + ": its texture maps are ignored, the first is " +
                  std::string(keyword) + " in " + file + " " + lines.place());
    }
    if (std::find(kNumeric.begin(), kNumeric.end(), keyword) == kNumeric.end()) continue;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      const std::optional<double> number = parse_number(word);
      if (number && *number >= 0.0 && *number <= kMaxCoordinate) continue;
      report.refuse(quote(word) + " is no factor of light", "mtllib " + file + " " + lines.place(),
                    "use numbers from 0, with a decimal point");
    }
  }
  return prepared;
}

vec3 rgb(const tinyobj::real_t* v) {
  return {v[0], v[1], v[2]};
}

Material make_material(const tinyobj::material_t& source) {
  Material material;
  material.name = source.name;
  material.diffuse = rgb(source.diffuse);
  material.ambient = source.ambient[0] < 0 ? material.diffuse : rgb(source.ambient);
  material.emissive = rgb(source.emission);
  if (source.illum == 0) {
    material.emissive += material.diffuse;
    material.ambient = material.diffuse = vec3(0.0F);
  }
  if (source.illum >= 2) {
    material.specular = rgb(source.specular);
    material.shininess = source.shininess;
  }
  if (source.illum >= 3 && source.illum < 10) material.reflection = material.specular;
  return material;
}

void warn_about_what_is_ignored(const tinyobj::material_t& source, LoadReport& report) {
  const std::string title = "material " + quote(source.name);
  const std::array<int, 4> kTransparent = {4, 6, 7, 9};
  if (source.dissolve < 1 || std::find(kTransparent.begin(), kTransparent.end(), source.illum) != kTransparent.end()) {
    report.warn(title + " is transparent, it is drawn opaque");
  }
  if (source.illum == 10) report.warn(title + " asks for illum 10 (shadows alone), it is drawn as illum 2");
}

}  // namespace

std::map<std::string, Material> read_obj_materials(const std::vector<std::string>& libraries, LoadReport& report) {
  std::map<std::string, Material> materials;
  for (const std::string& library : libraries) {
    for (const std::filesystem::path& file : find_library(library, report)) {
      const std::vector<std::byte> bytes = read_file(file);
      const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      const PreparedMtl prepared = prepare(text, file.filename().string(), report);
      std::istringstream stream(prepared.text);
      std::map<std::string, int> indices;
      std::vector<tinyobj::material_t> sources;
      std::string warnings;
      std::string errors;
      tinyobj::LoadMtl(&indices, &sources, &stream, &warnings, &errors);
      // Without any newmtl there is still tinyobjloader's nameless default.
      if (prepared.names.empty()) sources.clear();
      for (tinyobj::material_t& source : sources) {
        source.name = prepared.names.at(std::stoul(source.name));
        warn_about_what_is_ignored(source, report);
        materials.emplace(source.name, make_material(source));
      }
    }
  }
  return materials;
}

}  // namespace promin
