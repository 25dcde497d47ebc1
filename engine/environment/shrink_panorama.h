// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/environment.h"

namespace promin {

/// Returns the panorama reduced to at most `most_width` pixels in a row and half as many rows. Each pixel has the mean
/// radiance of its area, and rows are blurred until their pixels are as wide on the sphere as they are high. An
/// interpolation at points whose distance is about a pixel's height therefore loses no light, even from a small sun or
/// near a pole.
Panorama shrink_panorama(const Panorama& panorama, uint32_t most_width, unsigned thread_count);

}  // namespace promin
