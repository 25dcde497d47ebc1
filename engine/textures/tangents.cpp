// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "textures/edge_neighbors.h"
#include "textures/weld.h"

namespace promin {
namespace {

/// The number of triangles or groups that a thread processes at a time.
constexpr size_t kTangentChunkSize = 16384;
constexpr uint32_t kNoGroup = kNoCorner;
/// The largest number of triangles, because corners are numbered in 32 bits.
constexpr size_t kMostTriangles = (size_t{kNoCorner} - 1) / 3;

/// The handedness of a triangle's texture coordinates: on which side of the tangent the bitangent is. kLeft is +1.
enum class Hand : int8_t { kRight = -1, kNone = 0, kLeft = 1 };

dvec3 direction_of(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : dvec3(0.0);
}

/// Returns the direction of a difference of vectors of about this length; 0 if the difference is only rounding.
dvec3 direction_of_difference(const dvec3& v, double length) {
  constexpr double kRounding = 1e-12;
  return glm::length(v) > kRounding * length ? direction_of(v) : dvec3(0.0);
}

/// Returns the direction of the component of `v` that is perpendicular to a unit normal.
dvec3 direction_across(const dvec3& v, const dvec3& normal) {
  return direction_of_difference(v - glm::dot(v, normal) * normal, glm::length(v));
}

/// The data of corners from which tangents are computed.
class TangentSource {
 public:
  TangentSource(const Mesh& mesh, uint32_t uv_set) : mesh_(mesh), first_(uv_set == 0 ? 0 : 2) {
    if (!mesh.normals.empty()) return;
    flat_normals_.resize(mesh.triangles.size());
    for_each_triangle([&](uint32_t i) {
      flat_normals_[i] = vec3(direction_of(glm::cross(edge(3 * i, 3 * i + 1), edge(3 * i, 3 * i + 2))));
    });
  }

  template <typename Task>
  void for_each_triangle(const Task& task) const {
    for_each_chunk(mesh_.triangles.size(), kTangentChunkSize, 0, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) task(static_cast<uint32_t>(i));
    });
  }

  uint32_t corner_count() const { return static_cast<uint32_t>(3 * mesh_.triangles.size()); }
  uint32_t vertex(uint32_t corner) const { return mesh_.triangles[corner / 3][static_cast<int>(corner % 3)]; }
  dvec3 normal(uint32_t corner) const {
    return direction_of(dvec3(mesh_.normals.empty() ? flat_normals_[corner / 3] : mesh_.normals[vertex(corner)]));
  }
  dvec3 edge(uint32_t from, uint32_t to) const {
    return dvec3(mesh_.positions[vertex(to)]) - dvec3(mesh_.positions[vertex(from)]);
  }

  /// Returns whether a triangle has two equal corners or no normal.
  bool is_degenerate(uint32_t triangle) const {
    const uvec3& c = mesh_.triangles[triangle];
    const auto& p = mesh_.positions;
    return p[c.x] == p[c.y] || p[c.y] == p[c.z] || p[c.z] == p[c.x] ||
           (mesh_.normals.empty() && flat_normals_[triangle] == vec3(0.0F));
  }
  /// Returns the handedness of a triangle. There is none if its coordinates have no area, or if u or v grows in no
  /// direction, which is possible on a line.
  Hand hand(uint32_t triangle) const {
    const auto [d1, d2] = uv_edges(triangle);
    const double area = d1.x * d2.y - d1.y * d2.x;
    if (area == 0.0) return Hand::kNone;
    if (growth(triangle, d1.y, d2.y) == dvec3(0.0) || growth(triangle, d1.x, d2.x) == dvec3(0.0)) return Hand::kNone;
    return area > 0.0 ? Hand::kLeft : Hand::kRight;
  }
  /// Returns the direction in which u increases, up to its length.
  dvec3 tangent(uint32_t triangle, Hand hand) const {
    const auto [d1, d2] = uv_edges(triangle);
    const dvec3 along = growth(triangle, d1.y, d2.y);
    return hand == Hand::kLeft ? along : -along;
  }

  /// Returns for each corner the lowest corner that is welded to it.
  std::vector<uint32_t> weld_corners() const {
    if (mesh_.normals.empty()) {
      return weld(corner_count(), [&](uint32_t i) { return key_of(vertex(i), flat_normals_[i / 3]); });
    }
    const auto vertex_count = static_cast<uint32_t>(mesh_.positions.size());
    const std::vector<uint32_t> vertices = weld(vertex_count, [&](uint32_t i) { return key_of(i, mesh_.normals[i]); });
    std::vector<uint32_t> lowest(vertex_count, kNoCorner);
    std::vector<uint32_t> corners(corner_count());
    for (uint32_t i = 0; i < corners.size(); ++i) {
      uint32_t& first = lowest[vertices[vertex(i)]];
      if (first == kNoCorner) first = i;
      corners[i] = first;
    }
    return corners;
  }

