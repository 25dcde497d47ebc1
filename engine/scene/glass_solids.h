// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world_scene.h"

namespace promin {

/// The solids of glass in a scene, to tell in which of them a camera is.
class GlassSolids {
 public:
  GlassSolids() = default;
  /// Of the objects whose material lets light into a volume.
  explicit GlassSolids(const world::Scene& scene);

  bool is_empty() const { return solids_.empty(); }
  /// The materials of the solids around a point, the largest first. A plane's are all points behind it, a mesh's those
  /// that it goes around (its winding number is above 1/2), be it closed or not.
  std::vector<uint32_t> materials_around(const vec3& point) const;

 private:
  struct Solid {
    world::Shape shape;
    uint32_t material = 0;
    Bounds bounds;
  };
  /// The largest first.
  std::vector<Solid> solids_;
};

}  // namespace promin
