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

namespace promin {
namespace {

/// The numbers of a vertex that are read, by their place in a row of them; any others go to the last place.
enum Column : uint32_t { kX, kY, kZ, kNx, kNy, kNz, kRed, kGreen, kBlue, kAlpha, kColumnCount };
using Row = std::array<double, kColumnCount + 1>;

struct ColumnName {
  std::string_view name;
  Column column;
};
/// The colours have two sets of names.
constexpr std::array<ColumnName, 14> kColumnNames = {{{"x", kX},
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
                                                      {"diffuse_alpha", kAlpha}}};

uint32_t column_of(const PlyProperty& property) {
  const auto found = std::ranges::find(kColumnNames, property.name, &ColumnName::name);
  return found == kColumnNames.end() || property.is_list ? kColumnCount : found->column;
}

/// Which of its properties a row's element has where, and the numbers that stand for full colour.
struct VertexLayout {
  std::vector<uint32_t> columns;
  std::array<bool, kColumnCount + 1> is_there{};
  Row full{};

  explicit VertexLayout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const uint32_t column = column_of(property);
      columns.push_back(column);
      is_there[column] = true;
      const bool is_float = property.type == PlyType::kFloat32 || property.type == PlyType::kFloat64;
      full[column] = is_float ? 1.0 : property.type == PlyType::kUint16 ? 65535.0 : 255.0;
    }
  }
  bool has_all(uint32_t first) const { return is_there[first] && is_there[first + 1] && is_there[first + 2]; }
};

template <class Rows>
class BodyReader {
 public:
  BodyReader(std::string_view file, const PlyHeader& header, LoadReport& report)
      : header_(header), rows_(file.substr(header.size_bytes), header.line_count), report_(report) {}

  PlyBody read() {
    vertex_count_ = header_.find("vertex")->row_count;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      read_element(element);
      if (!problem_.empty() || !rows_.problem().empty()) {
        report_.refuse(problem_.empty() ? rows_.problem() : problem_, place_, "export the file again");
        return {};
      }
    }
    if (has_wild_colors_) report_.warn("vertex colours below 0 or above 1 are clamped");
    if (has_small_faces_) report_.warn("faces of fewer than 3 corners are not drawn");
    return std::move(out_);
  }

 private:
  bool is_good() const { return problem_.empty() && rows_.problem().empty(); }

  void read_element(const PlyElement& element) {
    if (element.name == "vertex") {
      const VertexLayout layout(element);
      reserve_vertices(layout);
      read_rows(element, layout.columns, [&](const Row& row) { add_vertex(layout, row); });
      return;
    }
    // No column of the others is read.
    const std::vector<uint32_t> columns(element.properties.size(), kColumnCount);
    if (element.name == "face") {
      out_.corner_counts.reserve(element.row_count);
      out_.corners.reserve(3 * element.row_count);
      read_rows(element, columns, [&](const Row&) { add_polygon(); });
    } else if (element.name == "tristrips") {
      read_rows(element, columns, [&](const Row&) { add_strip(); });
    } else {
      read_rows(element, columns, [](const Row&) {});
    }
  }

  template <class Take>
  void read_rows(const PlyElement& element, const std::vector<uint32_t>& columns, const Take& take) {
    Row row{};
    for (uint64_t i = 0; i < element.row_count; ++i) {
      rows_.start_row();
      for (size_t p = 0; p < columns.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.is_list) {
          read_list(property);
        } else {
          row[columns[p]] = rows_.take(property.type);
        }
      }
      rows_.end_row(report_);
      if (is_good()) take(row);
      if (!is_good()) return tell_place(element, i);
    }
  }

  void tell_place(const PlyElement& element, uint64_t row) {
    place_ = rows_.place().empty() ? element.name + " " + std::to_string(row) : rows_.place();
  }

  void read_list(const PlyProperty& property) {
    const double count = rows_.take(property.count_type);
    if (!rows_.problem().empty()) return;
    if (!(count >= 0.0 && count <= static_cast<double>(rows_.most_numbers(property.type))) ||
        count != std::floor(count)) {
      problem_ = "a list has a count that the file has no room for";
      return;
    }
    const bool is_wanted = property.lists_vertices();
    if (is_wanted) list_.clear();
    for (auto i = static_cast<uint64_t>(count); i > 0 && rows_.problem().empty(); --i) {
      const double number = rows_.take(property.type);
      if (is_wanted) list_.push_back(number);
    }
  }

  void reserve_vertices(const VertexLayout& layout) {
    out_.positions.reserve(vertex_count_);
    if (layout.has_all(kNx)) out_.normals.reserve(vertex_count_);
    if (layout.has_all(kRed)) out_.colors.reserve(vertex_count_);
  }

  void add_vertex(const VertexLayout& layout, const Row& row) {
    out_.positions.emplace_back(dvec3(row[kX], row[kY], row[kZ]) - report_.center());
    if (layout.has_all(kNx)) out_.normals.emplace_back(row[kNx], row[kNy], row[kNz]);
    if (!layout.has_all(kRed)) return;
    const auto share = [&](Column column) { return clamp(row[column] / layout.full[column]); };
    out_.colors.emplace_back(decode(share(kRed)), decode(share(kGreen)), decode(share(kBlue)),
                             layout.is_there[kAlpha] ? share(kAlpha) : 1.0);
  }

  double clamp(double share) {
    if (share >= 0.0 && share <= 1.0) return share;
    has_wild_colors_ = true;
    // Also of what is no number.
    return share > 1.0 ? 1.0 : 0.0;
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

  /// nullopt once the problem is told.
  std::optional<uint32_t> index_of(double number) {
    if (number >= 0.0 && number < static_cast<double>(vertex_count_) && number == std::floor(number)) {
      return static_cast<uint32_t>(number);
    }
    problem_ = "a face names a vertex that is not there, there are " + std::to_string(vertex_count_);
    return std::nullopt;
  }

  void add_polygon() {
    if (list_.size() > kMaxPolygonCorners) {
      problem_ = "a face has more than " + std::to_string(kMaxPolygonCorners) + " corners";
      return;
    }
    for (const double number : list_) {
      const std::optional<uint32_t> corner = index_of(number);
      if (!corner) return;
      out_.corners.push_back(*corner);
    }
    if (list_.size() >= 3) {
      out_.corner_counts.push_back(static_cast<uint32_t>(list_.size()));
      return;
    }
    has_small_faces_ = true;
    out_.corners.resize(out_.corners.size() - list_.size());
  }

  /// A strip is several: each -1 begins another. Every second triangle of one is wound the other way.
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
    }
  }

  const PlyHeader& header_;
  Rows rows_;
  LoadReport& report_;
  PlyBody out_;
  uint64_t vertex_count_ = 0;
  std::vector<double> list_;
  std::string problem_;
  std::string place_;
  bool has_wild_colors_ = false;
  bool has_small_faces_ = false;
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
