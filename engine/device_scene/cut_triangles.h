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

/// A corner of a part of a triangle: its position, and the weights of the whole triangle's second and third corner
/// there.
struct PartCorner {
  vec3 position{0.0F};
  dvec2 weights{0.0};
};
using TrianglePart = std::array<PartCorner, 3>;

/// Returns a triangle as one part.
TrianglePart whole_triangle(const Mesh& mesh, uint32_t triangle);

/// Cuts triangles at corners on their edges. A triangle whose corners lie on a line is not packed, but its middle
/// corner lies on the edge of a neighbour. With the rounding of the intersection test that corner lies beside the edge,
/// and a ray could slip through (hard case 21). Such neighbours are therefore cut at the corner: the packed surface is
/// the same and is closed vertex to vertex. Interpolated normals and colours do not change; only the terminator's lift,
/// which depends on the corners, may be smaller along a cut. A triangle of more than kMaxParts parts is not cut.
class CutTriangles {
 public:
  /// Limits the number of parts that a file can cause.
  static constexpr size_t kMaxParts = 64;

  /// Finds the corners that lie inside edges, among all meshes together.
  explicit CutTriangles(const world::Scene& scene);

  /// Returns whether any triangle may have more than one part.
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
  /// Corners of degenerate triangles on one line that are connected by their edges, in order.
  std::vector<std::vector<Point>> lines_;
};

}  // namespace promin
