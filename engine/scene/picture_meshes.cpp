// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/picture_meshes.h"

#include "scene/layers.h"
#include "scene/texture_slots.h"
#include "scene/turned_normals.h"
#include "textures/center_uvs.h"
#include "textures/tangents.h"

namespace promin {
namespace {

/// Returns whether the image of a slot could be read.
bool is_shown(const Scene& scene, const TextureSlot& slot) {
  return slot.exists() && !scene.images[scene.textures[slot.texture].image]->texels.empty();
}

/// Returns for each material whether the mesh uses it.
std::vector<bool> find_materials(const Mesh& mesh, const Object& object, size_t count) {
  std::vector<bool> is_on_mesh(count, false);
  if (mesh.triangle_materials.empty()) is_on_mesh[object.material] = true;
  for (const uint32_t material : mesh.triangle_materials) is_on_mesh[material] = true;
  return is_on_mesh;
}

}  // namespace

PictureMeshes::PictureMeshes(const Scene& scene)
    : scene_(scene), object_counts_(scene.geometries.size(), 0), turned_triangles_(scene.geometries.size()) {
  for (const Object& object : scene.objects) {
    if (object.geometry != Object::kNoGeometry) ++object_counts_[object.geometry];
  }
}

std::optional<Mesh> PictureMeshes::find(const Object& object) {
  const auto* mesh = std::get_if<Mesh>(&scene_.geometries[object.geometry]);
  if (mesh == nullptr) return std::nullopt;
  const Needs& needs = needs_of(*mesh, object);
  if (needs == Needs{}) return std::nullopt;
  const std::pair key(object.geometry, needs);
  if (const auto known = made_.find(key); known != made_.end()) return known->second;
  Mesh made = *mesh;
  if (needs.tangents) add_tangents(made, *needs.tangents);
  center_uvs(made, {needs.center[0], needs.center[1], needs.center[2], needs.center[3]});
  // Tangents and centers of coordinates split vertices but do not move triangles.
  turn_normals(made, find_turned(object.geometry, *mesh), needs.tangents.has_value());
  if (object_counts_[object.geometry] > 1) made_.emplace(key, made);
  return made;
}

const std::vector<uint32_t>& PictureMeshes::find_turned(uint32_t geometry, const Mesh& mesh) {
  std::optional<std::vector<uint32_t>>& known = turned_triangles_[geometry];
  if (!known) known = find_turned_triangles(mesh);
  return *known;
}

uint32_t PictureMeshes::version_of(const Object& object) {
  const auto* mesh = std::get_if<Mesh>(&scene_.geometries[object.geometry]);
  if (mesh == nullptr) return 0;
  const auto number = static_cast<uint32_t>(versions_.size());
  return versions_.try_emplace({object.geometry, needs_of(*mesh, object)}, number).first->second;
}

const PictureMeshes::Needs& PictureMeshes::needs_of(const Mesh& mesh, const Object& object) {
  const auto [known, is_new] = needs_.try_emplace({object.geometry, object.material});
  if (is_new) known->second = find_needs(mesh, object);
  return known->second;
}

PictureMeshes::Needs PictureMeshes::find_needs(const Mesh& mesh, const Object& object) {
  Needs needs;
  needs.turns_normals = !find_turned(object.geometry, mesh).empty();
  if (mesh.uvs.empty()) return needs;
  std::vector<TextureSlot> slots;
  // If slots use several sets of coordinates, the tangents are computed for the first one.
  const auto need_tangents = [&](const TextureSlot& slot) {
    if (mesh.tangents.empty() && !needs.tangents) needs.tangents = slot.uv_set;
  };
  const std::vector<bool> is_on_mesh = find_materials(mesh, object, scene_.materials.size());
  for (size_t i = 0; i < is_on_mesh.size(); ++i) {
    if (!is_on_mesh[i]) continue;
    for_each_slot(scene_.materials[i], [&](const TextureSlot& slot, const char* /*name*/, ImageUse use) {
      if (!is_shown(scene_, slot)) return;
      slots.push_back(slot);
      if (use == ImageUse::kNormal) need_tangents(slot);
    });
    const auto* model = std::get_if<MetallicRoughness>(&scene_.materials[i].model);
    if (model != nullptr && is_anisotropic(*model)) need_tangents(model->anisotropy_texture);
  }
  if (slots.empty()) return needs;
  const dvec4 center = find_uv_center(mesh, slots, scene_.textures);
  for (int i = 0; i < 4; ++i) needs.center[static_cast<size_t>(i)] = center[i];
  return needs;
}

}  // namespace promin
