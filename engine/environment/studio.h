// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"

namespace promin {

/// The grey radiance of a studio whose front is +Z, from a unit direction.
double studio_radiance(const dvec3& direction);

}  // namespace promin
