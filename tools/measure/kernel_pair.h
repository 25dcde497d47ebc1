// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/ray_sets.h"
#include "promin/caster.h"

namespace promin::measure {

/// The results of promin's kernel and of a plain one (tools/plain) over the same rays, in turns after a warm-up.
struct KernelPair {
  std::string rays;
  size_t count = 0;
  /// The milliseconds of each run.
  std::vector<double> robust_ms;
  std::vector<double> plain_ms;
  /// The hits of the last run. For any-hit rays only t is set.
  std::vector<Hit> robust_hits;
  std::vector<Hit> plain_hits;

  /// Returns the number of rays for which only this kernel reports a hit, regardless of which kernel is correct.
  uint64_t count_only_robust() const;
  uint64_t count_only_plain() const;
};

KernelPair measure_pair(Caster& robust, Caster& plain, const RaySet& set, uint32_t runs);

/// Returns camera, shadow and random rays of a scene. Each set has `side` squared rays; there are as many shadow rays
/// as camera rays hit. If `closed` is true, the scene is one closed mesh around the origin; another set of the same
/// size then starts inside and aims at its edges, so that each ray must hit.
std::vector<RaySet> make_ray_sets(Caster& caster, const world::Scene& scene, const Camera& camera, uint32_t side,
                                  bool is_closed);

}  // namespace promin::measure
