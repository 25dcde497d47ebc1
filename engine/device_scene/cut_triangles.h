// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "scene/world_scene.h"

namespace promin {

/// A corner of a part of a triangle: its place, and the weights there of the whole triangle's second and third corner.
struct PartCorner {
  vec3 position{0.0F};
  dvec2 weights{0.0};
};
using TrianglePart = std::array<PartCorner, 3>;

/// A triangle in one part.
TrianglePart whole_triangle(const Mesh& mesh, uint32_t triangle);

/// Where a triangle's corners lie in a line it is not packed, but its middle corner lies on the edge of a neighbour. In
/// the intersection's rounding that corner is beside the edge, and a ray slips through between (hard case 21). So such
/// neighbours are cut at the corner: what is packed is the same surface, and closed vertex to vertex. Interpolated
/// normals and colours stay as they were; only the terminator's lift, which looks at the corners, may come out smaller
/// along a cut. A triangle with more than kMaxParts parts is left whole.
class CutTriangles {
 public:
  /// This bounds what a file can make of one triangle.
  static constexpr size_t kMaxParts = 64;

  /// Finds the corners that lie in the middle of edges, of all meshes together.
  explicit CutTriangles(const world::Scene& scene);

  /// Whether any triangle may be in more than one part.
  bool cut_any() const { return !line_of_edge_.empty(); }

  /// The degenerate triangles of an object that is a mesh, by index in order.
  std::span<const uint32_t> degenerate_triangles(size_t object) const { return degenerate_[object]; }

  /// Sets `parts` to those of a triangle that is not degenerate, the same on every call. Most triangles have one part.
  void cut(const Mesh& mesh, uint32_t triangle, std::vector<TrianglePart>& parts) const;

 private:
  /// An edge by the positions of its ends, the lesser one first.
  using Point = std::array<float, 3>;
  using Edge = std::array<Point, 2>;

  std::span<const Point> points_inside(const vec3& a, const vec3& b) const;

  std::vector<std::vector<uint32_t>> degenerate_;
  /// The index in `lines_` of each edge of a triangle whose corners lie in a line.
  std::map<Edge, uint32_t> line_of_edge_;
  /// Corners of triangles that lie in one line and hang together by their edges, in order.
  std::vector<std::vector<Point>> lines_;
};

}  // namespace promin
