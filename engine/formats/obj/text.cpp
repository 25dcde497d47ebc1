// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/text.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>

#include "formats/text_lines.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Statements that other programs need and that change nothing here.
constexpr std::array<std::string_view, 1> kHarmless = {"s"};

class ObjParser {
 public:
  ObjParser(std::string_view text, LoadReport& report) : lines_(text), report_(report) {}

  ObjText parse() {
    while (lines_.advance()) {
      std::string_view line = take_statement();
      const std::string_view keyword = take_word(line);
      if (!keyword.empty()) read_statement(keyword, line);
    }
    if (ignored_count_ > 0) {
      report_.warn(std::to_string(ignored_count_) + " statements of OBJ are ignored, the first is " + first_ignored_);
    }
    refuse_indices_past_the_end();
    forget_uvs_past_the_end();
    if (!out_.colors.empty()) out_.colors.resize(out_.positions.size(), vec3(1.0F));
    return std::move(out_);
  }

 private:
  /// The line at hand, and those in which it goes on behind a backslash at its end. Comments do not: they may end in
  /// the path of a folder.
  std::string_view take_statement() {
    std::string_view line = lines_.line();
    if (!line.ends_with('\\') || line.find('#') != std::string_view::npos) return line;
    joined_.clear();
    while (line.ends_with('\\')) {
      joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      if (!lines_.advance()) return joined_;
      line = lines_.line();
    }
    return joined_.append(line);
  }

  void read_statement(std::string_view keyword, std::string_view rest) {
    if (keyword == "v") {
      read_vertex(rest);
    } else if (keyword == "vt") {
      read_uv(rest);
    } else if (keyword == "vn") {
      read_normal(rest);
    } else if (keyword == "f") {
      read_face(rest);
    } else if (keyword == "o" || keyword == "g") {
      is_group_open_ = false;
      group_name_ = trim(rest);
    } else if (keyword == "usemtl") {
      use_material(std::string(trim(rest)));
    } else if (keyword == "mtllib") {
      out_.libraries.emplace_back(trim(rest));
    } else if (keyword == "l" || keyword == "p") {
      report_.warn("lines and points are not drawn");
    } else if (std::find(kHarmless.begin(), kHarmless.end(), keyword) == kHarmless.end() && ignored_count_++ == 0) {
      first_ignored_ = quote(keyword) + " in " + lines_.place();
    }
  }

  void refuse(const std::string& what, const std::string& cure) { report_.refuse(what, lines_.place(), cure); }

