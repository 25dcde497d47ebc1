// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/scene_counts.h"

#include "promin/motion.h"

namespace promin::work {
namespace {

template <typename T>
uint64_t bytes_of(const std::vector<T>& elements) {
  return elements.size() * sizeof(T);
}

}  // namespace

SceneCounts count_scene(const Scene& scene) {
  SceneCounts counts;
  counts.geometry_bytes = bytes_of(scene.objects) + bytes_of(scene.geometries);
  for (const Geometry& geometry : scene.geometries) {
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
      counts.geometry_bytes += bytes_of(mesh->positions) + bytes_of(mesh->normals) + bytes_of(mesh->colors) +
                               bytes_of(mesh->uvs) + bytes_of(mesh->tangents) + bytes_of(mesh->triangles) +
                               bytes_of(mesh->triangle_materials);
    }
  }
  std::vector<bool> is_counted(scene.geometries.size(), false);
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) {
      ++counts.objects[0];
      continue;
    }
    const Geometry& geometry = scene.geometries[object.geometry];
    ++counts.objects[1 + geometry.index()];
    counts.primitives += primitive_count(geometry);
    if (!std::holds_alternative<Mesh>(geometry)) continue;
    counts.triangles += primitive_count(geometry);
    if (!is_counted[object.geometry]) counts.stored_triangles += primitive_count(geometry);
    is_counted[object.geometry] = true;
  }
  return counts;
}

MorphCounts count_morphs(const Motion& motion) {
  MorphCounts counts;
  for (const Node& node : motion.nodes) {
    if (node.weights.empty()) continue;
    ++counts.nodes;
    counts.targets += node.weights.size();
  }
  return counts;
}

}  // namespace promin::work
