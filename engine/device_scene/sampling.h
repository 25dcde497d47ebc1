// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "promin/view.h"

namespace promin {

/// Generator g of the sample lattice (shaders/camera.glsl): coprime to count + 1, chosen for the longest shortest
/// vector between points of the lattice modulo count + 1. 1 for count = 1. `count` is in 1...kMaxSamplesPerPixel: then
/// the products fit 32 bits.
uint32_t lattice_generator(uint32_t count);

}  // namespace promin
