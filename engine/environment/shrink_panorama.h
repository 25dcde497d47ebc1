// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/environment.h"

namespace promin {

/// A panorama of at most `most_width` pixels in a row and half as many rows. Each pixel has the mean radiance of what
/// it covers, and rows are blurred until their pixels are as wide on the sphere as they are high: what interpolates
/// between pixels at steps of about their height loses no light, however small a sun is or near a pole.
Panorama shrink_panorama(const Panorama& panorama, uint32_t most_width, unsigned thread_count);

}  // namespace promin
