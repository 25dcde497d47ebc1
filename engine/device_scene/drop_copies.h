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

/// If there are more identical primitives than this, the tree contains only the first: a ray that hits one hits all,
/// and drivers end loops of so many iterations (trace/kernels/cut_loops.h). Smaller groups are kept, so that the trees
/// of other scenes do not change.
inline constexpr uint32_t kMostCopies = 1024;

/// The primitives that were left out as copies of others.
struct DroppedCopies {
  /// The numbers of the copies in order, by the number of the primitive that stands for them.
  std::map<uint32_t, std::vector<uint32_t>> by_first;
  /// Their materials.
  std::set<uint32_t> materials;
};

/// Returns whether a surface of the material hides everything behind it, whatever its textures are. Only then does one
/// surface look the same as many at the same place.
bool hides_copies(const Material& material);

/// Leaves out copies of a primitive. The first of them is the nearest hit wherever they are hit, because all have equal
/// t. Only copies with the same material, which must hide copies, are left out.
DroppedCopies drop_copies(const world::Scene& scene, Collected& collected);

}  // namespace promin
