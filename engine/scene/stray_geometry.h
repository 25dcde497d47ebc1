// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "promin/framing.h"
#include "promin/scene.h"

namespace promin {

/// The part of a scene that is worth looking at.
struct MainPart {
  /// Bounds of everything finite in it; empty where nothing is finite.
  Bounds bounds;
  /// The number of finite primitives outside of it.
  uint64_t stray_count = 0;
  /// Where there are some: what belongs to the part has the centre of its bounds in this box.
  std::optional<Bounds> centers = std::nullopt;
};

/// Everything finite, unless 99 percent of its surface lie in a box of less than 1/64 of its size: then the bounds of
/// what has its centre there. A picture of everything would show that box as a few pixels. Throws InputError as
/// bounds_of() does.
MainPart find_main_part(const Scene& scene);

/// framing_of (promin/framing.h) of a scene with this main part.
Framing framing_of(const Scene& scene, const MainPart& part);

/// Whether a point lies in a box or on its surface.
bool holds(const Bounds& bounds, const vec3& point);

}  // namespace promin
