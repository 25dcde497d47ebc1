// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "oracle/oracle.h"

/// The environment of a scene (docs/model.md, "Environment", "Studio"): a sky, or ambient light from all directions.
namespace promin::oracle {

class Surroundings {
 public:
  /// The environment must outlive this object. `is_source` is true if objects block the environment's light. Surfaces
  /// then receive its light only as a source (oracle/sky_light.h).
  explicit Surroundings(const Environment& environment, bool is_source = false);

  bool is_source() const { return is_source_; }
  bool has_sky() const { return environment_.has_sky(); }

  /// Returns the unfiltered radiance L from a direction. All directions here are unit vectors.
  Vector radiance(const Vector& direction) const;

  /// Returns the irradiance of a surface divided by pi, E(N) / pi, computed from the bands 0 to 2.
  Vector irradiance(const Vector& normal) const;

  /// Returns P, the mean radiance over the lobe of a roughness about a direction. It is computed by quadrature over
  /// half vectors, with an error below 0.002 of the brightest radiance.
  Vector lobe_mean(const Vector& direction, Real roughness) const;

  /// Returns the difference between the darkest and the brightest value of a channel; 0 without a sky.
  Real range() const { return range_; }

  /// Returns the permitted error of a device's P as a fraction of the range. The error occurs because the device's P
  /// comes from maps with texels, and only for a few roughnesses. It is 0.13 for the studio, whose lamps have edges,
  /// with smooth surfaces, and 0.065 with other surfaces; 0.02 for a gradient; and 0.035 for a panorama without small
  /// lights.
  Real map_error(Real roughness) const;

 private:
  const Environment& environment_;
  std::array<Vector, 9> bands_{};
  Real range_ = 0;
  bool is_source_;
};

}  // namespace promin::oracle
