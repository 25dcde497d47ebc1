// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/ply/body.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "core/srgb.h"
#include "formats/ply/rows.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

/// Indices of the numbers of a vertex or face that are read. All other numbers are stored in the last place.
enum Column : uint32_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kAlpha, kU, kV, kTexture, kColumnCount };
using Row = std::array<double, kColumnCount + 1>;

struct ColumnName {
  std::string_view name;
  Column column;
};
/// Colours have two sets of names, texture coordinates four.
constexpr std::array<ColumnName, 23> kColumnNames = {{{"x", kX},
                                                      {"y", kY},
                                                      {"z", kZ},
                                                      {"nx", kNx},
                                                      {"ny", kNy},
                                                      {"nz", kNz},
                                                      {"red", kRed},
                                                      {"green", kGreen},
                                                      {"blue", kBlue},
                                                      {"alpha", kAlpha},
                                                      {"diffuse_red", kRed},
                                                      {"diffuse_green", kGreen},
                                                      {"diffuse_blue", kBlue},
                                                      {"diffuse_alpha", kAlpha},
                                                      {"s", kU},
                                                      {"t", kV},
                                                      {"u", kU},
                                                      {"v", kV},
                                                      {"texture_u", kU},
                                                      {"texture_v", kV},
                                                      {"texture_s", kU},
                                                      {"texture_t", kV},
                                                      {"texnumber", kTexture}}};

uint32_t column_of(const PlyProperty& property) {
  const auto found = std::ranges::find(kColumnNames, property.name, &ColumnName::name);
  return found == kColumnNames.end() || property.is_list ? kColumnCount : found->column;
}

/// The positions of an element's properties, and the numbers that stand for full colour.
struct Layout {
  std::vector<uint32_t> columns;
  std::array<bool, kColumnCount + 1> is_there{};
  Row full{};

  explicit Layout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const uint32_t column = column_of(property);
      columns.push_back(column);
      is_there[column] = true;
      const bool is_float = property.type == PlyType::kFloat32 || property.type == PlyType::kFloat64;
      full[column] = is_float ? 1.0 : property.type == PlyType::kUint16 ? 65535.0 : 255.0;
    }
  }
  bool has_all(uint32_t first) const { return is_there[first] && is_there[first + 1] && is_there[first + 2]; }
  bool has_some(uint32_t first) const { return is_there[first] || is_there[first + 1] || is_there[first + 2]; }
  bool has_uvs() const { return is_there[kU] && is_there[kV]; }
};

template <class Rows>
class BodyReader {
 public:
  BodyReader(std::string_view file, const PlyHeader& header, LoadReport& report)
      : header_(header), rows_(file.substr(header.size_bytes), header.line_count), report_(report) {}

