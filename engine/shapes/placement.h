// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/math.h"

namespace promin {

/// An object's transform, with its effects on shapes.
class Placement {
 public:
  explicit Placement(const dmat4& world_from_object);

  /// Returns whether the transform is the identity. Shapes then keep their numbers, each rounded once.
  bool is_identity() const { return is_identity_; }
  /// Returns whether spheres stay spheres. Scales and right angles must be accurate to 1e-5: transforms that were
  /// stored in fp32 have errors of 1e-6, and an error of 1e-5 of a shape's size is less than a pixel.
  bool keeps_spheres() const;
  /// Returns whether circles around the axis stay circles perpendicular to the transformed axis.
  bool keeps_cylinders(const dvec3& axis) const;

  /// Returns whether axis-aligned boxes stay boxes.
  bool keeps_boxes() const;

  dvec3 point(const dvec3& p) const { return origin_ + direction(p); }
  /// Transforms a direction. Components of 0 add nothing, not even the sign of a zero.
  dvec3 direction(const dvec3& v) const;
  /// Returns a transformed normal, up to its length. The normal is multiplied by the cofactor matrix, which is the
  /// inverse transpose times the determinant. Only the determinant's sign matters, and no inverse is needed.
  dvec3 normal(const dvec3& n) const;
  /// Returns the scale of lengths along a direction.
  double scale_along(const dvec3& v) const;
  /// Returns the scale of lengths perpendicular to an axis; requires keeps_cylinders(axis).
  double scale_across(const dvec3& axis) const;
  /// Returns whether the transform reverses the handedness.
  bool is_mirroring() const;

 private:
  dvec3 origin_;
  dvec3 columns_[3];
  bool is_identity_;
};

}  // namespace promin
