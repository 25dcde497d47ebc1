// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "oracle/oracle.h"
#include "promin/math.h"

/// The sample points of lights with a size and of the lens (docs/model.md, "Sample points"), by tables and loops over
/// bits.
namespace promin::oracle {

/// Returns a number of Sobol's first or second dimension (0 or 1) as a fraction of 2^32, computed from a table of
/// direction numbers.
uint32_t sobol(uint32_t index, int dimension);

/// Returns the index of the point of the first pair for a sample of a pixel with an error target.
uint32_t joint_index(uint32_t number);

/// Returns x as scrambled by Owen's method: a hash of the bits above a bit decides whether the bit is inverted. The
/// hash is that of Laine and Karras with Burley's constants.
uint32_t scramble(uint32_t x, uint32_t seed);

/// A sample of a pixel.
struct SampleId {
  uvec2 pixel{0};
  /// The number of the sample in its pixel.
  uint32_t number = 0;
  uint32_t seed = 0;
  /// True if the sample belongs to a pixel with an error target, whose position in the pixel has the same dimensions.
  bool is_refined = false;
};

/// Returns the point of a pair of dimensions as fractions of 2^32.
std::array<uint32_t, 2> sample_pair_bits(const SampleId& id, uint32_t pair);

/// Returns the point of a pair of dimensions in the unit square.
std::array<Real, 2> sample_pair(const SampleId& id, uint32_t pair);

/// Returns the point of the unit disc for a point of the unit square (Shirley and Chiu's concentric map).
std::array<Real, 2> place_on_disc(const std::array<Real, 2>& u);

/// Returns the direction of a point of the unit square in the cone about an axis, with uniform density over its solid
/// angle. `half_angle` is half the angle of the cone, at most pi.
Vector place_in_cone(const Vector& axis, Real half_angle, const std::array<Real, 2>& u);

}  // namespace promin::oracle
