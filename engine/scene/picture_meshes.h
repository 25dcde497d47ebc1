// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// Meshes that are prepared for shading: normals agree with the winding (scene/turned_normals.h), normal textures have
/// tangents (textures/tangents.h), and texture coordinates lie near 0 (textures/center_uvs.h). Each mesh is made once
/// for all objects with the same needs.
class PictureMeshes {
 public:
  /// The scene must be valid and outlive this object.
  explicit PictureMeshes(const Scene& scene);

  /// Returns the mesh for an object, or nullopt if the scene's own mesh needs no change.
  std::optional<Mesh> find(const Object& object);

  /// Returns a number that is the same for two objects with the same geometry exactly if they need the same mesh.
  uint32_t version_of(const Object& object);

 private:
  /// The changes that an object's mesh needs: the set of coordinates for which tangents are computed, and the offset
  /// that is subtracted from all coordinates.
  struct Needs {
    std::optional<uint32_t> tangents;
    std::array<double, 4> center{};
    bool turns_normals = false;

    auto operator<=>(const Needs&) const = default;
  };
  const Needs& needs_of(const Mesh& mesh, const Object& object);
  Needs find_needs(const Mesh& mesh, const Object& object);
  const std::vector<uint32_t>& find_turned(uint32_t geometry, const Mesh& mesh);

  const Scene& scene_;
  /// The number of objects that use each geometry.
  std::vector<uint32_t> object_counts_;
  /// The turned triangles of each geometry that was requested so far.
  std::vector<std::optional<std::vector<uint32_t>>> turned_triangles_;
  std::map<std::pair<uint32_t, Needs>, Mesh> made_;
  /// The needs of each geometry with each material.
  std::map<std::pair<uint32_t, uint32_t>, Needs> needs_;
  std::map<std::pair<uint32_t, Needs>, uint32_t> versions_;
};

}  // namespace promin