  PlyBody read() {
    vertex_count_ = header_.find("vertex")->row_count;
    decide_what_is_read();
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      read_element(element);
      if (!problem_.empty() || !rows_.problem().empty()) {
        report_.refuse("ply.row.wrong", problem_.empty() ? rows_.problem() : problem_, place_, "export the file again");
        return {};
      }
    }
    if (has_wild_colors_) report_.warn("vertex colours below 0 or above 1 are clamped");
    return std::move(out_);
  }

 private:
  bool is_good() const { return problem_.empty() && rows_.problem().empty(); }

  /// Data of faces is preferred to data of vertices. For colours, vertices are preferred, because there are more of
  /// them.
  void decide_what_is_read() {
    const Layout vertices(*header_.find("vertex"));
    has_normals_ = vertices.has_all(kNx);
    has_colors_ = vertices.has_all(kRed);
    warn_about_partial_colors(vertices, "vertices");
    has_uvs_ = vertices.has_uvs() && !header_.texture_files.empty();
    const PlyElement* face = header_.find("face");
    if (face == nullptr) return;
    const Layout faces(*face);
    has_face_colors_ = faces.has_all(kRed) && !has_colors_;
    warn_about_partial_colors(faces, "faces");
    if (faces.has_all(kRed) && has_colors_) {
      report_.warn("colours of faces are ignored because the vertices have colours");
    }
    has_corner_uvs_ = std::ranges::any_of(face->properties, &PlyProperty::lists_uvs) && !header_.texture_files.empty();
    if (has_corner_uvs_) has_uvs_ = false;
    has_face_textures_ = has_corner_uvs_ || (has_uvs_ && faces.is_there[kTexture]);
  }

  void warn_about_partial_colors(const Layout& layout, const std::string& owners) {
    if (!layout.has_some(kRed) || layout.has_all(kRed)) return;
    report_.warn("colours of " + owners + " are ignored because red, green or blue is missing");
  }

  void read_element(const PlyElement& element) {
    const Layout layout(element);
    if (element.name == "vertex") {
      reserve_vertices();
      read_rows(element, layout.columns, [&](const Row& row) { add_vertex(layout, row); });
    } else if (element.name == "face") {
      out_.corner_counts.reserve(element.row_count);
      out_.corners.reserve(3 * element.row_count);
      if (has_face_colors_) out_.face_colors.reserve(element.row_count);
      if (has_corner_uvs_) out_.corner_uvs.reserve(3 * element.row_count);
      read_rows(element, layout.columns, [&](const Row& row) { add_polygon(layout, row); });
    } else if (element.name == "tristrips") {
      read_rows(element, layout.columns, [&](const Row&) { add_strip(); });
    } else {
      read_rows(element, layout.columns, [](const Row&) {});
    }
  }

  template <class Take>
  void read_rows(const PlyElement& element, const std::vector<uint32_t>& columns, const Take& take) {
    Row row{};
    const bool has_positions = element.name == "vertex";
    for (uint64_t i = 0; i < element.row_count; ++i) {
      rows_.start_row();
      row_ = i;
      for (size_t p = 0; p < columns.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.is_list) {
          read_list(property);
        } else {
          const bool is_position = has_positions && columns[p] <= kZ;
          row[columns[p]] = is_position ? rows_.take(property.type) : rows_.take_any(property.type);
        }
      }
      rows_.end_row(report_);
      if (is_good()) take(row);
      if (is_good()) continue;
      place_ = place_of(element.name);
      return;
    }
  }

  /// Returns the place of the current row, for messages.
  std::string place_of(const std::string& element) const {
    return rows_.place().empty() ? element + " " + std::to_string(row_) : rows_.place();
  }

  void read_list(const PlyProperty& property) {
    const double count = rows_.take(property.count_type);
    if (!rows_.problem().empty()) return;
    if (!(count >= 0.0 && count <= static_cast<double>(rows_.most_numbers(property.type))) ||
        count != std::floor(count)) {
      problem_ = "a list is longer than the rest of the file";
      return;
    }
    const bool is_wanted = property.lists_vertices();
    std::vector<double>* list = is_wanted ? &list_ : property.lists_uvs() ? &uv_list_ : nullptr;
    if (list != nullptr) list->clear();
    for (auto i = static_cast<uint64_t>(count); i > 0 && rows_.problem().empty(); --i) {
      const double number = is_wanted ? rows_.take(property.type) : rows_.take_any(property.type);
      if (list != nullptr) list->push_back(number);
    }
  }

  void reserve_vertices() {
    out_.positions.reserve(vertex_count_);
    if (has_normals_) out_.normals.reserve(vertex_count_);
    if (has_colors_) out_.colors.reserve(vertex_count_);
    if (has_uvs_) out_.uvs.reserve(vertex_count_);
  }

  void add_vertex(const Layout& layout, const Row& row) {
    out_.positions.emplace_back(dvec3(row[kX], row[kY], row[kZ]) - report_.center());
    if (has_normals_) out_.normals.emplace_back(row[kNx], row[kNy], row[kNz]);
    if (has_colors_) out_.colors.push_back(color_of(layout, row, "vertex"));
    if (has_uvs_) out_.uvs.push_back(uv_of(row[kU], row[kV], "vertex"));
  }

  vec4 color_of(const Layout& layout, const Row& row, const char* element) {
    const auto share = [&](Column column) { return clamp(row[column] / layout.full[column], element); };
    // Reads the components in separate statements, because the order in which arguments are evaluated is unspecified.
    dvec4 color(1.0);
    color.r = decode(share(kRed));
    color.g = decode(share(kGreen));
    color.b = decode(share(kBlue));
    if (layout.is_there[kAlpha]) color.a = share(kAlpha);
    return vec4(color);
  }

  double clamp(double share, const char* element) {
    if (share >= 0.0 && share <= 1.0) return share;
    if (std::isnan(share)) {
      report_.repair(
          {"ply.color.range", "a colour is not a number", "", place_of(element), "export the mesh again", "1 is used"});
      return 1.0;
    }
    has_wild_colors_ = true;
    return share > 1.0 ? 1.0 : 0.0;
  }

  vec2 uv_of(double u, double v, const char* element) {
    // The comparison is written so that NaN fails.
    if (std::abs(u) <= kMaxCoordinate && std::abs(v) <= kMaxCoordinate) return vec2(dvec2(u, v));
    report_.repair({"ply.uv.range", "a texture coordinate is beyond 1e15 or not finite", "", place_of(element),
                    "export the mesh again", "0 is used"});
    return vec2(0.0F);
  }

  /// Most colours are bytes.
  static double decode(double share) {
    static const std::array<double, 256> kOfBytes = [] {
      std::array<double, 256> decoded{};
      for (size_t i = 0; i < decoded.size(); ++i) decoded[i] = srgb_to_linear(static_cast<double>(i) / 255.0);
      return decoded;
    }();
    const auto byte = static_cast<uint32_t>(255.0 * share + 0.5);
    return static_cast<double>(byte) / 255.0 == share ? kOfBytes[byte] : srgb_to_linear(share);
  }

  /// Returns the index that a number stands for. If it is no index, adds the problem to the report and returns nullopt.
  std::optional<uint32_t> index_of(double number) {
    if (number >= 0.0 && number < static_cast<double>(vertex_count_) && number == std::floor(number)) {
      return static_cast<uint32_t>(number);
    }
    problem_ = "a face refers to a vertex that does not exist, because there are only " + std::to_string(vertex_count_);
    return std::nullopt;
  }

  void add_polygon(const Layout& layout, const Row& row) {
    if (list_.size() > kMaxPolygonCorners) {
      problem_ = "a face has more than " + std::to_string(kMaxPolygonCorners) + " corners";
      return;
    }
    for (const double number : list_) {
      const std::optional<uint32_t> corner = index_of(number);
      if (!corner) return;
      out_.corners.push_back(*corner);
    }
    if (list_.size() < 3) {
      report_.repair({"ply.face.corners", "a face has fewer than 3 corners", "", place_of("face"), "give it 3",
                      "promin omits the face"});
      out_.corners.resize(out_.corners.size() - list_.size());
      return;
    }
    out_.corner_counts.push_back(static_cast<uint32_t>(list_.size()));
    if (has_face_colors_) out_.face_colors.push_back(color_of(layout, row, "face"));
    if (has_corner_uvs_) add_corner_uvs();
    if (has_face_textures_) out_.face_textures.push_back(texture_of(layout, row));
  }

  bool has_own_uvs() const { return uv_list_.size() == 2 * list_.size(); }

  void add_corner_uvs() {
    for (size_t i = 0; i < list_.size(); ++i) {
      out_.corner_uvs.push_back(has_own_uvs() ? uv_of(uv_list_[2 * i], uv_list_[2 * i + 1], "face") : vec2(0.0F));
    }
  }

  /// Returns the texture of a face. A face without a texture has no texture coordinates, or the texture -1.
  uint32_t texture_of(const Layout& layout, const Row& row) {
    if (has_corner_uvs_ && !has_own_uvs()) {
      if (!uv_list_.empty()) {
        report_.repair({"ply.uv.count", "a face does not have two texture coordinates for each corner", "",
                        place_of("face"), "export the mesh again", "it is drawn without a texture"});
      }
      return PlyBody::kNoTexture;
    }
    if (!layout.is_there[kTexture]) return 0;
    const double number = row[kTexture];
    if (number >= 0.0 && number < static_cast<double>(header_.texture_files.size())) {
      return static_cast<uint32_t>(number);
    }
    if (number != -1.0) {
      report_.repair({"ply.texture.index", "a face refers to a texture that does not exist", "", place_of("face"),
                      "export the mesh again", "it is drawn without a texture"});
    }
    return PlyBody::kNoTexture;
  }

  /// Adds a triangle strip. Each -1 begins another strip. Every second triangle of a strip has the opposite winding.
  void add_strip() {
    size_t first = 0;
    for (size_t i = 0; i < list_.size(); ++i) {
      if (list_[i] == -1.0) {
        first = i + 1;
        continue;
      }
      if (!index_of(list_[i])) return;
      if (i < first + 2) continue;
      const size_t odd = (i - first) % 2;
      for (const size_t corner : {i - 2 + odd, i - 1 - odd, i}) {
        out_.corners.push_back(static_cast<uint32_t>(list_[corner]));
      }
      out_.corner_counts.push_back(3);
      if (has_face_colors_) out_.face_colors.emplace_back(1.0F);
      if (has_corner_uvs_) out_.corner_uvs.insert(out_.corner_uvs.end(), 3, vec2(0.0F));
      if (has_face_textures_) out_.face_textures.push_back(has_corner_uvs_ ? PlyBody::kNoTexture : 0);
    }
  }

  const PlyHeader& header_;
  Rows rows_;
  LoadReport& report_;
  PlyBody out_;
  uint64_t vertex_count_ = 0;
  bool has_normals_ = false;
  bool has_colors_ = false;
  bool has_uvs_ = false;
  bool has_face_colors_ = false;
  bool has_corner_uvs_ = false;
  bool has_face_textures_ = false;
  /// The number of the current row in its element.
  uint64_t row_ = 0;
  std::vector<double> list_;
  std::vector<double> uv_list_;
  std::string problem_;
  std::string place_;
  bool has_wild_colors_ = false;
};

}  // namespace

PlyBody read_ply_body(std::string_view file, const PlyHeader& header, LoadReport& report) {
  switch (header.encoding) {
    case PlyEncoding::kLittleEndian:
      return BodyReader<PlyBinaryRows<std::endian::little>>(file, header, report).read();
    case PlyEncoding::kBigEndian:
      return BodyReader<PlyBinaryRows<std::endian::big>>(file, header, report).read();
    default:
      return BodyReader<PlyTextRows>(file, header, report).read();
  }
}

}  // namespace promin
