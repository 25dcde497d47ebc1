// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "measure/embree.h"
#include "promin/caster.h"
#include "reporting/session.h"

namespace promin::report {

/// Times a picture of the scene, lit if it has no light, beside what `caster` and Embree, unless it is null, take for
/// the picture's own rays, set by set (measure::PictureRays); and so the part of it behind the first hits, its mirror
/// stage. Appends both to "pictures" of the section rates, and the sets to "picture_rays".
void add_picture_over_rays(const Session& session, const world::Scene& scene, Caster& caster,
                           measure::EmbreeCaster* embree, Json& rates);

}  // namespace promin::report
