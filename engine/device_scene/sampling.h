// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/view.h"

namespace promin {

/// The generator g of the sample lattice (shaders/picture/camera.glsl). It is coprime to count + 1 and makes the
/// shortest vector between points of the lattice modulo count + 1 as long as possible; it is 1 for count = 1. `count`
/// is in 1...kMaxSamplesPerPixel, so that the products fit 32 bits.
uint32_t lattice_generator(uint32_t count);

/// Returns the position of the i-th of `count` points of the lattice with this generator, in pixels from the pixel's
/// upper left corner: (i + 1/2, g (i + 1) mod (count + 1) - 1/2) / count, with one point in each of count columns and
/// rows, symmetric about the centre, and then moved to the point where the filter has that part of its weight to the
/// left and above. count = 1 gives the centre, count = 4 the rotated grid.
vec2 sample_point(const View& view, uint32_t generator, uint32_t index);

/// Returns the position up to which the part `u` of a filter's weight lies, u in 0...1, in pixels from its centre.
double place_of_share(PixelFilter filter, double width, double u);

}  // namespace promin
