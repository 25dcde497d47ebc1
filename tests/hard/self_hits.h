// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hard/hard_case.h"

namespace promin::hard {

/// Returns a cosine from 1e-6 to 1; grazing ones are as likely as steep ones.
double uniform_cosine(Random& random);

/// Returns a unit vector that makes this cosine with a unit normal.
vec3 direction_at(const dvec3& normal, double cosine, Random& random);

/// Sends rays at a convex shape of about the size `scale`, then other rays outwards from their hits, with the
/// renderer's own lift. Returns how many of the second rays hit the shape again, which is always wrong.
uint64_t count_self_hits(const Lab& lab, const world::Shape& shape, double scale, const dvec3& center, Random& random);

}  // namespace promin::hard
