// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/distance.h"

/// Judges a device's answer to a ray by comparing it with the exact answer, in units of u S (docs/glossary.md), the
/// scale_of the primitive. For a plane, |t d| is added to S, as in row 10 of the hard cases.
namespace promin::oracle {

/// The bounds of docs/glossary.md. The error of a hit's t satisfies |dt| |d| cos <= kB1 u S. A hit's point is within
/// kBK u S of the surface. An answer may differ from the exact one only within kB2 u S of a point at which the exact
/// answer changes.
inline constexpr Real kB1 = 8;
inline constexpr Real kB2 = 2;
inline constexpr Real kBK = 8;

/// A device's answer for a ray. On a miss `object` is -1, and the other members have no meaning.
struct Answer {
  /// Parameter of the hit, in units of the ray's direction.
  Real t = kInfinity;
  int32_t object = -1;
  int32_t primitive = -1;
};

struct Verdict {
  Hit exact;
  /// True if both answers are misses or name the same end of the same primitive. Entering and leaving a solid are
  /// different answers.
  bool is_same = false;
  /// If the answers are the same: |dt| |d| cos / (u S), where cos belongs to the exact hit.
  Real t_error = 0;
  /// For a hit on an analytic shape: the distance of o + t d from the shape's surface, divided by u S.
  Real surface_error = 0;
  /// If the answers differ: the smallest k for which displacements of the surfaces by k u S, each with its own S, can
  /// make the answer true. The surface that the ray hits may then be absent, behind or beyond the interval's ends, and
  /// the named surface may be present and in front. Solids grow and shrink by k u S, a triangle's edges and plane move
  /// by it, a plane shifts and tilts. The margin is at least the answer's own surface_error if that exceeds kBK; for a
  /// triangle, if o + t d lies that far beyond the corners along the ray.
  Real margin = 0;
};

/// Judges an answer. Errors of impossible answers are infinite: a primitive that does not exist or cannot be hit, a t
/// that is not finite, and a hit of a ray that hits nothing by definition. The caller must check that t lies strictly
/// between tmin and tmax, because conversions may have rounded t.
Verdict judge(const world::Scene& scene, const Ray& ray, const Answer& answer);

/// Judges an answer if find_nearest_hit(scene, ray) is already known.
Verdict judge(const world::Scene& scene, const Ray& ray, const Hit& exact, const Answer& answer);

}  // namespace promin::oracle
