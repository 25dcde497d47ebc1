// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "environment/pack_sky.h"
#include "oracle/oracle.h"
#include "promin/environment.h"

/// The environment as a source of light (docs/model.md, "Skies with shadows"). The texels of the sky and the numbers of
/// its pyramid are those that the device receives.
namespace promin::oracle {

class SkyLight {
 public:
  explicit SkyLight(const Environment& environment);

  /// Returns whether the environment lights anything.
  bool exists() const { return exists_; }

  /// A direction and its density per steradian.
  struct Choice {
    Vector direction{0};
    Real density = 0;
  };
  /// Returns the direction that a point of the unit square chooses for a surface with this normal.
  Choice choose(const Vector& normal, const std::array<Real, 2>& u) const;
  /// Returns the density with which choose() returns a direction.
  Real density(const Vector& normal, const Vector& direction) const;
  /// Returns the radiance from a direction as the device reads it.
  Vector radiance(const Vector& direction) const;

 private:
  /// The chances of the quarters of a square for a surface with this normal; they add up to 1, or are 0.
  std::array<Real, 4> chances(const Vector& normal, size_t entry, uint32_t level,
                              const std::array<Real, 2>& corner) const;
  Vector texel(int64_t column, int64_t row) const;

  bool exists_;
  Vector ambient_;
  PackedSky sky_;
};

}  // namespace promin::oracle
