// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"

namespace promin {

enum class PlyType : uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Returns the number of bytes of a number in a binary file.
size_t size_of(PlyType type);

struct PlyProperty {
  std::string name = {};
  PlyType type = PlyType::kFloat32;
  /// True if each value is a list: a count, followed by that many numbers of `type`.
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;

  /// Returns whether the property lists the corners of faces or strips.
  bool lists_vertices() const { return is_list && (name == "vertex_indices" || name == "vertex_index"); }
  /// Returns whether the property lists texture coordinates of faces: two numbers for each corner.
  bool lists_uvs() const { return is_list && name == "texcoord"; }
};

/// A table of the file with `row_count` rows. Each row has a value of each property.
struct PlyElement {
  std::string name = {};
  uint64_t row_count = 0;
  std::vector<PlyProperty> properties = {};
};

enum class PlyEncoding { kText, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  /// The tables in the order of the file.
  std::vector<PlyElement> elements = {};
  /// The names in lines "comment TextureFile NAME", as MeshLab writes them.
  std::vector<std::string> texture_files = {};
  /// Offset of the rows in bytes.
  size_t size_bytes = 0;
  uint64_t line_count = 0;

  /// Returns the element of this name, or nullptr.
  const PlyElement* find(std::string_view name) const;
};

/// Parses the header of a PLY file (Turk 1994), with both sets of type names, and checks the numbers of rows against
/// the size of the file. All lines must end like the first line: in \n, \r\n or \r. The report receives problems.
PlyHeader parse_ply_header(std::string_view file, LoadReport& report);

}  // namespace promin
