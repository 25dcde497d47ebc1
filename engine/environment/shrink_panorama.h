// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/environment.h"

namespace promin {

/// A panorama of at most `most_width` pixels in a row and half as many rows; the same one where it is no larger. Each
/// pixel has the mean radiance of what it covers, so that no light is lost however small it is.
Panorama shrink_panorama(const Panorama& panorama, uint32_t most_width, unsigned thread_count);

}  // namespace promin
