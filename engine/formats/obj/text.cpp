// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <unordered_map>

#include "formats/text_lines.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

constexpr const char* kNumberCure = "write numbers up to 1e15, with a decimal point";
constexpr const char* kVertexCure = "give it x y z, or x y z red green blue, as numbers with a decimal point";

/// Statements that other programs need and that have no effect here.
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
    check_faces();
    if (!out_.colors.empty()) out_.colors.resize(out_.positions.size(), vec3(1.0F));
    return std::move(out_);
  }

 private:
  /// Returns the current line, joined with the lines that follow a backslash at its end. Comments are not continued,
  /// because they may end with the path of a folder.
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
      out_.has_lines_or_points = true;
      report_.warn("lines and points are not drawn");
    } else if (std::find(kHarmless.begin(), kHarmless.end(), keyword) == kHarmless.end() && ignored_count_++ == 0) {
      first_ignored_ = quote(keyword) + " in " + lines_.place();
    }
  }

  void refuse(ProblemCode code, const std::string& what, const std::string& cure) {
    report_.refuse(code, what, lines_.place(), cure);
  }

  void repair(ProblemCode code, const std::string& what, std::string_view value, const std::string& cure,
              const std::string& repair) {
    report_.repair({code, what, value.empty() ? "" : quote(value), lines_.place(), cure, repair});
  }

  /// The numbers of a statement that were read.
  struct Numbers {
    std::array<double, 6> values{};
    /// The number of all words; only the first six are read.
    size_t word_count = 0;
    /// Number of words before the first word that is not a number up to 1e15.
    size_t good_count = 0;
    /// The first word that is not such a number.
    std::string_view bad_word = {};

    bool are_good(size_t count) const { return good_count >= count; }
  };

  static Numbers read_numbers(std::string_view rest) {
    Numbers numbers;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++numbers.word_count) {
      if (numbers.good_count == numbers.values.size() || !numbers.bad_word.empty()) continue;
      const std::optional<double> number = parse_number(word);
      if (number && std::abs(*number) <= kMaxCoordinate) {
        numbers.values[numbers.good_count++] = *number;
      } else {
        numbers.bad_word = word;
      }
    }
    return numbers;
  }

  /// A vertex whose numbers are not a position.
  struct BadVertex {
    uint32_t index = 0;
    uint64_t line = 0;
    std::string what = {};
    bool is_used = false;
  };

  /// Reads a position: x y z, possibly with a weight or a colour. Faces that use an invalid position are left out.
  void read_vertex(std::string_view rest) {
    const Numbers numbers = read_numbers(rest);
    const std::array<double, 6>& n = numbers.values;
    out_.positions.emplace_back(dvec3(n[0], n[1], n[2]) - report_.center());
    if (!numbers.are_good(3)) return add_bad_vertex(numbers);
    if (numbers.word_count >= 6) return read_color(numbers);
    if (numbers.word_count == 5 || !numbers.bad_word.empty()) {
      repair("obj.vertex.numbers", "the numbers after x y z of a vertex are neither a weight nor a colour",
             numbers.bad_word, kVertexCure, "they are ignored");
    }
  }

  void add_bad_vertex(const Numbers& numbers) {
    const std::string what = numbers.bad_word.empty()
                                 ? "a vertex has " + std::to_string(numbers.word_count) + " numbers"
                                 : quote(numbers.bad_word) + " is not a number up to 1e15";
    bad_vertices_.push_back({static_cast<uint32_t>(out_.positions.size() - 1), lines_.number(), what});
  }

  void read_color(const Numbers& numbers) {
    const std::array<double, 6>& n = numbers.values;
    if (numbers.word_count > 6) {
      repair("obj.vertex.numbers", "a vertex has more than 6 numbers", "", kVertexCure,
             "those after its colour are ignored");
    }
    vec3 color(n[3], n[4], n[5]);
    if (!numbers.are_good(6) || n[3] < 0.0 || n[4] < 0.0 || n[5] < 0.0) {
      repair("obj.color.range", "a vertex colour is not three numbers of 0 or more", numbers.bad_word,
             "use numbers of 0 or more", "white is used");
      color = vec3(1.0F);
    }
    out_.colors.resize(out_.positions.size() - 1, vec3(1.0F));
    out_.colors.push_back(color);
  }

  /// Reads a texture coordinate: u and usually v. A third number is for three-dimensional textures. A file that uses no
  /// textures may contain anything here.
  void read_uv(std::string_view rest) {
    dvec2 uv(0.0);
    for (int i = 0; i < 2; ++i) {
      const std::string_view word = take_word(rest);
      if (word.empty() && i > 0) break;
      const std::optional<double> number = parse_number(word);
      if (number && std::abs(*number) <= kMaxCoordinate) {
        uv[i] = *number;
      } else {
        repair("obj.uv.range", "a texture coordinate is not a number up to 1e15", word, kNumberCure, "0 is used");
      }
    }
    out_.uvs.push_back(uv);
  }

  void read_normal(std::string_view rest) {
    const Numbers numbers = read_numbers(rest);
    const std::array<double, 6>& n = numbers.values;
    if (!numbers.are_good(3)) {
      repair("obj.normal.range", "a normal is not three numbers up to 1e15", numbers.bad_word, kNumberCure,
             "the faces that use it are shaded flat");
      out_.normals.emplace_back(std::numeric_limits<float>::quiet_NaN());
      return;
    }
    if (numbers.word_count > 3) {
      repair("obj.normal.numbers", "a normal has more than 3 numbers", "", "write only x y z",
             "those after the third are ignored");
    }
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
    if (count < 3) {
      ++out_.small_face_count;
      out_.corners.resize(first);
      return repair("obj.face.corners", "a face has fewer than 3 corners", "", "give it 3 or more corners on one line",
                    "promin omits it");
    }
    if (count > kMaxPolygonCorners) {
      refuse("obj.face.corners", "a face has " + std::to_string(count) + " corners",
             "give it 3 to " + std::to_string(kMaxPolygonCorners) + ", on one line");
      return;
    }
    if (!is_group_open_) {
      out_.groups.push_back({group_name_, static_cast<uint32_t>(out_.faces.size()), 0});
      is_group_open_ = true;
    }
    ++out_.groups.back().face_count;
    out_.faces.push_back({static_cast<uint32_t>(first), static_cast<uint32_t>(count), material_});
    face_lines_.push_back(lines_.number());
  }

  /// Reads a corner "1", "1/2", "1//3" or "1/2/3": position, texture coordinate, normal.
  bool read_corner(std::string_view word, ObjCorner& corner) {
    const std::string_view whole = word;
    std::array<std::string_view, 3> parts{};
    for (size_t i = 0; i < 3; ++i) {
      const size_t end = std::min(word.find('/'), word.size());
      parts[i] = word.substr(0, end);
      word.remove_prefix(std::min(end + 1, word.size()));
    }
    corner.position = read_index(parts[0], out_.positions.size());
    if (!word.empty() || corner.position == kMissing) {
      refuse("obj.face.corner", quote(whole) + " is not a corner of a face",
             "use indices from 1, or from -1 back to the first vertex");
      return false;
    }
    if (!parts[1].empty()) corner.uv = read_index(parts[1], out_.uvs.size());
    if (!parts[2].empty()) corner.normal = read_index(parts[2], out_.normals.size());
    return true;
  }

  /// The value for a word that is not an index: an index one past the end.
  static constexpr uint32_t kMissing = kNoObjIndex - 1;

  /// Reads an OBJ index: from 1 on, or from -1 backwards from the current position. Vertices may follow the faces that
  /// use them, so the upper limit is checked at the end.
  static uint32_t read_index(std::string_view word, size_t count_so_far) {
    const std::optional<int64_t> written = parse_integer(word);
    if (!written || *written == 0) return kMissing;
    const int64_t from_zero = *written > 0 ? *written - 1 : static_cast<int64_t>(count_so_far) + *written;
    return from_zero >= 0 && from_zero < int64_t{kMissing} ? static_cast<uint32_t>(from_zero) : kMissing;
  }

  /// Checks all faces, after all vertices are known.
  void check_faces() {
    if (are_indices_in_range() && bad_vertices_.empty()) return;
    std::vector<bool> is_drawn(out_.faces.size(), true);
    for (size_t i = 0; i < out_.faces.size(); ++i) {
      const std::span corners(&out_.corners[out_.faces[i].first_corner], out_.faces[i].corner_count);
      is_drawn[i] = check_positions(corners, face_lines_[i]);
      if (forget_past_the_end(corners, &ObjCorner::uv, out_.uvs.size())) {
        report_.repair({"obj.uv.index", "a face refers to texture coordinates that do not exist", "",
                        place_of(face_lines_[i]), "use an index up to the number of texture coordinates",
                        "it is drawn without them"});
      }
      if (forget_past_the_end(corners, &ObjCorner::normal, out_.normals.size())) {
        report_.repair({"obj.normal.index", "a face refers to a normal that does not exist", "",
                        place_of(face_lines_[i]), "use an index up to the number of normals", "it is shaded flat"});
      }
    }
    for (const BadVertex& vertex : bad_vertices_) report_bad_vertex(vertex);
    keep_faces(is_drawn);
  }

  /// Removes the faces that are not in `is_kept`, and groups without faces.
  void keep_faces(const std::vector<bool>& is_kept) {
    std::vector<ObjFace> kept;
    for (ObjGroup& group : out_.groups) {
      const auto first = static_cast<uint32_t>(kept.size());
      for (uint32_t i = group.first_face; i < group.first_face + group.face_count; ++i) {
        if (is_kept[i]) kept.push_back(out_.faces[i]);
      }
      group.first_face = first;
      group.face_count = static_cast<uint32_t>(kept.size()) - first;
    }
    out_.faces = std::move(kept);
    std::erase_if(out_.groups, [](const ObjGroup& group) { return group.face_count == 0; });
  }

  bool are_indices_in_range() const {
    uint32_t position_end = 0;
    uint32_t uv_end = 0;
    uint32_t normal_end = 0;
    for (const ObjCorner& corner : out_.corners) {
      position_end = std::max(position_end, corner.position + 1);
      // For kNoObjIndex the sum is 0.
      uv_end = std::max(uv_end, corner.uv + 1);
      normal_end = std::max(normal_end, corner.normal + 1);
    }
    return position_end <= out_.positions.size() && uv_end <= out_.uvs.size() && normal_end <= out_.normals.size();
  }

  static std::string place_of(uint64_t line) { return "line " + std::to_string(line); }

  /// Returns whether the corners of a face are valid positions. An index without a vertex is refused.
  bool check_positions(std::span<const ObjCorner> corners, uint64_t line) {
    bool is_placed = true;
    for (const ObjCorner& corner : corners) {
      if (corner.position >= out_.positions.size()) {
        report_.refuse("obj.face.index",
                       "index " + std::to_string(uint64_t{corner.position} + 1) +
                           " is out of range, because there are only " + std::to_string(out_.positions.size()) +
                           " vertices",
                       place_of(line), "use the index of one of them");
      } else if (BadVertex* bad = find_bad_vertex(corner.position); bad != nullptr) {
        bad->is_used = true;
        if (is_placed) {
          report_.repair({"obj.position.range", "a face has a vertex that is not three numbers up to 1e15", bad->what,
                          place_of(bad->line), kVertexCure, "promin omits the face"});
        }
        is_placed = false;
      }
    }
    return is_placed;
  }

  BadVertex* find_bad_vertex(uint32_t position) {
    const auto found = std::ranges::lower_bound(bad_vertices_, position, {}, &BadVertex::index);
    return found != bad_vertices_.end() && found->index == position ? &*found : nullptr;
  }

  /// Removes indices that are `count` or larger. Returns whether there were any.
  static bool forget_past_the_end(std::span<ObjCorner> corners, uint32_t ObjCorner::*index, size_t count) {
    bool has_any = false;
    for (ObjCorner& corner : corners) {
      if (corner.*index == kNoObjIndex || corner.*index < count) continue;
      corner.*index = kNoObjIndex;
      has_any = true;
    }
    return has_any;
  }

  void report_bad_vertex(const BadVertex& vertex) {
    if (vertex.is_used) return;
    report_.repair({"obj.position.range", "a vertex that no face uses is not three numbers up to 1e15", vertex.what,
                    place_of(vertex.line), kVertexCure, "promin omits it"});
  }

  void use_material(const std::string& name) {
    const auto [known, is_new] = materials_.emplace(name, static_cast<uint32_t>(out_.material_names.size()));
    if (is_new) out_.material_names.push_back(name);
    material_ = known->second;
  }

  TextLines lines_;
  /// The joined text of a statement that has several lines.
  std::string joined_;
  LoadReport& report_;
  ObjText out_;
  std::string group_name_;
  bool is_group_open_ = false;
  uint32_t material_ = kNoObjIndex;
  std::unordered_map<std::string, uint32_t> materials_;
  /// The line of each face.
  std::vector<uint64_t> face_lines_;
  /// The vertices that are not positions, by their index.
  std::vector<BadVertex> bad_vertices_;
  uint64_t ignored_count_ = 0;
  std::string first_ignored_;
};

}  // namespace

ObjText parse_obj_text(std::string_view text, LoadReport& report) {
  text = without_zero_bytes_at_end(text);
  if (text.find('\0') != std::string_view::npos) {
    report.refuse("obj.file.kind", "the file is not text", "", "use a Wavefront OBJ file");
    return {};
  }
  return ObjParser(text, report).parse();
}

}  // namespace promin
