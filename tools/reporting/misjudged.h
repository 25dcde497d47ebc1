// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "measure/ray_sets.h"

namespace promin::report {

/// Rays that a kernel tells wrong of, by the truth: it misses what is there, or hits what is not.
struct Misjudged {
  uint64_t lost = 0;
  uint64_t invented = 0;
  /// Of both: the least k for which surfaces off by k u S make the worst answer true (oracle::Verdict::margin, u =
  /// 2^-24). Rays that pass so near to a silhouette are nobody's to decide in fp32. Of any-hit rays that are invented
  /// it is not known, as they name no primitive.
  double worst_margin = 0.0;
};

/// Which rays the truth is asked for: those that hit by one kernel and miss by the other, then others evenly; as many
/// in all as brute force over `primitive_count` primitives may take in `most_tests` tests, and no fewer than 64. Where
/// the first are more they are thinned out evenly.
std::vector<size_t> choose_rays(std::span<const Hit> a, std::span<const Hit> b, uint64_t primitive_count,
                                uint64_t most_tests);

/// Whether there is a hit, of each chosen ray: by the oracle of the tests (tests/oracle, long double, brute force),
/// which shares no formula with the kernels; on all cores.
std::vector<uint8_t> ask_oracle(const world::Scene& scene, std::span<const Ray> rays, std::span<const size_t> chosen);

/// A kernel's hits by what the oracle said of the chosen rays.
Misjudged judge_by_oracle(const world::Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                          std::span<const size_t> chosen, std::span<const uint8_t> is_there);

/// Of rays from inside of a closed mesh: each hits. No oracle is asked, as at an edge two triangles are near enough for
/// its rounding, too.
Misjudged judge_in_closed_mesh(std::span<const Hit> hits);

}  // namespace promin::report
