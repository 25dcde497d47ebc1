// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "lab/ray_files.h"

#include <algorithm>
#include <array>
#include <variant>

#include "rays/npy.h"

namespace promin::lab {
namespace {

class TriangleWriter : public ArrayWriter {
 public:
  explicit TriangleWriter(const std::filesystem::path& file)
      : ArrayWriter(file, "[('corners', '<f4', (3, 3))]", std::nullopt) {}
  void write(const std::array<vec3, 3>& corners) { ArrayWriter::write(std::as_bytes(std::span(corners)), 1); }
};

}  // namespace

void write_sets(const std::filesystem::path& folder, const std::string& prefix, std::span<const measure::RaySet> sets) {
  for (const measure::RaySet& set : sets) {
    std::string name = prefix + "_" + set.name + ".npy";
    for (const char odd : {' ', '/'}) std::replace(name.begin(), name.end(), odd, '_');
    write_rays(folder / name, set.rays);
  }
}

void write_triangles(const std::filesystem::path& folder, const std::string& prefix, const world::Scene& scene) {
  TriangleWriter writer(folder / (prefix + "_triangles.npy"));
  for (const world::Object& object : scene.objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    for (const uvec3& triangle : mesh->triangles) {
      writer.write({mesh->positions[triangle.x], mesh->positions[triangle.y], mesh->positions[triangle.z]});
    }
  }
  writer.commit();
}

}  // namespace promin::lab
