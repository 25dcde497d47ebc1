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

/// Where there are more identical primitives than this, the tree has only the first: a ray that meets one meets all,
/// and drivers end loops of so many turns (trace/cut_loops.h). Fewer stay, so that the trees of other scenes stay as
/// they are.
inline constexpr uint32_t kMostCopies = 1024;

/// What is left out for other primitives.
struct DroppedCopies {
  /// The numbers, in order, of the primitives that are left out for one, by its number.
  std::map<uint32_t, std::vector<uint32_t>> by_first;
  /// Their materials.
  std::set<uint32_t> materials;
};

/// Whether nothing behind a surface of the material shows through it, whatever its textures say: only then a picture of
/// one surface is that of many at the same place.
bool hides_copies(const Material& material);

/// Leaves out the copies of a primitive after the first, which is the nearest hit wherever they are hit, as all have
/// equal t. It leaves out those of one material that hides copies.
DroppedCopies drop_copies(const world::Scene& scene, Collected& collected);

}  // namespace promin