 private:
  dvec2 uv(uint32_t corner) const {
    const vec4& uvs = mesh_.uvs[vertex(corner)];
    // v increases upwards here.
    return {static_cast<double>(uvs[first_]), -static_cast<double>(uvs[first_ + 1])};
  }
  std::pair<dvec2, dvec2> uv_edges(uint32_t triangle) const {
    const dvec2 a = uv(3 * triangle);
    return {uv(3 * triangle + 1) - a, uv(3 * triangle + 2) - a};
  }
  /// Returns the direction in which one coordinate increases, up to length and sign. The arguments are the changes of
  /// the other coordinate along the edges to the next and to the last corner.
  dvec3 growth(uint32_t triangle, double to_next, double to_last) const {
    return to_last * edge(3 * triangle, 3 * triangle + 1) - to_next * edge(3 * triangle, 3 * triangle + 2);
  }
  VertexKey key_of(uint32_t vertex, const vec3& n) const {
    const vec3& p = mesh_.positions[vertex];
    const vec4& uvs = mesh_.uvs[vertex];
    return {p.x, p.y, p.z, n.x, n.y, n.z, uvs[first_], uvs[first_ + 1]};
  }

  const Mesh& mesh_;
  /// Index of the set's first component among the components of both sets.
  int first_;
  /// Normals of triangles; empty if the mesh has normals.
  std::vector<vec3> flat_normals_;
};

/// Groups of corners that share a tangent.
class Groups {
 public:
  explicit Groups(const TangentSource& source) : of_corner(source.corner_count(), kNoGroup) {
    const std::vector<uint32_t> welded = source.weld_corners();
    find_hands(source);
    if (std::ranges::all_of(hands_, [](Hand hand) { return hand == Hand::kNone; })) return;
    find_neighbors(welded, source);
    // Only triangles with a handedness of their own begin groups, not triangles that a group gives one.
    const std::vector<Hand> own_hands = hands_;
    for (uint32_t corner = 0; corner < of_corner.size(); ++corner) {
      if (own_hands[corner / 3] != Hand::kNone && of_corner[corner] == kNoGroup) grow(corner);
    }
    neighbors_ = {};
    inherit(welded, source);
  }

  /// The group of each corner.
  std::vector<uint32_t> of_corner;
  /// The handedness of each group.
  std::vector<Hand> hands;

 private:
  void find_hands(const TangentSource& source) {
    hands_.resize(of_corner.size() / 3);
    source.for_each_triangle([&](uint32_t i) { hands_[i] = source.is_degenerate(i) ? Hand::kNone : source.hand(i); });
  }

  void find_neighbors(const std::vector<uint32_t>& welded, const TangentSource& source) {
    std::vector<uint32_t> vertices = welded;
    source.for_each_triangle([&](uint32_t i) {
      if (source.is_degenerate(i)) std::fill_n(vertices.begin() + 3 * std::ptrdiff_t{i}, 3, kNoCorner);
    });
    neighbors_ = find_edge_neighbors(vertices, static_cast<uint32_t>(vertices.size()));
  }

  /// Makes a group of the corner and of the corners around its vertex. It continues on both sides until a triangle has
  /// another handedness or group.
  void grow(uint32_t corner) {
    hands.push_back(hands_[corner / 3]);
    of_corner[corner] = static_cast<uint32_t>(hands.size() - 1);
    uint32_t at = corner;
    while (neighbors_[at] != kNoCorner) {
      at = next_corner(neighbors_[at]);
      if (!join(at)) break;
    }
    at = corner;
    while (neighbors_[last_corner(at)] != kNoCorner) {
      at = neighbors_[last_corner(at)];
      if (!join(at)) break;
    }
  }

  /// Adds a corner to the last group. A triangle without a handedness takes that of the first group that reaches it.
  bool join(uint32_t corner) {
    Hand& hand = hands_[corner / 3];
    if (of_corner[corner] != kNoGroup || (hand != Hand::kNone && hand != hands.back())) return false;
    hand = hands.back();
    of_corner[corner] = static_cast<uint32_t>(hands.size() - 1);
    return true;
  }

