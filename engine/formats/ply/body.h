// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "formats/ply/header.h"
#include "promin/math.h"

namespace promin {

/// What promin draws of a PLY file, as the file has it: numbers may be anything, indices are in range.
struct PlyBody {
  std::vector<vec3> positions = {};
  /// Empty, or one per position.
  std::vector<vec3> normals = {};
  /// Empty, or one per position: linear RGBA within 0...1.
  std::vector<vec4> colors = {};
  /// Indices of positions, polygon after polygon.
  std::vector<uint32_t> corners = {};
  /// How many of them each polygon has, 3...kMaxPolygonCorners.
  std::vector<uint32_t> corner_counts = {};
};

/// Reads the rows behind a header that has vertices and faces. Strips become triangles. Problems go to the report.
PlyBody read_ply_body(std::string_view file, const PlyHeader& header, LoadReport& report);

}  // namespace promin
