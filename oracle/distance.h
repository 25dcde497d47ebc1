// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "oracle/oracle.h"

/// Functions for distances to single primitives: triangle `primitive` of a mesh, or an analytic shape, whose only
/// primitive is 0.
namespace promin::oracle {

/// The unit roundoff of fp32, 2^-24.
inline constexpr Real kRoundoff = 0x1p-24L;

struct BoundingSphere {
  Vector center{0};
  Real radius = 0;
};

/// Returns whether the primitive exists and can be hit. A degenerate triangle cannot be hit.
bool is_hittable(const world::Shape& shape, int32_t primitive);

/// Returns the bounding sphere of a primitive. Its centre is a plane's point (with size 0), a triangle's centroid, the
/// middle of the axis of a cylinder or cone, or a box's centre. In this function and below, the primitive must be
/// hittable.
BoundingSphere bounding_sphere(const world::Shape& shape, int32_t primitive);

/// Returns u S of docs/glossary.md, the unit of the bounds B1, B2 and BK: S = |o - c| + size, times kRoundoff.
Real scale_of(const world::Shape& shape, int32_t primitive, const Ray& ray);

/// Returns the distance from a point to the surface. Inside a solid it is negative, so it is a convex function of the
/// point. Disks are part of the surface, and an open shape counts as closed.
Real signed_distance(const world::Shape& shape, int32_t primitive, const Vector& point);

/// Returns the distance from a point to the surface, >= 0. For an open shape it is the distance to the side.
Real surface_distance(const world::Shape& shape, int32_t primitive, const Vector& point);

/// Where a point lies relative to an open shape: its distance from the side, extended to infinity, and its distance
/// from the ends. Both are negative inside and are convex functions of the point.
struct PlaceInFrustum {
  Real beyond_side = 0;
  Real beyond_ends = 0;
};
/// Returns where a point lies relative to an open shape; empty if the shape is not open.
std::optional<PlaceInFrustum> place_in_open(const world::Shape& shape, const Vector& point);

/// Returns the distance of a point from the surface's nearest crease. Creases are the rims of a cylinder or cone, the
/// apex, a box's edges; infinite for other shapes.
Real distance_to_crease(const world::Shape& shape, const Vector& point);

/// Returns the distance from a point to the segment between `a` and `b`, which may be equal.
Real distance_to_segment(const Vector& point, const Vector& a, const Vector& b);

}  // namespace promin::oracle
