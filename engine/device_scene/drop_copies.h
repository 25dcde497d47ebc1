// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "device_scene/collect_primitives.h"
#include "scene/world_scene.h"

namespace promin {

/// Of more identical primitives than this the tree has only the first: a ray that meets one meets all, and drivers end
/// loops of so many turns (trace/cut_loops.h). Fewer stay, so that the trees of other scenes stay as they are.
inline constexpr uint32_t kMostCopies = 1024;

/// The numbers, in order, of the primitives that are left out for one, by its number.
using DroppedCopies = std::map<uint32_t, std::vector<uint32_t>>;

/// Leaves out the copies of a primitive after the first, which wins wherever they are hit, as all are at equal t. In
/// pictures that holds for primitives of one material that is opaque: others show what lies behind.
DroppedCopies drop_copies(const world::Scene& scene, Collected& collected);

}  // namespace promin
