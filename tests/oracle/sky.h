// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "oracle/oracle.h"

/// What surrounds a scene, as docs/model.md ("Environment", "Studio") has it: a sky, or ambient light from everywhere.
namespace promin::oracle {

class Surroundings {
 public:
  /// The environment outlives this.
  explicit Surroundings(const Environment& environment);

  bool has_sky() const { return environment_.has_sky(); }

  /// What comes from a direction, a unit vector as all are here: L, unfiltered.
  Vector radiance(const Vector& direction) const;

  /// The irradiance of a surface over pi, by the bands 0 to 2: E(N) / pi.
  Vector irradiance(const Vector& normal) const;

  /// The mean over the lobe of a roughness about a direction: P. By quadrature over half vectors, which errs by less
  /// than 0.002 of what is brightest.
  Vector lobe_mean(const Vector& direction, Real roughness) const;

  /// Between the darkest and the brightest of a channel; 0 without a sky.
  Real range() const { return range_; }

  /// How far a device's P may be off ours, as it is of maps with texels and of a few roughnesses: a share of the range,
  /// of the studio, whose lamps have edges, 0.13 where smooth and 0.065 elsewhere, of a gradient 0.02, and of a
  /// panorama without small lights 0.035.
  Real map_error(Real roughness) const;

 private:
  const Environment& environment_;
  std::array<Vector, 9> bands_{};
  Real range_ = 0;
};

}  // namespace promin::oracle
