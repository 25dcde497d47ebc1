// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "promin/scene.h"
#include "scene/stray_geometry.h"

namespace promin {

/// The extent of the main part of a scene in any direction, exact for meshes and shapes. The scene must outlive the
/// hull.
class SceneHull {
 public:
  /// Computes the hull. Throws InputError as bounds_of() does.
  explicit SceneHull(const Scene& scene);

  const MainPart& main_part() const { return part_; }
  /// Returns the box that a camera frames (frame_of).
  const Bounds& bounds() const { return bounds_; }
  /// Returns the middle of the bounds.
  const dvec3& center() const { return center_; }
  /// Returns the point that lies farthest in a direction of any length except 0, minus the center.
  dvec3 farthest(const dvec3& direction) const;

 private:
  /// Consecutive vertices of a file, which are usually close together.
  struct Block {
    std::span<const vec3> positions;
    Bounds bounds;
  };
  struct Blocks {
    std::span<const Block> blocks;
    /// The bounds of all blocks.
    Bounds bounds;
  };
  struct PlacedMesh {
    /// The transform of the object; null for blocks in the world.
    const dmat4* world_from_object;
    const Blocks* of;
  };
  using Solid = std::variant<std::monostate
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) , world::TYPE
#include "promin/kinds/primitives.def"
                             >;
  struct Farthest {
    double value;
    dvec3 point;
  };
  struct Adder;

  void add(const Mesh& mesh, const Object& object, size_t number);
  Blocks cut(std::span<const vec3> positions);
  void find_farthest(const PlacedMesh& mesh, const dvec3& direction, Farthest& farthest) const;

  MainPart part_;
  Bounds bounds_;
  dvec3 center_;
  std::vector<PlacedMesh> meshes_;
  std::vector<Solid> solids_;
  /// The blocks of the geometries that were added, by the index of the geometry.
  std::map<uint32_t, Blocks> blocks_of_;
  /// The blocks of parts of objects.
  std::deque<Blocks> parts_;
  std::deque<std::vector<Block>> blocks_;
  std::deque<std::vector<vec3>> positions_;
};

}  // namespace promin
