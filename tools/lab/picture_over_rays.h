// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/session.h"
#include "measure/embree.h"
#include "promin/caster.h"

namespace promin::lab {

/// Compares the time of a picture of the scene, with default lights if it has none, with the time that `caster` and
/// Embree (unless it is null) take for the picture's own rays, set by set (measure::PictureRays). Does the same for the
/// part of the picture behind the first hits, its mirror stage. Appends both to "pictures" of the rates, and the sets
/// to "picture_rays".
void add_picture_over_rays(const Session& session, const world::Scene& scene, Caster& caster,
                           measure::EmbreeCaster* embree, Json& rates);

}  // namespace promin::lab
