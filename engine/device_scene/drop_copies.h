// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "device_scene/collect_primitives.h"
#include "scene/world_scene.h"

namespace promin {

/// If there are more identical primitives than this, the tree contains only the first. A ray that hits one of them hits
/// all, and drivers end loops with so many iterations (trace/kernels/cut_loops.h). Smaller groups are kept, so that the
/// trees of other scenes do not change.
inline constexpr uint32_t kMostCopies = 1024;

/// The primitives that were left out as copies of others.
struct DroppedCopies {
  /// The sorted numbers of the copies, indexed by the number of the primitive that replaces them.
  std::map<uint32_t, std::vector<uint32_t>> by_first;
  /// The materials of the primitives that were left out.
  std::set<uint32_t> materials;
};

/// Returns whether a surface of the material hides everything behind it, for all textures. Only then does one surface
/// look the same as many surfaces at the same place.
bool hides_copies(const Material& material);

/// Removes copies of primitives. Identical primitives have equal t for every ray, so the first of them is always the
/// nearest hit. Only copies with the same material are removed, and only if this material hides copies.
DroppedCopies drop_copies(const world::Scene& scene, Collected& collected);

}  // namespace promin
