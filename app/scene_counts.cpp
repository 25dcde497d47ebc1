// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene_counts.h"

namespace promin::app {
namespace {

uint64_t count_degenerate(const Mesh& mesh) {
  uint64_t count = 0;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) count += is_degenerate(mesh, i) ? 1 : 0;
  return count;
}

template <typename T>
uint64_t bytes_of(const std::vector<T>& elements) {
  return elements.size() * sizeof(T);
}

}  // namespace

SceneCounts count_scene(const Scene& scene) {
  SceneCounts counts;
  counts.geometry_bytes = bytes_of(scene.objects);
  for (const Object& object : scene.objects) {
    ++counts.objects[object.shape.index()];
    counts.primitives += primitive_count(object.shape);
    if (const Mesh* mesh = std::get_if<Mesh>(&object.shape)) {
      counts.triangles += mesh->triangles.size();
      counts.degenerate_triangles += count_degenerate(*mesh);
      counts.geometry_bytes += bytes_of(mesh->positions) + bytes_of(mesh->normals) + bytes_of(mesh->colors) +
                               bytes_of(mesh->triangles) + bytes_of(mesh->triangle_materials);
    }
  }
  return counts;
}

}  // namespace promin::app
