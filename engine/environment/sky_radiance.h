// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/environment.h"

namespace promin {

/// The radiance, linear RGB, that an environment's sky sends from a direction of any length but 0, with its rotation
/// and intensity. A panorama's is interpolated between the middles of its pixels. The ambient light where there is no
/// sky.
dvec3 sky_radiance(const Environment& environment, const dvec3& direction);

}  // namespace promin
