// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// The share of texels, as TextureImage::texels, whose alpha is at least `cutoff` (of 1), 0 where there are none.
double alpha_coverage(std::span<const uint32_t> texels, float cutoff);

/// Scales the alphas of a level, so that as near as can be to this share of its texels has at least `cutoff`: means of
/// alpha alone would thin out what a mask cuts, the more the smaller the level (Castano, "Computing Alpha Mipmaps",
/// 2010). `coverage` is that of the image. A level stays as it is where the image has none or all of its texels above.
void scale_alpha_to_coverage(std::span<uint32_t> texels, float cutoff, double coverage);

}  // namespace promin
