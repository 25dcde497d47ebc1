// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/math.h"
#include "promin/textures.h"

namespace promin {

/// How a picture holds heights.
struct HeightMap {
  /// How many texels white stands above black, along u and along v. They differ by the sign where the map is mirrored.
  dvec2 height{1.0};
  /// Of RGBA, from 0; 4 is the luminance of Rec. 709, of the values as they are.
  int channel = 4;
  /// Whether the edges go on beyond the picture; else it repeats.
  bool is_clamped = false;
};

/// The normals of a surface that a picture lifts, for a slot of normals. Blinn 1978 ("Simulation of wrinkled
/// surfaces"): the normal n becomes n - F_u p_u - F_v p_v, of unit length, where p_u and p_v are the directions in
/// which u and v grow, and F_u, F_v the slopes: the central differences of the heights of both neighbours of a texel,
/// in double.
TextureImage make_normals(const TextureImage& picture, const HeightMap& map);

/// Whether a picture holds normals rather than heights: blue exceeds red and green by 0.2 on average, and 95 of 100
/// texels are vectors of a length from 0.8 to 1.2. Grey pictures and most coloured ones do neither.
bool holds_normals(const TextureImage& picture);

/// Whether all texels are the same: without slopes.
bool is_flat(const TextureImage& picture);

}  // namespace promin
