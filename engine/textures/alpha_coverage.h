// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// Returns the part of the texels (as TextureImage::texels) whose alpha is at least `cutoff` (of 1); 0 without texels.
double alpha_coverage(std::span<const uint32_t> texels, float cutoff);

/// Scales the alphas of a level so that the part of its texels with at least `cutoff` is as close as possible to
/// `coverage`, that of the image. Plain means of alpha would make masked shapes thinner in each smaller level (Castano,
/// "Computing Alpha Mipmaps", 2010). The level does not change if none or all of the image's texels reach the cutoff.
void scale_alpha_to_coverage(std::span<uint32_t> texels, float cutoff, double coverage);

}  // namespace promin
