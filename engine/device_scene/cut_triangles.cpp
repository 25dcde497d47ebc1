// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/cut_triangles.h"

#include <algorithm>
#include <numeric>

#include "core/parallel.h"

namespace promin {
namespace {

using Point = std::array<float, 3>;

Point point_of(const vec3& v) {
  // The addition turns -0 into 0, because positions are compared by value.
  return {v.x + 0.0F, v.y + 0.0F, v.z + 0.0F};
}

std::array<Point, 2> edge_of(const vec3& a, const vec3& b) {
  const Point p = point_of(a);
  const Point q = point_of(b);
  return p < q ? std::array{p, q} : std::array{q, p};
}

/// The points strictly inside a side of a part, sorted from the smaller end of the side to the larger.
using Points = std::span<const Point>;

/// Cuts `corners` at the points inside the sides 01, 12 and 20.
void cut_at(const TrianglePart& corners, const std::array<Points, 3>& inside, std::vector<TrianglePart>& parts) {
  const auto side = static_cast<size_t>(
      std::find_if(inside.begin(), inside.end(), [](const Points& points) { return !points.empty(); }) -
      inside.begin());
  if (side == inside.size()) {
    parts.push_back(corners);
    return;
  }
  const size_t next = (side + 1) % 3;
  const PartCorner& a = corners[side];
  const PartCorner& b = corners[next];
  const size_t middle = inside[side].size() / 2;
  const Point& point = inside[side][middle];
  PartCorner cut;
  cut.position = {point[0], point[1], point[2]};
  // The points lie on a line, so coordinates could replace lengths.
  const dvec3 edge = dvec3(b.position) - dvec3(a.position);
  const double s = glm::length(dvec3(cut.position) - dvec3(a.position)) / glm::length(edge);
  cut.weights = glm::mix(a.weights, b.weights, s);
  Points near = inside[side].first(middle);
  Points far = inside[side].subspan(middle + 1);
  if (!(point_of(a.position) < point_of(b.position))) std::swap(near, far);

  // Both parts keep the positions of their corners, and share the new side, which has no points inside.
  TrianglePart first = corners;
  first[next] = cut;
  std::array<Points, 3> first_inside = inside;
  first_inside[side] = near;
  first_inside[next] = {};
  cut_at(first, first_inside, parts);
  TrianglePart second = corners;
  second[side] = cut;
  std::array<Points, 3> second_inside = inside;
  second_inside[side] = far;
  second_inside[(side + 2) % 3] = {};
  cut_at(second, second_inside, parts);
}

/// Sets of elements (union-find). Two sets are joined if they share an element.
class Groups {
 public:
  uint32_t add() {
    parent_.push_back(static_cast<uint32_t>(parent_.size()));
    return parent_.back();
  }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }
  size_t size() const { return parent_.size(); }

 private:
  std::vector<uint32_t> parent_;
};

std::vector<uint32_t> find_degenerate(const Mesh& mesh) {
  return find_indices(mesh.triangles.size(), [&](uint32_t triangle) { return world::is_degenerate(mesh, triangle); });
}

}  // namespace

TrianglePart whole_triangle(const Mesh& mesh, uint32_t triangle) {
  const uvec3& corners = mesh.triangles[triangle];
  return {PartCorner{mesh.positions[corners.x], dvec2(0, 0)}, PartCorner{mesh.positions[corners.y], dvec2(1, 0)},
          PartCorner{mesh.positions[corners.z], dvec2(0, 1)}};
}

CutTriangles::CutTriangles(const world::Scene& scene) {
  Groups groups;
  for (const world::Object& object : scene.objects) {
    const Mesh* mesh = std::get_if<Mesh>(&object.shape);
    degenerate_.push_back(mesh == nullptr ? std::vector<uint32_t>() : find_degenerate(*mesh));
    for (const uint32_t i : degenerate_.back()) {
      const uvec3& corners = mesh->triangles[i];
      const std::array p{mesh->positions[corners.x], mesh->positions[corners.y], mesh->positions[corners.z]};
      // If two corners of the triangle coincide, its neighbours share a whole edge, so nothing must be cut.
      if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
      const uint32_t group = groups.add();
      for (size_t side = 0; side < 3; ++side) {
        const auto [at, is_new] = line_of_edge_.try_emplace(edge_of(p[side], p[(side + 1) % 3]), group);
        if (!is_new) groups.join(group, at->second);
      }
    }
  }
  lines_.resize(groups.size());
  for (auto& [edge, line] : line_of_edge_) {
    line = groups.find(line);
    lines_[line].insert(lines_[line].end(), edge.begin(), edge.end());
  }
  for (std::vector<Point>& line : lines_) {
    std::sort(line.begin(), line.end());
    line.erase(std::unique(line.begin(), line.end()), line.end());
  }
}

std::span<const CutTriangles::Point> CutTriangles::points_inside(const vec3& a, const vec3& b) const {
  const Edge edge = edge_of(a, b);
  const auto found = line_of_edge_.find(edge);
  if (found == line_of_edge_.end()) return {};
  const std::vector<Point>& line = lines_[found->second];
  // On a line, points are sorted by their coordinates.
  return {std::upper_bound(line.begin(), line.end(), edge[0]), std::lower_bound(line.begin(), line.end(), edge[1])};
}

void CutTriangles::cut(const Mesh& mesh, uint32_t triangle, std::vector<TrianglePart>& parts) const {
  const TrianglePart whole = whole_triangle(mesh, triangle);
  const std::array inside{points_inside(whole[0].position, whole[1].position),
                          points_inside(whole[1].position, whole[2].position),
                          points_inside(whole[2].position, whole[0].position)};
  parts.clear();
  if (inside[0].size() + inside[1].size() + inside[2].size() >= kMaxParts) {
    parts.push_back(whole);
  } else {
    cut_at(whole, inside, parts);
  }
}

}  // namespace promin
