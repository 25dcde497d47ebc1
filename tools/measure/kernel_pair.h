// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/ray_sets.h"
#include "promin/caster.h"

namespace promin::measure {

/// What promin's kernel and a plain one (tools/plain) come to over the same rays, in turns after a warm-up.
struct KernelPair {
  std::string rays;
  size_t count = 0;
  /// Of each run.
  std::vector<double> robust_ms;
  std::vector<double> plain_ms;
  /// Of the last run; to any-hit rays only t.
  std::vector<Hit> robust_hits;
  std::vector<Hit> plain_hits;

  /// Rays with a hit by the one kernel and none by the other, whichever is right.
  uint64_t count_only_robust() const;
  uint64_t count_only_plain() const;
};

KernelPair measure_pair(Caster& robust, Caster& plain, const RaySet& set, uint32_t runs);

/// Camera, shadow and random rays of a scene, `side` squared of each (shadow rays: as many as camera rays hit); and for
/// `closed`, a scene of one closed mesh around the origin, as many from inside at its edges, each of which must hit.
std::vector<RaySet> make_ray_sets(Caster& caster, const world::Scene& scene, const Camera& camera, uint32_t side,
                                  bool is_closed);

}  // namespace promin::measure
