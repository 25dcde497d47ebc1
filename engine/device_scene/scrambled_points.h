// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "promin/view.h"

namespace promin {

/// Returns the key from which the sample points of all pixels follow: of the first two dimensions (0 and 1), and of all
/// further dimensions (2), which shaders/shade/samples.glsl computes.
uint32_t key_of_points(uint32_t seed, uint32_t dimension);

/// The sample points of a pixel if their number is not known in advance: the first two Sobol dimensions with Owen
/// scrambling by a hash of the pixel's position (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020). The first
/// 2^m points are a (0, m, 2)-net, so a pixel that takes more samples keeps its earlier ones. Coordinates are odd
/// multiples of 2^-24 in 0...1, computed by integer operations only.
class ScrambledPoints {
 public:
  /// Creates the points of the pixel at this position in the whole picture, for View::seed.
  explicit ScrambledPoints(const uvec2& pixel, uint32_t seed = 0);

  vec2 at(uint32_t index) const;

 private:
  std::array<uint32_t, 2> seeds_;
};

/// Maps uniform points to samples that are distributed by a filter's weight, by linear interpolation in a table of
/// place_of_share. The interpolation moves at most 2^-12 of the weight, by less than the distance between two entries.
class FilterPlaces {
 public:
  explicit FilterPlaces(const View& view);

  /// Returns the position for a point of the unit square, in pixels from the pixel's upper left corner.
  vec2 at(const vec2& shares) const { return {place(shares.x), place(shares.y)}; }

 private:
  static constexpr uint32_t kSteps = 4096;
  float place(float share) const;

  std::array<float, kSteps + 1> places_;
};

}  // namespace promin
