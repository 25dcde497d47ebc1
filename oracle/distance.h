// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "oracle/oracle.h"

/// Distances to single primitives: triangle `primitive` of a mesh, or an analytic shape, whose only one is 0.
namespace promin::oracle {

/// fp32's unit roundoff, 2^-24.
inline constexpr Real kRoundoff = 0x1p-24L;

struct BoundingSphere {
  Vector center{0};
  Real radius = 0;
};

/// Whether the primitive exists and can be hit: a degenerate triangle cannot.
bool is_hittable(const world::Shape& shape, int32_t primitive);

/// For a plane its point and 0; for a triangle around its centroid, for a cylinder or cone around the middle of the
/// axis, for a box around its centre. Here and below the primitive must be hittable.
BoundingSphere bounding_sphere(const world::Shape& shape, int32_t primitive);

/// u S of docs/glossary.md, the unit of the bounds B1, B2 and BK: S = |o - c| + size, times kRoundoff.
Real scale_of(const world::Shape& shape, int32_t primitive, const Ray& ray);

/// From a point to the surface. Inside a solid it is negative, so that it is a convex function of
/// the point; disks are part of the surface, and an open shape counts as closed.
Real signed_distance(const world::Shape& shape, int32_t primitive, const Vector& point);

/// From a point to the surface, >= 0: of an open shape to its side.
Real surface_distance(const world::Shape& shape, int32_t primitive, const Vector& point);

/// The position of a point relative to an open shape: its distance from the side, extended infinitely, and from the
/// ends; negative inside. Both are convex functions of the point.
struct PlaceInFrustum {
  Real beyond_side = 0;
  Real beyond_ends = 0;
};
/// Empty if the shape is not open.
std::optional<PlaceInFrustum> place_in_open(const world::Shape& shape, const Vector& point);

/// Returns the distance of a point from the surface's nearest crease: the rims of a cylinder or cone, the apex, a box's
/// edges; infinite for other shapes.
Real distance_to_crease(const world::Shape& shape, const Vector& point);

/// From a point to the segment between `a` and `b`, which may be the same.
Real distance_to_segment(const Vector& point, const Vector& a, const Vector& b);

}  // namespace promin::oracle
