// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/tangents.h"

#include <algorithm>
#include <cmath>

#include "oracle/distance.h"
#include "oracle/texture.h"

namespace promin::oracle {
namespace {

/// The largest relative error of one rounded operation in double.
constexpr Real kDouble = 0x1p-53L;
/// The largest angle by which rounding of a unit vector's components rotates it: sqrt(3) halves of their last bits.
constexpr Real kRoundingOfUnits = 0.87L * kRoundoff;

/// A sum that is smaller than this fraction of its terms has no valid digits in a computation in double.
constexpr Real kDropped = 1e-12L;

constexpr int kNone = -1;

/// A triangle, which takes part in the computation or not.
struct Face {
  bool is_degenerate = false;
  /// Sign of the area of the triangle's coordinates; 0 if they have no area, until a group sets it.
  int hand = 0;
  /// True if the coordinates have an area and equations 18 and 19 give vectors with a length. If the corners lie on a
  /// line, one of the vectors may have no length.
  bool has_area = false;
  /// The direction in which u increases, of any length, and the error of its components.
  Vector along{0};
  Real along_error = 0;
  /// For each edge, which has the number of the corner at which it begins, the face on its other side.
  int neighbors[3] = {kNone, kNone, kNone};
  int groups[3] = {kNone, kNone, kNone};
};

class Tangents {
 public:
  Tangents(const Mesh& mesh, uint32_t uv_set) : mesh_(mesh), uv_set_(uv_set), faces_(mesh.triangles.size()) {
    for (int f = 0; f < count(); ++f) measure(f);
    weld();
    find_neighbors();
    for (int f = 0; f < count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        Face& face = faces_[static_cast<size_t>(f)];
        if (face.is_degenerate || !face.has_area || face.groups[i] != kNone) continue;
        hands_.push_back(face.hand);
        assign(f, i, static_cast<int>(hands_.size()) - 1);
      }
    }
  }

  std::vector<CornerTangent> make() const {
    std::vector<CornerTangent> of_groups(hands_.size());
    for (size_t g = 0; g < hands_.size(); ++g) of_groups[g] = average(static_cast<int>(g));
    std::vector<CornerTangent> corners;
    for (int f = 0; f < count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        const int group = at(f).groups[i];
        if (group != kNone) {
          corners.push_back(of_groups[static_cast<size_t>(group)]);
          continue;
        }
        CornerTangent& left = corners.emplace_back();
        left.is_degenerate = at(f).is_degenerate;
        for (int other = 0; other < count(); ++other) {
          for (int k = 0; k < 3; ++k) {
            if (at(other).groups[k] != kNone && vertex(other, k) == vertex(f, i)) {
              left.groups_at_vertex.push_back(at(other).groups[k]);
            }
          }
        }
      }
    }
    return corners;
  }

 private:
  int count() const { return static_cast<int>(faces_.size()); }
  const Face& at(int f) const { return faces_[static_cast<size_t>(f)]; }
  int vertex(int f, int i) const { return vertices_[static_cast<size_t>(3 * f + i % 3)]; }

  uint32_t index(int f, int i) const { return mesh_.triangles[static_cast<size_t>(f)][i % 3]; }
  Vector position(int f, int i) const { return Vector(mesh_.positions[index(f, i)]); }
  Vector2 place(int f, int i) const {
    const vec4& uvs = mesh_.uvs[index(f, i)];
    return uv_set_ == 0 ? Vector2(uvs.x, 1 - Real(uvs.y)) : Vector2(uvs.z, 1 - Real(uvs.w));
  }
  /// Returns the normal of the triangle's plane, of any length.
  Vector across(int f) const { return glm::cross(position(f, 1) - position(f, 0), position(f, 2) - position(f, 0)); }
  Vector normal(int f, int i) const {
    const Vector n = mesh_.normals.empty() ? across(f) : Vector(mesh_.normals[index(f, i)]);
    return n == Vector(0) ? n : glm::normalize(n);
  }

  /// Computes equations 18 and 19 of the implementation, without their common divisor, which is positive.
  void measure(int f) {
    Face& face = faces_[static_cast<size_t>(f)];
    for (int i = 0; i < 3; ++i) face.is_degenerate = face.is_degenerate || position(f, i) == position(f, i + 1);
    face.is_degenerate = face.is_degenerate || (mesh_.normals.empty() && across(f) == Vector(0));
    const Vector2 st_b = place(f, 1) - place(f, 0);
    const Vector2 st_c = place(f, 2) - place(f, 0);
    const Vector b = position(f, 1) - position(f, 0);
    const Vector c = position(f, 2) - position(f, 0);
    const Real area = st_b.x * st_c.y - st_c.x * st_b.y;
    const Vector to_b = st_c.y * b;
    const Vector to_c = st_b.y * c;
    face.has_area = area != 0 && to_b - to_c != Vector(0) && st_b.x * c - st_c.x * b != Vector(0);
    face.hand = !face.has_area ? 0 : (area > 0 ? 1 : -1);
    face.along = static_cast<Real>(face.hand) * (to_b - to_c);
    face.along_error = 4 * kDouble * (glm::length(to_b) + glm::length(to_c));
  }

