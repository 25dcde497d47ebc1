// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "promin/view.h"

namespace promin {

/// The points at which a pixel is sampled where their number is not known before: Sobol's first two dimensions,
/// scrambled as Owen does by a hash of the pixel's place (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020).
/// The first 2^m of them are a (0, m, 2)-net, so a pixel that takes more keeps those that it has. Coordinates are odd
/// multiples of 2^-24 in 0...1, of integer operations alone.
class ScrambledPoints {
 public:
  /// Of the pixel at this place of the whole picture.
  explicit ScrambledPoints(const uvec2& pixel);

  vec2 at(uint32_t index) const;

 private:
  std::array<uint32_t, 2> seeds_;
};

/// Where samples lie that are drawn by a filter's weight: place_of_share of a table, between whose entries it is
/// linear. That moves at most a share of 2^-12 of the weight, by less than what lies between two entries.
class FilterPlaces {
 public:
  explicit FilterPlaces(const View& view);

  /// In pixels from the pixel's upper left corner, for a point of the unit square.
  vec2 at(const vec2& shares) const { return {place(shares.x), place(shares.y)}; }

 private:
  static constexpr uint32_t kSteps = 4096;
  float place(float share) const;

  std::array<float, kSteps + 1> places_;
};

}  // namespace promin
