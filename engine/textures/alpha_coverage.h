// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// Returns the fraction of the texels (TextureImage::texels) whose alpha, 0...1, is at least `cutoff`; 0 without
/// texels.
double alpha_coverage(std::span<const uint32_t> texels, float cutoff);

/// Scales the alphas of a level so that the fraction of its texels with an alpha of at least `cutoff` is as close as
/// possible to `coverage`, the fraction in the image. Plain means of alpha would make masked shapes thinner in each
/// smaller level (Castano, "Computing Alpha Mipmaps", 2010). The level does not change if none or all of the image's
/// texels reach the cutoff.
void scale_alpha_to_coverage(std::span<uint32_t> texels, float cutoff, double coverage);

}  // namespace promin
