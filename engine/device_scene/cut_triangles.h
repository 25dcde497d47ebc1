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

/// A corner of a part of a triangle: its position, and the weights of the whole triangle's second and third corner at
/// this position.
struct PartCorner {
  vec3 position{0.0F};
  dvec2 weights{0.0};
};
using TrianglePart = std::array<PartCorner, 3>;

/// Returns a triangle as one part.
TrianglePart whole_triangle(const Mesh& mesh, uint32_t triangle);

/// Cuts triangles at corners on their edges. A triangle whose corners lie on a line is not packed, but its middle
/// corner lies on the edge of a neighbour. Because of rounding in the intersection test, this corner would lie beside
/// the edge, and a ray could slip through (hard case 21). The class therefore cuts such neighbours at the corner: the
/// packed surface is the same and is closed vertex to vertex. Interpolated normals and colours do not change; only the
/// lift at the terminator depends on the corners and may be smaller along a cut. A triangle that would have more than
/// kMaxParts parts is not cut.
class CutTriangles {
 public:
  /// The largest number of parts of a triangle. It limits the number of parts that a file can cause.
  static constexpr size_t kMaxParts = 64;

  /// Finds the corners that lie inside edges. The corners and edges of all meshes are compared.
  explicit CutTriangles(const world::Scene& scene);

  /// Returns whether any triangle may have more than one part.
  bool cut_any() const { return !line_of_edge_.empty(); }

  /// Returns the indices of an object's degenerate triangles in order; the object is a mesh.
  std::span<const uint32_t> degenerate_triangles(size_t object) const { return degenerate_[object]; }

  /// Sets `parts` to the parts of a triangle that is not degenerate. Every call gives the same parts. Most triangles
  /// have one part.
  void cut(const Mesh& mesh, uint32_t triangle, std::vector<TrianglePart>& parts) const;

 private:
  /// An edge, given by the positions of its ends, the smaller position first.
  using Point = std::array<float, 3>;
  using Edge = std::array<Point, 2>;

  std::span<const Point> points_inside(const vec3& a, const vec3& b) const;

  std::vector<std::vector<uint32_t>> degenerate_;
  /// For each edge of a triangle whose corners lie on a line, the index of the line in `lines_`.
  std::map<Edge, uint32_t> line_of_edge_;
  /// Lines of corners. A line has the corners, in order, of degenerate triangles that lie on it and are connected by
  /// their edges.
  std::vector<std::vector<Point>> lines_;
};

}  // namespace promin
