// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/view.h"

namespace promin {

/// Returns the generator g of the sample lattice (shaders/picture/camera.glsl). It is coprime to count + 1 and makes
/// the shortest vector between points of the lattice modulo count + 1 as long as possible. For count = 1 it is 1.
/// `count` is in 1...kMaxSamplesPerPixel, so that the products fit 32 bits.
uint32_t lattice_generator(uint32_t count);

/// Returns the position of the i-th of `count` points of the lattice with this generator, in pixels from the pixel's
/// upper left corner: (i + 1/2, g (i + 1) mod (count + 1) - 1/2) / count, These points have one point in each of count
/// columns and rows, and are symmetric about the centre. Each coordinate is then moved to the position up to which the
/// filter has this fraction of its weight. count = 1 gives the centre, count = 4 the rotated grid.
vec2 sample_point(const View& view, uint32_t generator, uint32_t index);

/// Returns the position up to which the fraction `u` of a filter's weight lies, in pixels from the filter's centre; u
/// is in 0...1.
double place_of_share(PixelFilter filter, double width, double u);

}  // namespace promin
