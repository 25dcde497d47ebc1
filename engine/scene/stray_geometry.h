// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "promin/framing.h"
#include "promin/scene.h"

namespace promin {

/// The main part of a scene, without stray geometry.
struct MainPart {
  /// Bounds of everything finite in it; empty if nothing is finite.
  Bounds bounds;
  /// The number of finite primitives outside of it.
  uint64_t stray_count = 0;
  /// Set if there are some: a primitive belongs to the part if the centre of its bounds lies in this box.
  std::optional<Bounds> centers = std::nullopt;
};

/// Returns everything finite, unless 99 percent of its surface lie in a box of less than 1/64 of its size, which would
/// be only a few pixels in a picture of everything. Then it returns the primitives whose centres lie in that box.
/// Throws InputError as bounds_of() does.
MainPart find_main_part(const Scene& scene);

/// Returns framing_of (promin/framing.h) for a scene with this main part.
Framing framing_of(const Scene& scene, const MainPart& part);

/// Returns whether a point lies in a box or on its surface.
bool holds(const Bounds& bounds, const vec3& point);

}  // namespace promin
