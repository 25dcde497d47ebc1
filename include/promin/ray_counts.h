// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace promin {

/// Numbers of rays that promin traced for a picture.
struct RayCounts {
  /// Number of camera rays.
  uint64_t primary = 0;
  /// Number of shadow rays, which go to lights.
  uint64_t shadow = 0;
  /// Number of mirror rays.
  uint64_t reflection = 0;
  /// Number of rays refracted at the faces of glass.
  uint64_t refraction = 0;
  /// Number of times that any of these rays continued behind a surface that blends (AlphaMode::kBlend), or that a
  /// shadow ray continued through glass.
  uint64_t passed = 0;
  /// Number of camera rays that hit something.
  uint64_t primary_hits = 0;
  /// Returns the number of all rays. A ray counts once even if it continues behind surfaces.
  uint64_t total() const { return primary + shadow + reflection + refraction; }

  /// Adds the rays of another picture.
  RayCounts& operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflection += other.reflection;
    refraction += other.refraction;
    passed += other.passed;
    primary_hits += other.primary_hits;
    return *this;
  }
};

}  // namespace promin
