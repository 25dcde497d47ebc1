// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/math.h"

namespace promin {

/// What an object's transform does to shapes.
class Placement {
 public:
  explicit Placement(const dmat4& world_from_object);

  /// Where nothing moves: then shapes keep their numbers, each rounded once.
  bool is_identity() const { return is_identity_; }
  /// Positive scales and right angles to 1e-5: transforms that went through fp32 are off by 1e-6, and a shape that is
  /// off by 1e-5 of its size is off by less than a pixel.
  bool keeps_spheres() const;
  /// Circles around the axis stay circles around an axis at right angles.
  bool keeps_cylinders(const dvec3& axis) const;

  /// Boxes along the axes stay boxes along three directions.
  bool keeps_boxes() const;

  dvec3 point(const dvec3& p) const { return origin_ + direction(p); }
  /// Zero components add nothing, not even the sign of a zero.
  dvec3 direction(const dvec3& v) const;
  /// A normal, up to its length: by the inverse transpose, as the matrix of cofactors, which needs no inverse: it is
  /// the same up to the determinant, of which the sign counts.
  dvec3 normal(const dvec3& n) const;
  /// By how much a length along a direction grows.
  double scale_along(const dvec3& v) const;
  /// The same of lengths across an axis; only where keeps_cylinders(axis).
  double scale_across(const dvec3& axis) const;
  /// Whether it turns right hands into left ones.
  bool is_mirroring() const;

 private:
  dvec3 origin_;
  dvec3 columns_[3];
  bool is_identity_;
};

}  // namespace promin
