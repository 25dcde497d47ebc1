// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// Returns the grey radiance of a studio with its front at +Z in a unit direction.
double studio_radiance(const dvec3& direction);

}  // namespace promin
