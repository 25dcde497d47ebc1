// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/session.h"

namespace promin::lab {

/// Measures rates of rays and the build of a scene beside Embree's, over the same rays and triangles and in the same
/// turns. Appends to the arrays "rows" and "builds", and does what add_picture_over_rays does. Without runs it only
/// counts steps.
void add_rates(const Session& session, const world::Scene& scene, Json& rates);

}  // namespace promin::lab
