// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/copies.h"

#include <string>
#include <variant>

#include "promin/error.h"
#include "shared/layout.h"

namespace promin {
namespace {

/// The bytes of the records of a triangle while promin packs a scene: its primitive, its surface and its box.
constexpr uint64_t kRecordBytes = sizeof(layout::Primitive) + sizeof(layout::SurfaceRecord) + sizeof(Bounds);

template <typename Element>
uint64_t bytes_of(const std::vector<Element>& elements) {
  return elements.size() * sizeof(Element);
}

uint64_t bytes_of(const Mesh& mesh) {
  return bytes_of(mesh.positions) + bytes_of(mesh.triangles) + bytes_of(mesh.normals) + bytes_of(mesh.colors) +
         bytes_of(mesh.uvs) + bytes_of(mesh.tangents) + bytes_of(mesh.triangle_materials);
}

std::string in_megabytes(uint64_t bytes) {
  return std::to_string(bytes / 1'000'000) + " MB";
}

}  // namespace

Copies count_copies(const Scene& scene, const std::vector<bool>& is_instance) {
  Copies copies;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const uint32_t geometry = scene.objects[i].geometry;
    if (is_instance[i] || geometry == Object::kNoGeometry) continue;
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[geometry]);
    if (mesh == nullptr) continue;
    copies.triangles += mesh->triangles.size();
    copies.bytes += bytes_of(*mesh) + kRecordBytes * mesh->triangles.size();
  }
  return copies;
}

void check_copies(const Copies& copies, std::optional<uint64_t> available_bytes, const std::filesystem::path& file) {
  const std::string count = std::to_string(copies.triangles);
  if (copies.triangles > layout::CHILD_FIRST_MASK) {
    throw RunError({"scene.size.limit", "the objects that are no instances have " + count + " triangles", file.string(),
                    "use fewer, because promin supports at most " + std::to_string(layout::CHILD_FIRST_MASK) +
                        ", or draw objects that share a mesh as instances",
                    Setting::kInstances});
  }
  if (available_bytes && copies.bytes > *available_bytes) {
    throw RunError(
        {"scene.memory.short",
         "the " + count + " triangles of objects that are no instances take at least " + in_megabytes(copies.bytes) +
             ", and " + in_megabytes(*available_bytes) + " of memory are available",
         file.string(), "use fewer triangles, or draw objects that share a mesh as instances", Setting::kInstances});
  }
}

}  // namespace promin
