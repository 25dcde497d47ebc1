// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "oracle/oracle.h"

/// The environment of a scene (docs/model.md, "Environment", "Studio"): a sky, or ambient light from all directions.
namespace promin::oracle {

class Surroundings {
 public:
  /// The environment outlives this.
  explicit Surroundings(const Environment& environment);

  bool has_sky() const { return environment_.has_sky(); }

  /// Returns the unfiltered radiance L from a direction. All directions here are unit vectors.
  Vector radiance(const Vector& direction) const;

  /// The irradiance of a surface over pi, by the bands 0 to 2: E(N) / pi.
  Vector irradiance(const Vector& normal) const;

  /// Returns P, the mean radiance over the lobe of a roughness about a direction. It is computed by quadrature over
  /// half vectors, with an error below 0.002 of the brightest radiance.
  Vector lobe_mean(const Vector& direction, Real roughness) const;

  /// Between the darkest and the brightest of a channel; 0 without a sky.
  Real range() const { return range_; }

  /// The permitted error of a device's P, which comes from maps with texels and for a few roughnesses, as a share of
  /// the range: for the studio, whose lamps have edges, 0.13 for smooth surfaces and 0.065 for others; for a gradient
  /// 0.02; and for a panorama without small lights 0.035.
  Real map_error(Real roughness) const;

 private:
  const Environment& environment_;
  std::array<Vector, 9> bands_{};
  Real range_ = 0;
};

}  // namespace promin::oracle
