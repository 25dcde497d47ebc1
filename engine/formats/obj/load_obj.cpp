// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/load_obj.h"

#include <algorithm>
#include <cstddef>
#include <map>

#include "core/file.h"
#include "formats/obj/materials.h"
#include "formats/obj/paths.h"
#include "formats/obj/text.h"
#include "formats/obj/textures.h"
#include "formats/triangulate.h"
#include "scene/texture_slots.h"

namespace promin {
namespace {

/// Builds the meshes of groups one after the other. The vertices of a mesh are the positions that its faces use, with
/// normals and, if there is a texture, texture coordinates.
class MeshBuilder {
 public:
  MeshBuilder(const ObjText& text, LoadReport& report)
      : text_(text), report_(report), newest_vertex_(text.positions.size(), kNoObjIndex) {}

  Mesh build(const ObjGroup& group, bool needs_uvs) {
    mesh_ = {};
    previous_vertex_.clear();
    corner_of_vertex_.clear();
    needs_uvs_ = needs_uvs;
    const auto* faces = &text_.faces[group.first_face];
    has_normals_ = std::any_of(faces, faces + group.face_count, [&](const ObjFace& f) { return has_normals(f); });
    for (uint32_t i = 0; i < group.face_count; ++i) add_face(faces[i]);
    for (uint32_t i = 0; i < group.face_count; ++i) forget_vertices(faces[i]);
    return std::move(mesh_);
  }

 private:
  bool has_normals(const ObjFace& face) {
    for (uint32_t i = 0; i < face.corner_count; ++i) {
      const uint32_t normal = text_.corners[face.first_corner + i].normal;
      if (normal == kNoObjIndex) return false;
      const double length = glm::length(dvec3(text_.normals[normal]));
      if (length > 0.0) continue;
      if (length == 0.0) report_.warn("some normals have length 0; promin draws faces that use them with flat shading");
      return false;
    }
    return true;
  }

  void add_face(const ObjFace& face) {
    const ObjCorner* corners = &text_.corners[face.first_corner];
    if (face.corner_count == 3) return add_triangle(face, uvec3(0, 1, 2));
    polygon_.clear();
    for (uint32_t i = 0; i < face.corner_count; ++i) polygon_.push_back(text_.positions[corners[i].position]);
    for (const uvec3& triangle : triangulate_polygon(polygon_)) add_triangle(face, triangle);
  }

  void add_triangle(const ObjFace& face, const uvec3& triangle) {
    const ObjCorner* corners = &text_.corners[face.first_corner];
    uvec3 vertices;
    if (has_normals_ && !has_normals(face)) {
      const dvec3 a(text_.positions[corners[triangle.x].position]);
      const dvec3 b(text_.positions[corners[triangle.y].position]);
      const dvec3 c(text_.positions[corners[triangle.z].position]);
      const dvec3 normal = glm::cross(b - a, c - a);
      const double length = glm::length(normal);
      // A flat-shaded corner among smooth ones gets its own vertices. A triangle without area is never hit, so its
      // normal does not matter.
      for (int i = 0; i < 3; ++i) {
        vertices[i] = add_vertex(corners[triangle[i]]);
        mesh_.normals.push_back(length > 0.0 ? vec3(normal / length) : vec3(0.0F, 1.0F, 0.0F));
      }
    } else {
      for (int i = 0; i < 3; ++i) vertices[i] = find_or_add_vertex(corners[triangle[i]]);
    }
    mesh_.triangles.push_back(vertices);
  }

  /// Returns the vertex for a corner. The vertices at one position form a chain, the newest first. The chain is short,
  /// because a point has few normals and texture coordinates.
  uint32_t find_or_add_vertex(const ObjCorner& corner) {
    const ObjCorner wanted = {corner.position, needs_uvs_ ? corner.uv : kNoObjIndex,
                              has_normals_ ? corner.normal : kNoObjIndex};
    for (uint32_t v = newest_vertex_[corner.position]; v != kNoObjIndex; v = previous_vertex_[v]) {
      if (corner_of_vertex_[v] == wanted) return v;
    }
    const uint32_t vertex = add_vertex(corner);
    previous_vertex_[vertex] = newest_vertex_[corner.position];
    newest_vertex_[corner.position] = vertex;
    corner_of_vertex_[vertex] = wanted;
    if (has_normals_) mesh_.normals.push_back(text_.normals[corner.normal]);
    return vertex;
  }

  uint32_t add_vertex(const ObjCorner& corner) {
    mesh_.positions.push_back(text_.positions[corner.position]);
    if (!text_.colors.empty()) mesh_.colors.emplace_back(text_.colors[corner.position], 1.0F);
    if (needs_uvs_) mesh_.uvs.push_back(uv_of(corner));
    previous_vertex_.push_back(kNoObjIndex);
    corner_of_vertex_.push_back({});
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
  }

  /// Returns the texture coordinates of a corner. In a mesh v increases downwards, from the first row of a picture.
  vec4 uv_of(const ObjCorner& corner) {
    if (corner.uv == kNoObjIndex) {
      report_.warn("some corners of textured faces have no texture coordinates; promin uses 0");
      return vec4(0.0F, 1.0F, 0.0F, 0.0F);
    }
    const dvec2 uv = text_.uvs[corner.uv];
    return vec4(static_cast<float>(uv.x), static_cast<float>(1.0 - uv.y), 0.0F, 0.0F);
  }

