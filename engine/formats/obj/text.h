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

/// Indices from 0 into the arrays of ObjText.
struct ObjCorner {
  uint32_t position = 0;
  /// kNoObjIndex where the file gives none.
  uint32_t uv = kNoObjIndex;
  uint32_t normal = kNoObjIndex;

  bool operator==(const ObjCorner&) const = default;
};

struct ObjFace {
  uint32_t first_corner = 0;
  uint32_t corner_count = 0;
  /// Index into material_names, kNoObjIndex before the first usemtl.
  uint32_t material = kNoObjIndex;
};

/// The faces between an `o` or `g` and the next, if there are any.
struct ObjGroup {
  std::string name;
  uint32_t first_face = 0;
  uint32_t face_count = 0;
};

/// What an OBJ file says, checked: every index is in range, and every position that a face uses is finite.
struct ObjText {
  /// Not a number where the file has none; no face uses such a position.
  std::vector<vec3> positions;
  /// Empty, or one per position, and white where the file gives none.
  std::vector<vec3> colors;
  /// Texture coordinates; v grows upwards.
  std::vector<dvec2> uvs;
  /// The normals as written, which are not of unit length; not a number where the file has none.
  std::vector<vec3> normals;
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  std::vector<ObjGroup> groups;
  /// The names of usemtl lines, each once.
  std::vector<std::string> material_names;
  /// The rest of each mtllib line.
  std::vector<std::string> libraries;
};

/// Parses the statements v, vt, vn, f, o, g, usemtl and mtllib; others are ignored, with a warning where they would
/// show. Zero bytes at the end do not count. The report repairs bad texture coordinates, normals and colours, and faces
/// that cannot be drawn, which are left out. It refuses indices of positions that are out of range, with their line.
ObjText parse_obj_text(std::string_view text, LoadReport& report);

}  // namespace promin
