// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/text.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <unordered_map>

#include "formats/text_lines.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Statements that other programs need and that change nothing here.
constexpr std::array<std::string_view, 1> kHarmless = {"s"};
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

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
    forget_normals_past_the_end();
    if (!bad_positions_.empty()) leave_out_faces_of_bad_positions();
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

  /// A fault in the current line.
  void repair(const char* what, std::string_view value, const char* cure, const char* repair) {
    report_.repair({what, value.empty() ? "" : quote(value), lines_.place(), cure, repair});
  }

  /// The numbers of a line, of which no more than these are kept.
  struct Numbers {
    std::array<double, 6> values{};
    /// Also of those that are not kept.
    size_t count = 0;
    /// The first word that is no number up to 1e15, and its place; empty where all are.
    std::string_view bad_word = {};
    size_t first_bad = std::numeric_limits<size_t>::max();
  };

  static Numbers read_numbers(std::string_view rest) {
    Numbers numbers;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++numbers.count) {
      const std::optional<double> number = parse_number(word);
      const bool is_good = number && std::abs(*number) <= kMaxCoordinate;
      if (!is_good && numbers.bad_word.empty()) {
        numbers.bad_word = word;
        numbers.first_bad = numbers.count;
      }
      if (numbers.count < numbers.values.size()) numbers.values[numbers.count] = is_good ? *number : kNotANumber;
    }
    return numbers;
  }

  /// x y z, maybe a weight, or a colour and its alpha.
  void read_vertex(std::string_view rest) {
    const Numbers numbers = read_numbers(rest);
    const auto& n = numbers.values;
    if (numbers.count < 3 || numbers.first_bad < 3) {
      out_.positions.emplace_back(kNotANumber);
      bad_positions_.push_back({static_cast<uint32_t>(out_.positions.size() - 1), lines_.number()});
    } else {
      out_.positions.emplace_back(n[0], n[1], n[2]);
    }
    if (numbers.count >= 6) return add_color(vec3(n[3], n[4], n[5]));
    if (numbers.count == 5) {
      repair("a vertex has 5 numbers", "", "give it x y z, or x y z red green blue", "x y z count");
    }
  }

  void add_color(vec3 color) {
    const bool is_number = color.x == color.x && color.y == color.y && color.z == color.z;
    if (!is_number) {
      repair("a vertex colour is no number", "", "use numbers from 0", "the vertex is white");
      color = vec3(1.0F);
    }
    if (color.x < 0.0F || color.y < 0.0F || color.z < 0.0F) {
      repair("a vertex colour is negative", "", "use numbers from 0", "it counts as 0");
      color = glm::max(color, vec3(0.0F));
    }
    out_.colors.resize(out_.positions.size() - 1, vec3(1.0F));
    out_.colors.push_back(color);
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

  /// What is no number matters where a face uses it.
  void read_normal(std::string_view rest) {
    const Numbers numbers = read_numbers(rest);
    const auto& n = numbers.values;
    out_.normals.push_back(numbers.count < 3 ? vec3(kNotANumber) : vec3(n[0], n[1], n[2]));
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
    if (count < 3) {
      out_.corners.resize(first);
      return repair("a face has fewer than 3 corners", "", "give it 3 corners or more, on one line",
                    "the face is left out");
    }
    if (count > kMaxPolygonCorners) {
      return refuse("a face has " + std::to_string(count) + " corners",
                    "give it up to " + std::to_string(kMaxPolygonCorners));
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
    const bool is_good = word.empty() && read_index(parts[0], out_.positions.size(), last_position_, corner.position);
    if (is_good && !parts[1].empty()) corner.uv = read_optional_index(parts[1], out_.uvs.size());
    if (is_good && !parts[2].empty()) corner.normal = read_optional_index(parts[2], out_.normals.size());
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

  /// An index of texture coordinates or normals. Where it leads nowhere, it is one that is past the end for sure.
  static uint32_t read_optional_index(std::string_view word, size_t count_so_far) {
    constexpr uint32_t kNowhere = kNoObjIndex - 1;
    const int64_t written = parse_integer(word).value_or(0);
    const int64_t from_zero = written > 0 ? written - 1 : static_cast<int64_t>(count_so_far) + written;
    const bool is_index = written != 0 && from_zero >= 0 && from_zero < int64_t{kNowhere};
    return is_index ? static_cast<uint32_t>(from_zero) : kNowhere;
  }

  void forget_uvs_past_the_end() {
    for (ObjCorner& corner : out_.corners) {
      if (corner.uv >= out_.uvs.size()) corner.uv = kNoObjIndex;
    }
  }

  /// A face whose corners have no normals, or not all of them, is drawn sharp.
  void forget_normals_past_the_end() {
    for (size_t i = 0; i < out_.faces.size(); ++i) {
      bool is_past_the_end = false;
      for (ObjCorner& corner : corners_of(out_.faces[i])) {
        if (corner.normal == kNoObjIndex || corner.normal < out_.normals.size()) continue;
        corner.normal = kNoObjIndex;
        is_past_the_end = true;
      }
      if (!is_past_the_end) continue;
      report_.repair({"a face names a normal that is not there", "", "face " + std::to_string(i + 1),
                      "export the mesh again", "the face is drawn sharp"});
    }
  }

  std::span<ObjCorner> corners_of(const ObjFace& face) {
    return std::span(out_.corners).subspan(face.first_corner, face.corner_count);
  }

  bool has_positions(const ObjFace& face) {
    for (const ObjCorner& corner : corners_of(face)) {
      const vec3& position = out_.positions[corner.position];
      if (position.x == position.x && position.y == position.y && position.z == position.z) continue;
      const auto line = std::ranges::lower_bound(bad_positions_, corner.position, {}, &BadPosition::index)->line;
      report_.repair({"a face has a vertex coordinate that is no number up to 1e15", "", "line " + std::to_string(line),
                      "give the vertex x y z", "the face is left out"});
      return false;
    }
    return true;
  }

  void leave_out_faces_of_bad_positions() {
    std::vector<ObjFace> kept;
    for (ObjGroup& group : out_.groups) {
      const auto first = static_cast<uint32_t>(kept.size());
      for (uint32_t i = 0; i < group.face_count; ++i) {
        const ObjFace& face = out_.faces[group.first_face + i];
        if (has_positions(face)) kept.push_back(face);
      }
      group.first_face = first;
      group.face_count = static_cast<uint32_t>(kept.size()) - first;
    }
    out_.faces = std::move(kept);
    std::erase_if(out_.groups, [](const ObjGroup& group) { return group.face_count == 0; });
  }

  void refuse_indices_past_the_end() {
    if (last_position_.place.empty() || last_position_.index < out_.positions.size()) return;
    report_.refuse("index " + std::to_string(uint64_t{last_position_.index} + 1) + " is out of range, there are " +
                       std::to_string(out_.positions.size()) + " vertices",
                   last_position_.place, "use an index up to their number");
    // Nothing looks up what is not there.
    out_.faces.clear();
    out_.groups.clear();
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
  struct BadPosition {
    uint32_t index;
    uint64_t line;
  };
  /// By rising index.
  std::vector<BadPosition> bad_positions_;
  uint64_t ignored_count_ = 0;
  std::string first_ignored_;
};

}  // namespace

ObjText parse_obj_text(std::string_view text, LoadReport& report) {
  text = without_zero_bytes_at_end(text);
  if (text.find('\0') != std::string_view::npos) {
    report.refuse("the file is not text", "", "name a Wavefront OBJ file");
    return {};
  }
  return ObjParser(text, report).parse();
}

}  // namespace promin
