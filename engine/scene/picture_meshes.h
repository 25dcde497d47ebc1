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

/// Meshes with what shading needs of them: normals that agree with the winding (scene/turned_normals.h), tangents where
/// a texture of normals is shown (textures/tangents.h), texture coordinates near 0 (textures/center_uvs.h). Each is
/// made once for the objects that need the same of it.
class PictureMeshes {
 public:
  /// The scene is valid and outlives this.
  explicit PictureMeshes(const Scene& scene);

  /// The mesh that an object shows, or nullopt where the scene's own serves.
  std::optional<Mesh> find(const Object& object);

 private:
  /// The set of coordinates that tangents are needed for, and what is taken off all coordinates.
  struct Needs {
    std::optional<uint32_t> tangents;
    std::array<double, 4> center{};
    bool turns_normals = false;

    auto operator<=>(const Needs&) const = default;
  };
  Needs needs_of(const Mesh& mesh, const Object& object);
  const std::vector<uint32_t>& find_turned(uint32_t geometry, const Mesh& mesh);

  const Scene& scene_;
  /// Of each geometry, how many objects show it.
  std::vector<uint32_t> object_counts_;
  /// For each geometry that an object has asked for.
  std::vector<std::optional<std::vector<uint32_t>>> turned_triangles_;
  std::map<std::pair<uint32_t, Needs>, Mesh> made_;
};

}  // namespace promin
