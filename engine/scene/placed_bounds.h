// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// Points in a hierarchy of boxes. The bounds of the transformed points take about a microsecond, whatever their
/// number.
class PlacedBounds {
 public:
  /// `uses` is the expected number of calls of of(). If there are many, it pays to find first the points that may lie
  /// farthest in some direction.
  explicit PlacedBounds(std::vector<vec3> points, size_t uses = 0);

  /// Returns the bounds of the points, each transformed in double and rounded once. The result has the same bits as
  /// that of a loop over all points.
  Bounds of(const dmat4& world_from_object) const;

 private:
  /// A part of the points. The children of part i are 2 i + 1 and 2 i + 2.
  struct Part {
    dvec3 center{0.0};
    dvec3 half{0.0};
    uint32_t begin = 0;
    uint32_t end = 0;
  };

  void divide(size_t part, uint32_t begin, uint32_t end, size_t depth);
  void find_candidates();
  std::vector<uint32_t> find_candidates(size_t index) const;
  uint32_t find_farthest(const dvec3& direction, uint32_t start) const;
  /// Returns the largest coordinates of all points, without their signs.
  dvec3 reach() const;
  void extend(Bounds& bounds, const dmat4& matrix, int axis, bool is_high) const;
  /// Calls take(i) for each point i with a value of more than most(). The value of p is dot(row, p) + offset. take()
  /// may raise most().
  template <typename Most, typename Take>
  void visit_beyond(const dvec3& row, double offset, const Most& most, const Take& take) const;

  std::vector<vec3> points_;
  std::vector<Part> parts_;
  size_t depth_ = 0;
  /// The points that may lie farthest in a direction, for each cell of directions on the faces of a cube, one cell
  /// after the other; empty if they do not pay. Cell i begins at first_candidates_[i].
  std::vector<uint32_t> candidates_;
  std::vector<uint32_t> first_candidates_;
};

/// Returns the positions that the triangles of a mesh use, each once. Throws InputError if one does not exist.
std::vector<vec3> find_corners(const Mesh& mesh);

/// Returns the bounds of each object; empty for objects without finite geometry. Objects that share a mesh take little
/// time. Throws the same errors as bounds_of().
std::vector<Bounds> bounds_of_objects(const Scene& scene);

}  // namespace promin