  /// Reads the numbers of a line into `numbers`; their count, or nullopt once a problem is reported.
  std::optional<size_t> read_numbers(std::string_view rest, std::array<double, 6>& numbers) {
    size_t count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      const std::optional<double> number = parse_number(word);
      if (!number || std::abs(*number) > kMaxCoordinate) {
        refuse(quote(word) + " is no number up to 1e15", "write it with a decimal point");
        return std::nullopt;
      }
      if (count < numbers.size()) numbers[count] = *number;
    }
    return count;
  }

  /// x y z, maybe a weight or a colour.
  void read_vertex(std::string_view rest) {
    std::array<double, 6> n{};
    const std::optional<size_t> count = read_numbers(rest, n);
    if (count && *count != 3 && *count != 4 && *count != 6) {
      refuse("a vertex has " + std::to_string(*count) + " numbers", "give it x y z, or x y z red green blue");
    }
    out_.positions.emplace_back(dvec3(n[0], n[1], n[2]) - report_.center());
    if (count != 6U) return;
    if (n[3] < 0.0 || n[4] < 0.0 || n[5] < 0.0) refuse("a vertex colour is negative", "use numbers from 0");
    out_.colors.resize(out_.positions.size() - 1, vec3(1.0F));
    out_.colors.emplace_back(n[3], n[4], n[5]);
  }

  /// u, and mostly v; a third number is for textures of three dimensions. Files for which textures do not matter may
  /// hold anything.
  void read_uv(std::string_view rest) {
    dvec2 uv(0.0);
    for (int i = 0; i < 2; ++i) {
      const std::string_view word = take_word(rest);
      if (word.empty() && i > 0) break;
      const std::optional<double> number = parse_number(word);
      if (number && std::abs(*number) <= kMaxCoordinate) {
        uv[i] = *number;
      } else {
        report_.warn("texture coordinates that are no numbers up to 1e15 are taken for 0");
      }
    }
    out_.uvs.push_back(uv);
  }

  void read_normal(std::string_view rest) {
    std::array<double, 6> n{};
    const std::optional<size_t> count = read_numbers(rest, n);
    if (count && *count != 3) refuse("a normal has " + std::to_string(*count) + " numbers", "give it x y z");
    out_.normals.emplace_back(n[0], n[1], n[2]);
  }

  void read_face(std::string_view rest) {
    const size_t first = out_.corners.size();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      ObjCorner corner;
      if (!read_corner(word, corner)) {
        out_.corners.resize(first);
        return;
      }
      out_.corners.push_back(corner);
    }
    const size_t count = out_.corners.size() - first;
    if (count < 3 || count > kMaxPolygonCorners) {
      refuse("a face has " + std::to_string(count) + " corners",
             "give it 3 to " + std::to_string(kMaxPolygonCorners) + ", on one line");
      return;
    }
    if (!is_group_open_) {
      out_.groups.push_back({group_name_, static_cast<uint32_t>(out_.faces.size()), 0});
      is_group_open_ = true;
    }
    ++out_.groups.back().face_count;
    out_.faces.push_back({static_cast<uint32_t>(first), static_cast<uint32_t>(count), material_});
  }

  /// "1", "1/2", "1//3" or "1/2/3": position, texture coordinate, normal.
  bool read_corner(std::string_view word, ObjCorner& corner) {
    const std::string_view whole = word;
    std::array<std::string_view, 3> parts{};
    for (size_t i = 0; i < 3; ++i) {
      const size_t end = std::min(word.find('/'), word.size());
      parts[i] = word.substr(0, end);
      word.remove_prefix(std::min(end + 1, word.size()));
    }
    bool is_good = word.empty() && read_index(parts[0], out_.positions.size(), last_position_, corner.position);
    if (is_good && !parts[1].empty()) is_good = read_uv_index(parts[1], corner.uv);
    if (is_good && !parts[2].empty()) {
      is_good = read_index(parts[2], out_.normals.size(), last_normal_, corner.normal);
    }
    if (!is_good) {
      refuse(quote(whole) + " is no corner of a face", "use indices from 1, or from -1 back to the first vertex");
    }
    return is_good;
  }

  /// An index as OBJ writes it: from 1 on, or from -1 backwards from the current place. Vertices may follow the faces
  /// that use them, so the upper end is checked last.
  struct LastIndex {
    uint32_t index = 0;
    std::string place = {};
  };
  bool read_index(std::string_view word, size_t count_so_far, LastIndex& last, uint32_t& index) {
    const std::optional<int64_t> written = parse_integer(word);
    if (!written || *written == 0 || *written >= int64_t{kNoObjIndex}) return false;
    const int64_t from_zero = *written > 0 ? *written - 1 : static_cast<int64_t>(count_so_far) + *written;
    if (from_zero < 0) return false;
    index = static_cast<uint32_t>(from_zero);
    if (index >= count_so_far && index >= last.index) last = {index, lines_.place()};
    return true;
  }

  /// False where it is no number; where there are no such coordinates, the corner stays without.
  bool read_uv_index(std::string_view word, uint32_t& index) {
    const std::optional<int64_t> written = parse_integer(word);
    if (!written) return false;
    const int64_t from_zero = *written > 0 ? *written - 1 : static_cast<int64_t>(out_.uvs.size()) + *written;
    if (*written != 0 && from_zero >= 0 && from_zero < int64_t{kNoObjIndex}) index = static_cast<uint32_t>(from_zero);
    return true;
  }

  void forget_uvs_past_the_end() {
    for (ObjCorner& corner : out_.corners) {
      if (corner.uv >= out_.uvs.size()) corner.uv = kNoObjIndex;
    }
  }

  void refuse_indices_past_the_end() {
    const auto check = [&](const LastIndex& last, size_t count, const char* what) {
      if (last.place.empty() || last.index < count) return;
      report_.refuse("index " + std::to_string(uint64_t{last.index} + 1) + " is out of range, there are " +
                         std::to_string(count) + " " + what,
                     last.place, "use an index up to their number");
    };
    check(last_position_, out_.positions.size(), "vertices");
    check(last_normal_, out_.normals.size(), "normals");
  }

  void use_material(const std::string& name) {
    const auto [known, is_new] = materials_.emplace(name, static_cast<uint32_t>(out_.material_names.size()));
    if (is_new) out_.material_names.push_back(name);
    material_ = known->second;
  }

  TextLines lines_;
  /// A statement of several lines.
  std::string joined_;
  LoadReport& report_;
  ObjText out_;
  std::string group_name_;
  bool is_group_open_ = false;
  uint32_t material_ = kNoObjIndex;
  std::unordered_map<std::string, uint32_t> materials_;
  LastIndex last_position_;
  LastIndex last_normal_;
  uint64_t ignored_count_ = 0;
  std::string first_ignored_;
};

}  // namespace

ObjText parse_obj_text(std::string_view text, LoadReport& report) {
  if (text.find('\0') != std::string_view::npos) {
    report.refuse("the file is not text", "", "name a Wavefront OBJ file");
    return {};
  }
  return ObjParser(text, report).parse();
}

}  // namespace promin
