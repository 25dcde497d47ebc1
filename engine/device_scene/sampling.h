// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/view.h"

namespace promin {

/// The generator g of the sample lattice (shaders/camera.glsl). It is coprime to count + 1 and makes the shortest
/// vector between points of the lattice modulo count + 1 as long as possible; it is 1 for count = 1. `count` is in
/// 1...kMaxSamplesPerPixel, so that the products fit 32 bits.
uint32_t lattice_generator(uint32_t count);

}  // namespace promin