  void forget_vertices(const ObjFace& face) {
    for (uint32_t i = 0; i < face.corner_count; ++i) {
      newest_vertex_[text_.corners[face.first_corner + i].position] = kNoObjIndex;
    }
  }

  const ObjText& text_;
  LoadReport& report_;
  Mesh mesh_;
  bool has_normals_ = false;
  bool needs_uvs_ = false;
  std::vector<uint32_t> newest_vertex_;
  std::vector<uint32_t> previous_vertex_;
  /// The corners of the vertices that may be shared.
  std::vector<ObjCorner> corner_of_vertex_;
  std::vector<vec3> polygon_;
};

/// Adds the materials that faces use to the scene. Returns the index in Scene::materials for each usemtl name.
std::vector<uint32_t> add_materials(const ObjText& text, Scene& scene, LoadReport& report) {
  std::map<std::string, MtlMaterial> known = read_mtl_files(text.libraries, report);
  std::vector<MtlMaterial*> used;
  const auto find = [&](const std::string& name) {
    const auto whole = known.find(name);
    return whole != known.end() ? whole : known.find(std::string(without_comment(name)));
  };
  for (const std::string& name : text.material_names) {
    if (const auto found = find(name); found != known.end()) used.push_back(&found->second);
  }
  ObjTextures textures(used, report);
  std::vector<uint32_t> indices;
  for (const std::string& name : text.material_names) {
    indices.push_back(static_cast<uint32_t>(scene.materials.size()));
    if (const auto found = find(name); found != known.end()) {
      add_obj_material(found->second, textures, scene, report);
      continue;
    }
    scene.materials.emplace_back().name = name;
    report.warn("material " + quote(name) + " is not defined in any MTL file; promin draws it grey");
  }
  textures.finish(scene);
  return indices;
}

/// Returns the material of each triangle of a group, in the order of the triangles.
std::vector<uint32_t> materials_of(const ObjText& text, const ObjGroup& group, const std::vector<uint32_t>& indices,
                                   uint32_t otherwise) {
  std::vector<uint32_t> materials;
  for (uint32_t i = 0; i < group.face_count; ++i) {
    const ObjFace& face = text.faces[group.first_face + i];
    const uint32_t material = face.material == kNoObjIndex ? otherwise : indices[face.material];
    materials.insert(materials.end(), face.corner_count - 2, material);
  }
  return materials;
}

bool shows_texture(const Material& material) {
  bool has_any = false;
  for_each_slot(material, [&](const TextureSlot& slot, const char* /*name*/, ImageUse /*use*/) {
    has_any = has_any || slot.exists();
  });
  return has_any;
}

void refuse_without_faces(const ObjText& text, LoadReport& report) {
  const auto refuse = [&](const std::string& what) {
    report.refuse("obj.faces.none", what, "", "export the model with faces");
  };
  const std::string vertices = "the file has " + std::to_string(text.positions.size()) + " vertices but no faces";
  if (text.small_face_count > 0) return refuse("all faces have fewer than 3 corners, so there is nothing to draw");
  if (text.has_lines_or_points) return refuse(vertices + ", and promin does not draw lines and points");
  refuse(text.positions.empty() ? "the file has neither vertices nor faces" : vertices);
}

}  // namespace

Scene load_obj(const LoadOptions& /*options*/, LoadReport& report) {
  const std::filesystem::path& file = report.file();
  const std::vector<std::byte> bytes = read_file(file);
  const ObjText text = parse_obj_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, report);
  report.throw_if_refused();
  if (text.faces.empty()) refuse_without_faces(text, report);

  Scene scene;
  scene.file = file;
  const std::vector<uint32_t> indices = add_materials(text, scene, report);
  report.throw_if_refused();
  const bool needs_default = scene.materials.empty() || std::any_of(text.faces.begin(), text.faces.end(),
                                                                    [](auto& f) { return f.material == kNoObjIndex; });
  const auto default_material = static_cast<uint32_t>(scene.materials.size());
  if (needs_default) {
    scene.materials.emplace_back();
    scene.materials.back().name = "default";
  }

  std::vector<bool> is_textured;
  for (const Material& material : scene.materials) is_textured.push_back(shows_texture(material));
  MeshBuilder builder(text, report);
  for (const ObjGroup& group : text.groups) {
    std::vector<uint32_t> materials = materials_of(text, group, indices, default_material);
    const bool needs_uvs = std::any_of(materials.begin(), materials.end(), [&](uint32_t m) { return is_textured[m]; });
    Mesh mesh = builder.build(group, needs_uvs);
    mesh.triangle_materials = std::move(materials);
    const uint32_t first = mesh.triangle_materials.front();
    const bool has_one_material = std::all_of(mesh.triangle_materials.begin(), mesh.triangle_materials.end(),
                                              [&](uint32_t material) { return material == first; });
    if (has_one_material) mesh.triangle_materials.clear();
    scene.add(group.name, std::move(mesh), first);
  }
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
