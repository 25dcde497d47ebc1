// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "layout.h"
#include "promin/ray.h"
#include "reporting/session.h"

namespace promin::report {

/// What a device's answers come to beside those of the oracle (tests/oracle: long double, no formula shared).
struct Accuracy {
  uint64_t rays = 0;
  /// Both hit: what K is of.
  uint64_t hits = 0;
  /// K in units of u S (docs/glossary.md): of spheres, planes and triangles |dt| |d| cos, as bound B1 has it; of
  /// cylinders and cones the hit's distance from the surface, as BK does.
  double max_k = 0.0;
  double sum_k2 = 0.0;
  /// One of the two hits and the other misses, or the device's t is not a number.
  uint64_t misclassified = 0;

  double rms_k() const;
  void add(const Accuracy& other);
};

/// Judges records of rays at a scene of one primitive; on all cores.
Accuracy judge_records(const world::Scene& scene, std::span<const Ray> rays,
                       std::span<const layout::HitRecord> records);

/// Puts "rays", "max_k", "rms_k" and "misclassified_per_million" into a row.
void put_accuracy(Json& row, const Accuracy& accuracy);

/// Rays as kernels take them.
std::vector<layout::RayRecord> make_requests(std::span<const Ray> rays);

}  // namespace promin::report
