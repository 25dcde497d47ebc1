// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"
#include "promin/textures.h"

namespace promin {

/// Options for interpreting a picture as heights.
struct HeightMap {
  /// Difference in height between white and black in units of texels, along u and along v. The signs differ if the map
  /// is mirrored.
  dvec2 height{1.0};
  /// Channel of RGBA, counted from 0. The number 4 stands for the Rec. 709 luminance of the stored values.
  int channel = 4;
  /// True if the picture is clamped at its edges; otherwise it repeats.
  bool is_clamped = false;
};

/// Returns the normals of a surface that a picture of heights displaces, for a slot of normals. The method is that of
/// Blinn 1978 ("Simulation of wrinkled surfaces"): the normal n becomes n - F_u p_u - F_v p_v, of unit length, where
/// p_u and p_v are the directions of increasing u and v, and F_u and F_v are the slopes. A slope is the central
/// difference of the heights of a texel's two neighbours, computed in double.
TextureImage make_normals(const TextureImage& picture, const HeightMap& map);

/// Returns whether a picture holds normals and not heights: blue exceeds red and green by 0.2 on average, and 95 of 100
/// texels are vectors of a length from 0.8 to 1.2. Grey pictures and most coloured ones satisfy neither condition.
bool holds_normals(const TextureImage& picture);

/// Returns whether all texels are equal. Such a picture has no slopes.
bool is_flat(const TextureImage& picture);

}  // namespace promin
