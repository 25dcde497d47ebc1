// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/distance.h"

/// Judges the answer of a device to a ray by the exact one, in units of u S (docs/glossary.md), which is scale_of the
/// primitive. For a plane S grows by |t d|, as in row 10 of the hard cases.
namespace promin::oracle {

/// The bounds of docs/glossary.md: |dt| |d| cos <= kB1 u S; a hit's point is within kBK u S of the surface; an answer
/// may differ from the exact one only within kB2 u S of a point at which the exact answer changes.
inline constexpr Real kB1 = 8;
inline constexpr Real kB2 = 2;
inline constexpr Real kBK = 8;

/// A device's answer for a ray. On a miss `object` is -1, and the other members have no meaning.
struct Answer {
  /// In units of the ray's direction.
  Real t = kInfinity;
  int32_t object = -1;
  int32_t primitive = -1;
};

struct Verdict {
  Hit exact;
  /// Both miss, or both name the same end of the ray's way through the same primitive: entering a solid and leaving it
  /// are two answers.
  bool is_same = false;
  /// If the same: |dt| |d| cos / (u S), with the angle at the exact hit.
  Real t_error = 0;
  /// For any hit on an analytic shape: distance of o + t d from the shape's surface / (u S).
  Real surface_error = 0;
  /// If not the same: the least k for which surfaces that are off by k u S, each by its own S, can make the answer the
  /// true one: what the ray hits instead may be absent, behind or beyond the interval's ends, and what is named present
  /// and in front. Solids grow and shrink by k u S, a triangle's edges and plane move by it, a plane shifts and tilts.
  /// At least the answer's own surface_error where that is beyond kBK; of a triangle, where o + t d is as far beyond
  /// the corners along the ray.
  Real margin = 0;
};

/// Errors of impossible answers are infinite: a primitive that does not exist or cannot be hit, a t that is not finite,
/// a hit of a ray that hits nothing by definition. The caller must check that t lies strictly between tmin and tmax,
/// because rounding on the way here may have moved it.
Verdict judge(const world::Scene& scene, const Ray& ray, const Answer& answer);

/// The same if find_nearest_hit(scene, ray) is already known.
Verdict judge(const world::Scene& scene, const Ray& ray, const Hit& exact, const Answer& answer);

}  // namespace promin::oracle
