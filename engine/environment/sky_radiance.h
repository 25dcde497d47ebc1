// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/environment.h"

namespace promin {

/// Returns the radiance, linear RGB, of an environment's sky in a direction of any length except 0, with its rotation
/// and intensity. A panorama is interpolated between the centres of its pixels. Without a sky it is the ambient light.
dvec3 sky_radiance(const Environment& environment, const dvec3& direction);

}  // namespace promin
