// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/session.h"

namespace promin::lab {

/// Measures the rates of rays and the time of the build for a scene, and those of Embree with the same rays and
/// triangles in the same turns. Appends to the arrays "rows" and "builds", and does what add_picture_over_rays does.
/// Without runs it only counts steps.
void add_rates(const Session& session, const world::Scene& scene, Json& rates);

}  // namespace promin::lab