  bool are_one(int f, int i, int g, int k) const {
    if (position(f, i) != position(g, k) || place(f, i) != place(g, k)) return false;
    if (!mesh_.normals.empty()) return mesh_.normals[index(f, i)] == mesh_.normals[index(g, k)];
    const Vector a = across(f);
    const Vector b = across(g);
    return (a == Vector(0)) == (b == Vector(0)) && glm::cross(a, b) == Vector(0) && glm::dot(a, b) >= 0;
  }

  /// Sets the vertex of each corner: the first corner that is equal to it.
  void weld() {
    for (int f = 0; f < count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        int first = 0;
        while (!are_one(first / 3, first % 3, f, i)) ++first;
        vertices_.push_back(first);
      }
    }
  }

  /// Pairs edges. An edge is paired with the first later edge that runs in the opposite direction between its vertices
  /// and has no face on its other side yet.
  void find_neighbors() {
    for (int f = 0; f < count(); ++f) {
      for (int i = 0; i < 3; ++i) find_neighbor(f, i);
    }
  }
  void find_neighbor(int f, int i) {
    if (at(f).is_degenerate || at(f).neighbors[i] != kNone) return;
    for (int g = f + 1; g < count(); ++g) {
      for (int k = 0; k < 3; ++k) {
        if (at(g).is_degenerate || at(g).neighbors[k] != kNone) continue;
        if (vertex(g, k) != vertex(f, i + 1) || vertex(g, k + 1) != vertex(f, i)) continue;
        faces_[static_cast<size_t>(f)].neighbors[i] = g;
        faces_[static_cast<size_t>(g)].neighbors[k] = f;
        return;
      }
    }
  }

  /// Adds the corner to the group, then the corners at its vertex of the faces across its edges, and so on. A face
  /// without an area gets the handedness of the first group that reaches it.
  void assign(int f, int i, int group) {
    Face& face = faces_[static_cast<size_t>(f)];
    if (face.groups[i] != kNone) return;
    const int hand = hands_[static_cast<size_t>(group)];
    if (face.hand == 0) face.hand = hand;
    if (face.hand != hand) return;
    face.groups[i] = group;
    for (const int edge : {i, (i + 2) % 3}) {
      const int across = face.neighbors[edge];
      if (across == kNone) continue;
      for (int k = 0; k < 3; ++k) {
        if (vertex(across, k) == vertex(f, i)) assign(across, k, group);
      }
    }
  }

  /// A unit vector and its error.
  struct Direction {
    Vector value{0};
    Real error = 0;
  };
  /// Returns the direction of the component of `v`, which has the error `error`, perpendicular to a unit normal.
  static Direction project(const Vector& v, const Vector& normal, Real error) {
    const Vector flat = v - glm::dot(v, normal) * normal;
    const Real length = glm::length(flat);
    const Real off = error + 8 * kDouble * glm::length(v);
    // The component is only rounding.
    if (length <= 0x1p-58L * glm::length(v)) return {};
    return {flat / length, off / length};
  }

  /// Returns the mean of the faces' directions, weighted by their angles at the vertex.
  CornerTangent average(int group) const {
    Vector sum(0);
    Real off = 0;
    Real weights = 0;
    for (int f = 0; f < count(); ++f) {
      if (!at(f).has_area) continue;
      for (int i = 0; i < 3; ++i) {
        if (at(f).groups[i] != group) continue;
        const Vector n = normal(f, i);
        const Direction along = project(at(f).along, n, at(f).along_error);
        const Direction next = project(position(f, i + 1) - position(f, i), n, 0);
        const Direction last = project(position(f, i + 2) - position(f, i), n, 0);
        const Real cosine = std::clamp(glm::dot(next.value, last.value), Real(-1), Real(1));
        const Real weight = std::acos(cosine);
        // The error of an arc cosine is the error of its argument divided by the sine; near 0 and pi it is the square
        // root of the error.
        const Real off_cosine = next.error + last.error + 8 * kDouble;
        const Real off_weight = std::min(std::sqrt(2 * off_cosine), off_cosine / std::sqrt(1 - cosine * cosine));
        sum += weight * along.value;
        off += weight * along.error + off_weight;
        weights += weight;
      }
    }
    CornerTangent tangent;
    tangent.group = group;
    tangent.hand = hands_[static_cast<size_t>(group)];
    const Real length = glm::length(sum);
    if (length <= 0x1p-55L * weights) {
      // The directions cancel, or have no weight. Rounding then decides the result.
      if (off > kDropped / 8 * weights) tangent.error = kInfinity;
      return tangent;
    }
    tangent.direction = sum / length;
    // Flat normals are rounded to fp32. The perpendicular component rotates by no more than the normals.
    tangent.error = kRoundingOfUnits * (mesh_.normals.empty() ? 2 : 1) + (off + 8 * kDouble * weights) / length;
    return tangent;
  }

  const Mesh& mesh_;
  uint32_t uv_set_;
  std::vector<Face> faces_;
  std::vector<int> vertices_;
  /// The handedness of each group.
  std::vector<int> hands_;
};

}  // namespace

std::vector<CornerTangent> corner_tangents(const Mesh& mesh, uint32_t uv_set) {
  return Tangents(mesh, uv_set).make();
}

}  // namespace promin::oracle
