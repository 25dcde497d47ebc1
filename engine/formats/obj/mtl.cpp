// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Statements with factors of light, which are checked.
constexpr std::array<std::string_view, 8> kFactors = {"Ka", "Kd", "Ks", "Ke", "Ns", "illum", "Pr", "Pm"};
/// Statements that others write without much care: what is no number counts as what is given here.
struct LenientNumber {
  std::string_view keyword;
  double otherwise;
};
constexpr std::array<LenientNumber, 4> kLenient = {{{"d", 1.0}, {"Tr", 0.0}, {"Tf", 1.0}, {"Ni", 0.0}}};
constexpr std::array<std::string_view, 8> kMaps = {"map_Ka", "map_Kd", "map_d",  "map_Ks",
                                                   "map_Ke", "map_Pr", "map_Pm", "norm"};
/// Maps of another name, and heights, which are no normals.
constexpr std::array<std::string_view, 3> kOtherMaps = {"disp", "decal", "refl"};
constexpr std::array<std::string_view, 3> kHeights = {"map_Bump", "map_bump", "bump"};

template <size_t Count>
bool is_among(const std::array<std::string_view, Count>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

/// An option of a map, and how many words may follow it; where they are numbers, fewer may.
struct MapOption {
  std::string_view name;
  int word_count;
  bool has_numbers;
};
constexpr std::array<MapOption, 13> kOptions = {{{"-blendu", 1, false},
                                                 {"-blendv", 1, false},
                                                 {"-cc", 1, false},
                                                 {"-clamp", 1, false},
                                                 {"-imfchan", 1, false},
                                                 {"-type", 1, false},
                                                 {"-bm", 1, true},
                                                 {"-boost", 1, true},
                                                 {"-mm", 2, true},
                                                 {"-o", 3, true},
                                                 {"-s", 3, true},
                                                 {"-t", 3, true},
                                                 {"-texres", 1, true}}};

const MapOption* find_option(std::string_view word) {
  const auto found = std::ranges::find(kOptions, word, &MapOption::name);
  return found == kOptions.end() ? nullptr : &*found;
}

/// The rest of a map's line: options with their words, then the file's name, which may hold spaces.
class MapParser {
 public:
  explicit MapParser(std::string_view rest) : rest_(trim(rest)) {}

  MtlMap parse() {
    for (;;) {
      std::string_view rest = rest_;
      const MapOption* option = find_option(take_word(rest));
      if (option == nullptr) break;
      rest_ = rest;
      take_option(*option);
    }
    map_.file = trim(rest_);
    std::ranges::replace(map_.file, '\\', '/');
    return std::move(map_);
  }

 private:
  void take_option(const MapOption& option) {
    // What is left out keeps its default.
    dvec3 numbers = option.name == "-s" ? dvec3(1.0) : dvec3(0.0);
    for (int i = 0; i < option.word_count; ++i) {
      std::string_view rest = rest_;
      const std::string_view word = take_word(rest);
      const std::optional<double> number = parse_number(word);
      // The last word is the file's name, even where it is a number.
      if (trim(rest).empty() || (option.has_numbers && !number)) break;
      rest_ = rest;
      if (option.name == "-clamp") map_.is_clamped = word == "on";
      if (number && std::abs(*number) <= kMaxCoordinate) numbers[i] = *number;
    }
    if (option.name == "-s") map_.scale = dvec2(numbers);
    if (option.name == "-o") map_.offset = dvec2(numbers);
    if (option.name == "-bm") map_.strength = numbers.x;
  }

  std::string_view rest_;
  MtlMap map_;
};

class MtlParser {
 public:
  MtlParser(std::string_view text, const std::string& name, const std::string& folder, LoadReport& report)
      : lines_(text), name_(name), folder_(folder), report_(report) {}

  std::vector<MtlMaterial> parse() {
    while (lines_.advance()) {
      std::string_view rest = lines_.line();
      const std::string keyword(take_word(rest));
      if (keyword == "newmtl") begin_material(std::string(trim(rest)));
      const auto lenient = std::ranges::find(kLenient, std::string_view(keyword), &LenientNumber::keyword);
      if (lenient != kLenient.end()) read_lenient(*lenient, rest);
      if (is_among(kFactors, keyword)) read_factors(keyword, rest);
      if (is_among(kMaps, keyword)) {
        read_map(keyword, rest);
      } else if (keyword.starts_with("map_") || is_among(kOtherMaps, keyword) || is_among(kHeights, keyword)) {
        ignore_map(keyword);
      }
    }
    materials_.erase(materials_.begin());
    return std::move(materials_);
  }

 private:
  void begin_material(std::string name) {
    materials_.push_back({.name = std::move(name)});
    has_ignored_map_ = false;
  }

  void read_lenient(const LenientNumber& number, std::string_view rest) {
    dvec3 numbers(number.otherwise);
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty() && count < 3; word = take_word(rest)) {
      // The opacity of what is seen edge-on, which is drawn as that of all.
      if (word == "-halo") continue;
      numbers[count++] = parse_number(word).value_or(number.otherwise);
    }
    if (count > 0) materials_.back().numbers[std::string(number.keyword)] = count == 1 ? dvec3(numbers.x) : numbers;
  }

  /// A fault in the current line.
  void repair(const std::string& what, std::string_view value, const char* cure, const char* repair) {
    report_.repair({what, quote(value), "mtllib " + name_ + " " + lines_.place(), cure, repair});
  }

  /// A statement with a word that is no number is left out; a negative factor is 0, one beyond all light the most.
  void read_factors(const std::string& keyword, std::string_view rest) {
    dvec3 numbers(0.0);
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      const std::optional<double> number = parse_number(word);
      if (!number) {
        return repair(keyword + " has a word that is no number", word, "use numbers from 0, with a decimal point",
                      "the statement is left out");
      }
      const double clamped = std::clamp(*number, 0.0, double{kMaxCoordinate});
      if (clamped != *number) {
        repair(keyword + " is negative or beyond 1e15", word, "use numbers from 0 to 1e15", "it is clamped");
      }
      if (count < 3) numbers[count] = clamped;
    }
    if (count > 0) materials_.back().numbers[keyword] = count == 1 ? dvec3(numbers.x) : numbers;
  }

  void read_map(const std::string& keyword, std::string_view rest) {
    MtlMap map = MapParser(rest).parse();
    if (map.file.empty() || map.file.starts_with("# ")) return;
    map.folder = folder_;
    materials_.back().maps[keyword] = std::move(map);
  }

  void ignore_map(const std::string& keyword) {
    if (is_among(kHeights, keyword)) {
      report_.warn("bump maps, which hold heights, are ignored: name maps of normals by norm");
      return;
    }
    if (std::exchange(has_ignored_map_, true)) return;
    report_.warn("material " + quote(materials_.back().name) + ": some of its texture maps are ignored, the first is " +
                 keyword + " in " + name_ + " " + lines_.place());
  }

  TextLines lines_;
  const std::string& name_;
  const std::string& folder_;
  LoadReport& report_;
  /// Statements before the first material belong to none, but they are checked like the rest.
  std::vector<MtlMaterial> materials_ = std::vector<MtlMaterial>(1);
  bool has_ignored_map_ = false;
};

}  // namespace

dvec3 MtlMaterial::find(const std::string& keyword, double otherwise) const {
  const auto found = numbers.find(keyword);
  return found == numbers.end() ? dvec3(otherwise) : found->second;
}

const MtlMap* MtlMaterial::find_map(const std::string& keyword) const {
  const auto found = maps.find(keyword);
  return found == maps.end() || !found->second.is_usable ? nullptr : &found->second;
}

std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                   LoadReport& report) {
  return MtlParser(text, name, folder, report).parse();
}

}  // namespace promin
