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
  /// How often any of these went through a surface that blends (AlphaMode::kBlend).
  uint64_t passed = 0;
  /// All rays, each once, however often it went through a surface.
  uint64_t total() const { return primary + shadow + reflection; }

  /// Adds those of another picture.
  RayCounts& operator+=(const RayCounts& other) {
    primary += other.primary;
    shadow += other.shadow;
    reflection += other.reflection;
    passed += other.passed;
    return *this;
  }
};

}  // namespace promin
