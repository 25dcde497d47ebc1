// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "promin/math.h"

namespace promin {

inline constexpr uint32_t kNoObjIndex = std::numeric_limits<uint32_t>::max();

/// A corner of a face, as indices from 0 into the arrays of ObjText.
struct ObjCorner {
  uint32_t position = 0;
  /// Index of the texture coordinate; kNoObjIndex if the file gives none.
  uint32_t uv = kNoObjIndex;
  uint32_t normal = kNoObjIndex;

  bool operator==(const ObjCorner&) const = default;
};

struct ObjFace {
  uint32_t first_corner = 0;
  uint32_t corner_count = 0;
  /// Index into material_names; kNoObjIndex before the first usemtl.
  uint32_t material = kNoObjIndex;
};

/// The faces between an `o` or `g` statement and the next; at least one.
struct ObjGroup {
  std::string name;
  uint32_t first_face = 0;
  uint32_t face_count = 0;
};

/// The checked content of an OBJ file. Every index is in range, and all data that faces use is finite, except normals.
struct ObjText {
  std::vector<vec3> positions;
  /// Vertex colours: empty, or one per position. A position without a colour in the file is white.
  std::vector<vec3> colors;
  /// Texture coordinates; v increases upwards.
  std::vector<dvec2> uvs;
  /// The normals as written, not necessarily of unit length; NaN if the file gives no numbers.
  std::vector<vec3> normals;
  std::vector<ObjCorner> corners;
  /// The faces. Each has at least 3 corners.
  std::vector<ObjFace> faces;
  /// Number of faces that were left out because they had fewer than 3 corners.
  uint64_t small_face_count = 0;
  bool has_lines_or_points = false;
  std::vector<ObjGroup> groups;
  /// The names of usemtl lines, each once.
  std::vector<std::string> material_names;
  /// The rest of each mtllib line.
  std::vector<std::string> libraries;
};

/// Parses the statements v, vt, vn, f, o, g, usemtl and mtllib. Other statements are ignored, with a warning if they
/// would change the picture. The report receives problems with their line. A face with a corner that is not the index
/// of a vertex, or a vertex that is not a position, refuses the file. The report repairs other faults: faces of fewer
/// than 3 corners, vertices that no face uses, colours, normals and texture coordinates that are not numbers, and
/// indices of normals and texture coordinates that are out of range.
ObjText parse_obj_text(std::string_view text, LoadReport& report);

}  // namespace promin
