// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "scene/world_scene.h"

namespace promin {

/// The solids of glass in a scene. The class finds the solids that contain a camera.
class GlassSolids {
 public:
  GlassSolids() = default;
  /// Collects the objects whose material transmits light into a volume.
  explicit GlassSolids(const world::Scene& scene);

  bool is_empty() const { return solids_.empty(); }
  /// Returns the materials of the solids that contain a point, the largest first. A plane contains all points behind
  /// it. A mesh, closed or not, contains the points with a winding number above 1/2.
  std::vector<uint32_t> materials_around(const vec3& point) const;

  /// Returns the solids after instances have moved; the same ones if no solid has moved. The pairs are objects, in
  /// ascending order, and their transforms.
  static std::shared_ptr<const GlassSolids> moved(const std::shared_ptr<const GlassSolids>& solids,
                                                  std::span<const std::pair<uint32_t, dmat4>> world_from_object);

 private:
  struct Solid {
    /// NotDrawn for an instance.
    world::Shape shape;
    uint32_t object = 0;
    uint32_t material = 0;
    Bounds bounds;
    /// The positions and triangles of an instance's mesh, and its map.
    std::shared_ptr<const Mesh> mesh = nullptr;
    Bounds mesh_bounds = {};
    world::InstanceMap map = {};
  };
  static bool contains(const Solid& solid, const vec3& point);
  void add_instances(const world::Scene& scene);
  void sort();
  /// The solids, sorted by descending volume.
  std::vector<Solid> solids_;
};

}  // namespace promin
