// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace promin {

/// How many rays a picture took.
struct RayCounts {
  /// From the camera.
  uint64_t primary = 0;
  /// To lights.
  uint64_t shadow = 0;
  /// From mirrors.
  uint64_t reflection = 0;
  /// Through the faces of glass.
  uint64_t refraction = 0;
  /// How often any of these went on behind a surface: one that blends (AlphaMode::kBlend), and shadow rays through
  /// glass.
  uint64_t passed = 0;
  /// How many of the camera's have met something.
  uint64_t primary_hits = 0;
  /// All rays, each once, however often it went through a surface.
  uint64_t total() const { return primary + shadow + reflection + refraction; }

  /// Adds those of another picture.
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
