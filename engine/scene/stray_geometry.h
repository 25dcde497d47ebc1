// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "promin/framing.h"
#include "promin/scene.h"

namespace promin {

/// The main part of a scene, without stray geometry.
struct MainPart {
  /// Bounds of all finite geometry of the main part; empty if nothing is finite.
  Bounds bounds;
  /// The number of finite primitives outside the main part.
  uint64_t stray_count = 0;
  /// Set if there are primitives outside. A primitive belongs to the main part if the centre of its bounds lies in this
  /// box.
  std::optional<Bounds> centers = std::nullopt;
  /// The bounds of each object that counts as a whole; empty for other objects. Instances count as wholes
  /// (scene/choose_instances.h), because they may have billions of triangles.
  std::vector<Bounds> wholes = {};

  bool is_whole(size_t object) const { return !wholes[object].is_empty(); }
};

/// Returns all finite geometry, unless 99 percent of the surface area lie in a box smaller than 1/64 of the scene's
/// size, which would be only a few pixels in a picture of the whole scene. In that case it returns the primitives whose
/// centres lie in that box. Throws InputError as bounds_of() does.
MainPart find_main_part(const Scene& scene);

/// Returns framing_of() of promin/framing.h for a scene with this main part.
Framing framing_of(const Scene& scene, const MainPart& part);

/// Returns whether a point lies in a box or on its surface.
bool holds(const Bounds& bounds, const vec3& point);

}  // namespace promin