  /// Adds the corners that no group has reached to the first group at their vertex, if it has the handedness of their
  /// triangle or the triangle is degenerate. Otherwise they form a group without a tangent.
  void inherit(const std::vector<uint32_t>& welded, const TangentSource& source) {
    std::vector<uint32_t> first(welded.size(), kNoGroup);
    for (uint32_t corner = 0; corner < welded.size(); ++corner) {
      uint32_t& group = first[welded[corner]];
      if (group == kNoGroup) group = of_corner[corner];
    }
    for (uint32_t corner = 0; corner < welded.size(); ++corner) {
      if (of_corner[corner] != kNoGroup) continue;
      const uint32_t group = first[welded[corner]];
      Hand& hand = hands_[corner / 3];
      const bool takes_any_hand = hand == Hand::kNone || source.is_degenerate(corner / 3);
      if (group != kNoGroup && (takes_any_hand || hands[group] == hand)) {
        hand = hands[group];
        of_corner[corner] = group;
        continue;
      }
      if (hand == Hand::kNone) hand = Hand::kLeft;
      of_corner[corner] = static_cast<uint32_t>(hands.size());
      hands.push_back(hand);
    }
  }

  /// The handedness of each triangle.
  std::vector<Hand> hands_;
  std::vector<uint32_t> neighbors_;
};

/// The corners of each group in ascending order.
struct SortedCorners {
  explicit SortedCorners(const Groups& groups) : begins(groups.hands.size() + 1, 0), corners(groups.of_corner.size()) {
    for (const uint32_t group : groups.of_corner) ++begins[group + 1];
    for (size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
    std::vector<uint32_t> next(begins.begin(), begins.end() - 1);
    for (uint32_t i = 0; i < corners.size(); ++i) corners[next[groups.of_corner[i]]++] = i;
  }
  std::span<const uint32_t> of(size_t group) const {
    return std::span(corners).subspan(begins[group], begins[group + 1] - begins[group]);
  }

  std::vector<uint32_t> begins;
  std::vector<uint32_t> corners;
};

/// Returns the contribution of a corner to the tangent of its group.
dvec3 weighted_tangent(const TangentSource& source, uint32_t corner) {
  const uint32_t triangle = corner / 3;
  const Hand hand = source.is_degenerate(triangle) ? Hand::kNone : source.hand(triangle);
  if (hand == Hand::kNone) return dvec3(0.0);
  const dvec3 normal = source.normal(corner);
  const dvec3 to_next = direction_across(source.edge(corner, next_corner(corner)), normal);
  const dvec3 to_last = direction_across(source.edge(corner, last_corner(corner)), normal);
  const double angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0, 1.0));
  return angle * direction_across(source.tangent(triangle, hand), normal);
}

std::vector<vec4> make_tangents(const TangentSource& source, const Groups& groups, const SortedCorners& sorted) {
  std::vector<vec4> tangents(groups.hands.size());
  for_each_chunk(tangents.size(), kTangentChunkSize, 0, [&](size_t begin, size_t end) {
    for (size_t group = begin; group < end; ++group) {
      dvec3 sum(0.0);
      double length = 0.0;
      for (const uint32_t corner : sorted.of(group)) {
        const dvec3 tangent = weighted_tangent(source, corner);
        sum += tangent;
        length += glm::length(tangent);
      }
      tangents[group] = vec4(vec3(direction_of_difference(sum, length)), static_cast<float>(groups.hands[group]));
    }
  });
  return tangents;
}

uint32_t copy_vertex(Mesh& mesh, uint32_t vertex) {
  const auto copy = [&](auto& values) {
    if (!values.empty()) values.push_back(values[vertex]);
  };
  copy(mesh.positions);
  copy(mesh.normals);
  copy(mesh.colors);
  copy(mesh.uvs);
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// Gives vertices the tangents of their corners' groups. The first group at a vertex keeps the vertex, and other groups
/// get copies.
void spread(const std::vector<vec4>& tangents, const SortedCorners& sorted, Mesh& mesh) {
  const size_t old_count = mesh.positions.size();
  std::vector<uint32_t> last_group(old_count, kNoGroup);
  std::vector<uint32_t> last_copy(old_count);
  mesh.tangents.assign(old_count, vec4(0.0F, 0.0F, 0.0F, 1.0F));
  for (uint32_t group = 0; group < tangents.size(); ++group) {
    for (const uint32_t corner : sorted.of(group)) {
      uint32_t& vertex = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
      const uint32_t old = vertex;
      if (last_group[old] != group) {
        const bool is_first = last_group[old] == kNoGroup;
        last_group[old] = group;
        last_copy[old] = is_first ? old : copy_vertex(mesh, old);
        if (!is_first) mesh.tangents.emplace_back();
        mesh.tangents[last_copy[old]] = tangents[group];
      }
      vertex = last_copy[old];
    }
  }
}

}  // namespace

void add_tangents(Mesh& mesh, uint32_t uv_set) {
  if (mesh.uvs.empty() || mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles) return;
  const TangentSource source(mesh, uv_set);
  const Groups groups(source);
  if (groups.hands.empty()) return;
  const SortedCorners sorted(groups);
  spread(make_tangents(source, groups, sorted), sorted, mesh);
}

}  // namespace promin
