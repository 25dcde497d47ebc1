// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/mtl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/obj/paths.h"
#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Statements that have a colour of three numbers, and statements that have one number.
constexpr std::array<std::string_view, 5> kColors = {"Ka", "Kd", "Ks", "Ke", "Tf"};
constexpr std::array<std::string_view, 7> kNumbers = {"Ns", "illum", "Pr", "Pm", "d", "Tr", "Ni"};
/// Statements whose numbers may have any sign, because the materials clamp or check them.
constexpr std::array<std::string_view, 4> kOfAnySign = {"Tf", "d", "Tr", "Ni"};
constexpr std::array<std::string_view, 9> kMaps = {"map_Ka", "map_Kd", "map_d", "map_Ks", "map_Ke",
                                                   "map_Pr", "map_Pm", "norm",  "bump"};
/// Other names of bump.
constexpr std::array<std::string_view, 2> kBumps = {"map_Bump", "map_bump"};
/// Maps that are not read, with other names.
constexpr std::array<std::string_view, 3> kOtherMaps = {"disp", "decal", "refl"};
/// Maps of one channel.
constexpr std::array<std::string_view, 3> kScalarMaps = {"map_d", "map_Pr", "map_Pm"};

template <size_t Count>
bool is_among(const std::array<std::string_view, Count>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

/// An option of a map, and the largest number of words that follow it. There may be fewer words if they are numbers.
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

/// Parses the rest of a map's line: options with their words, then the file's name, which may contain spaces.
class MapParser {
 public:
  MapParser(const std::string& keyword, std::string_view rest, LoadReport& report)
      : keyword_(keyword), rest_(trim(rest)), report_(report) {}

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
    map_.strength *= gain_;
    return std::move(map_);
  }

 private:
  void take_option(const MapOption& option) {
    // Numbers that are left out keep their default.
    dvec3 numbers = option.name == "-s" ? dvec3(1.0) : dvec3(0.0);
    if (option.name == "-mm") numbers.y = 1.0;
    for (int i = 0; i < option.word_count; ++i) {
      std::string_view rest = rest_;
      const std::string_view word = take_word(rest);
      const std::optional<double> number = parse_number(word);
      // The last word is the file's name, even if it is a number.
      if (trim(rest).empty() || (option.has_numbers && !number)) break;
      rest_ = rest;
      if (option.name == "-clamp") map_.is_clamped = word == "on";
      if (option.name == "-imfchan") take_channel(word);
      if (number && std::abs(*number) <= kMaxCoordinate) numbers[i] = *number;
    }
    if (option.name == "-s") map_.scale = dvec2(numbers);
    if (option.name == "-o") map_.offset = dvec2(numbers);
    if (option.name == "-bm") map_.strength = numbers.x;
    if (option.name == "-mm") take_gain(numbers);
    if (option.name == "-t" && numbers != dvec3(0.0)) ignore("-t");
  }

  void take_channel(std::string_view word) {
    const size_t channel = std::string_view("rgbml").find(word);
    const bool is_read = word.size() == 1 && channel != std::string_view::npos;
    if (is_read) map_.channel = static_cast<int>(channel);
    // In grey pictures the red channel is the luminance. For map_d the alpha channel is used if there is one.
    if (!is_read || (is_among(kScalarMaps, keyword_) && (word == "g" || word == "b"))) ignore("-imfchan");
  }

  /// Reads the gain. The base is ignored, because slopes do not depend on it.
  void take_gain(const dvec3& base_and_gain) {
    if (keyword_ == "bump") {
      gain_ = base_and_gain.y;
    } else if (dvec2(base_and_gain) != dvec2(0.0, 1.0)) {
      ignore("-mm");
    }
  }

  void ignore(const std::string& option) { report_.warn("the option " + option + " of " + keyword_ + " is ignored"); }

  const std::string& keyword_;
  std::string_view rest_;
  LoadReport& report_;
  double gain_ = 1.0;
  MtlMap map_;
};

class MtlParser {
 public:
  MtlParser(std::string_view text, const std::string& name, const std::string& folder, LoadReport& report)
      : lines_(text), name_(name), folder_(folder), report_(report) {}

  std::vector<MtlMaterial> parse() {
    while (lines_.advance()) {
      std::string_view rest = lines_.line();
      std::string keyword(take_word(rest));
      if (is_among(kBumps, keyword)) keyword = "bump";
      if (keyword == "newmtl") begin_material(std::string(trim(rest)));
      if (is_among(kColors, keyword)) read_numbers(keyword, rest, 3);
      if (is_among(kNumbers, keyword)) read_numbers(keyword, rest, 1);
      if (is_among(kMaps, keyword)) {
        read_map(keyword, rest);
      } else if (keyword.starts_with("map_") || is_among(kOtherMaps, keyword)) {
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

  std::string place() const { return "mtllib " + name_ + " " + lines_.place(); }

  void read_numbers(const std::string& keyword, std::string_view rest, int most) {
    dvec3 numbers(keyword == "Tf" ? 1.0 : 0.0);
    int count = 0;
    bool is_negative = false;
    for (std::string_view word = take_word(rest); !word.empty() && count < most; word = take_word(rest)) {
      // -halo describes the opacity at grazing angles; it is used for all angles.
      if (word == "-halo") continue;
      if (count == 0 && (word == "spectral" || word == "xyz")) return ignore_color(keyword, word);
      const std::optional<double> number = parse_number(word);
      if (!number || std::abs(*number) > kMaxCoordinate || (keyword == "illum" && *number < 0.0)) {
        return report_.repair({"mtl.number.range", keyword + " of a material is not a number from 0 to 1e15",
                               quote(word), place(), "use numbers of 0 or more, with a decimal point",
                               "promin ignores the statement"});
      }
      is_negative = is_negative || *number < 0.0;
      numbers[count++] = *number;
    }
    if (is_negative && !is_among(kOfAnySign, keyword)) {
      report_.repair({"mtl.number.range", keyword + " of a material is negative", "", place(),
                      "use numbers of 0 or more", "0 is used"});
      numbers = glm::max(numbers, dvec3(0.0));
    }
    if (count > 0) materials_.back().numbers[keyword] = count == 1 ? dvec3(numbers.x) : numbers;
  }

  /// Warns of a colour that is given as a spectral curve or as CIE XYZ, which MTL allows.
  void ignore_color(const std::string& keyword, std::string_view kind) {
    report_.warn("colours given as " + std::string(kind) + " are ignored, the first is " + keyword + " in " + place());
  }

  void read_map(const std::string& keyword, std::string_view rest) {
    MtlMap map = MapParser(keyword, rest, report_).parse();
    if (without_comment(map.file).empty()) return;
    std::optional<std::string> found = find_named_file(map.file, folder_, report_);
    if (!found) found = find_by_last_part(map.file, folder_, report_);
    map.file = found.value_or(folder_ + map.file);
    materials_.back().maps[keyword] = std::move(map);
  }

  void ignore_map(const std::string& keyword) {
    if (std::exchange(has_ignored_map_, true)) return;
    report_.warn("material " + quote(materials_.back().name) + ": some of its texture maps are ignored, the first is " +
                 keyword + " in " + name_ + " " + lines_.place());
  }

  TextLines lines_;
  const std::string& name_;
  const std::string& folder_;
  LoadReport& report_;
  /// The first element collects statements before the first material. They belong to no material but are checked.
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
  return MtlParser(without_zero_bytes_at_end(text), name, folder, report).parse();
}

}  // namespace promin
