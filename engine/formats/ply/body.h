// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "formats/ply/header.h"
#include "promin/math.h"

namespace promin {

/// The parts of a PLY file that promin draws, as stored: numbers may have any value, indices are in range.
struct PlyBody {
  std::vector<vec3> positions = {};
  /// Vertex normals: empty, or one per position.
  std::vector<vec3> normals = {};
  /// Vertex colours: empty, or one per position; linear RGBA within 0...1.
  std::vector<vec4> colors = {};
  /// Texture coordinates: empty, or one per position; v increases upwards from the lowest row of a picture.
  std::vector<vec2> uvs = {};
  /// The corners of all polygons, one polygon after the other, as indices of positions.
  std::vector<uint32_t> corners = {};
  /// Number of corners of each polygon, 3...kMaxPolygonCorners.
  std::vector<uint32_t> corner_counts = {};
  /// Colours of polygons in the form of `colors`: empty, or one per polygon. Empty if vertices have colours.
  std::vector<vec4> face_colors = {};
  /// Texture coordinates of corners in the form of `uvs`: empty, or one per corner. If they exist, `uvs` is empty.
  std::vector<vec2> corner_uvs = {};
  /// For each polygon, its index into PlyHeader::texture_files. Empty if all indices are 0.
  std::vector<uint32_t> face_textures = {};

  /// The texture index of a polygon without a texture.
  static constexpr uint32_t kNoTexture = std::numeric_limits<uint32_t>::max();
};

/// Reads the rows after a header that has vertices and faces, and texture coordinates if it has texture files. Strips
/// become triangles. The report receives problems.
PlyBody read_ply_body(std::string_view file, const PlyHeader& header, LoadReport& report);

}  // namespace promin
