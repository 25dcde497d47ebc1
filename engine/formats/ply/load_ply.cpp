// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/ply/load_ply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "core/file.h"
#include "formats/obj/paths.h"
#include "formats/picture_sources.h"
#include "formats/ply/body.h"
#include "formats/ply/header.h"
#include "formats/scene_path.h"
#include "formats/triangulate.h"
#include "promin/validate.h"
#include "scene/limits.h"

namespace promin {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

bool has_property(const PlyElement& element, std::string_view name) {
  return std::ranges::find(element.properties, name, &PlyProperty::name) != element.properties.end();
}

bool lists_vertices(const PlyElement* element) {
  if (element == nullptr || element->row_count == 0) return false;
  return std::ranges::any_of(element->properties, &PlyProperty::lists_vertices);
}

bool has_uvs(const PlyElement& element) {
  const auto has = [&](std::string_view name) { return has_property(element, name); };
  return has("s") || has("u") || has("texture_u") || has("texture_s") || has("texcoord");
}

void warn_about_ignored_elements(const PlyHeader& header, LoadReport& report) {
  bool are_uvs_there = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" || element.name == "face") {
      are_uvs_there = are_uvs_there || has_uvs(element);
    } else if (element.name != "tristrips" && element.row_count > 0) {
      report.warn("the element " + quote(element.name) + " is ignored");
    }
  }
  if (are_uvs_there && header.texture_files.empty()) {
    report.warn("texture coordinates are ignored because no comment TextureFile names a picture");
  }
  if (!are_uvs_there && !header.texture_files.empty()) {
    report.warn("the picture " + quote(header.texture_files.front()) +
                " is ignored because there are no texture coordinates");
  }
}

bool has_rounded_coordinates(const PlyHeader& header) {
  if (header.encoding == PlyEncoding::kText) return false;
  const auto is_rounded = [](const PlyProperty& property) {
    return property.type == PlyType::kFloat32 && (property.name == "x" || property.name == "y" || property.name == "z");
  };
  return std::ranges::any_of(header.find("vertex")->properties, is_rounded);
}

/// Checks that the header has the required elements and properties.
void check_elements(const PlyHeader& header, LoadReport& report) {
  const PlyElement* vertices = header.find("vertex");
  if (vertices == nullptr) {
    report.refuse("ply.vertices.missing", "the file has no element \"vertex\"", "",
                  "use a PLY file that contains a mesh");
    return;
  }
  if (!has_property(*vertices, "x") || !has_property(*vertices, "y") || !has_property(*vertices, "z")) {
    report.refuse("ply.vertices.missing", "the vertices have no x, y and z", "", "export the mesh with positions");
  }
  if (vertices->row_count >= kNone)
    report.refuse("ply.vertices.many", "the file has too many vertices", "", "divide the mesh into several files");
  if (vertices->row_count == 0 || lists_vertices(header.find("face")) || lists_vertices(header.find("tristrips")))
    return;
  report.refuse("ply.faces.missing", "the file has " + std::to_string(vertices->row_count) + " vertices but no faces",
                "", "export the model with faces, because promin does not draw point clouds");
}

/// Makes a mesh from the content of a file.
class MeshMaker {
 public:
  /// `material_of_texture` has the material of the faces with each texture file; kNone if its picture cannot be
  /// shown.
  MeshMaker(const PlyBody& body, const std::vector<uint32_t>& material_of_texture, LoadReport& report)
      : body_(body),
        material_of_texture_(material_of_texture),
        report_(report),
        has_normals_(!body.normals.empty()),
        has_colors_(!body.colors.empty() || !body.face_colors.empty()),
        has_uvs_(shows_textures() && (!body.uvs.empty() || !body.corner_uvs.empty())),
        is_split_(!body.face_colors.empty() || (has_uvs_ && !body.corner_uvs.empty())) {}

  Mesh make() {
    if (is_split_) {
      newest_vertex_.resize(body_.positions.size(), kNone);
    } else {
      add_vertices();
    }
    for (const uint32_t count : body_.corner_counts) {
      add_polygon(count);
      first_corner_ += count;
      ++polygon_;
    }
    return std::move(mesh_);
  }

 private:
  /// The largest number of vertices at one position that are searched. It limits the time if very many faces around one
  /// position have different colours.
  static constexpr int kMostTries = 32;

  bool shows_textures() const {
    return std::ranges::any_of(material_of_texture_, [](uint32_t material) { return material != kNone; });
  }

  /// Adds the vertices that faces use, in the file's order. Unused vertices may have any content. Vertices without
  /// normals are added later, with their triangles.
  void add_vertices() {
    new_index_.resize(body_.positions.size(), kNone);
    for (const uint32_t corner : body_.corners) new_index_[corner] = 0;
    mesh_.positions.reserve(body_.positions.size());
    mesh_.normals.reserve(body_.normals.size());
    mesh_.colors.reserve(body_.colors.size());
    if (has_uvs_) mesh_.uvs.reserve(body_.uvs.size());
    for (uint32_t vertex = 0; vertex < new_index_.size(); ++vertex) {
      if (new_index_[vertex] == kNone || !is_in_range(dvec3(body_.positions[vertex])) || !has_normal(vertex)) continue;
      new_index_[vertex] = add_vertex(look_of(vertex, 0));
      if (has_normals_) mesh_.normals.push_back(body_.normals[vertex]);
    }
  }

  /// Returns whether the vertex needs no normal, or has a normal of non-zero length.
  bool has_normal(uint32_t vertex) const {
    if (!has_normals_) return true;
    const double length = glm::length(dvec3(body_.normals[vertex]));
    return length > 0.0 && std::isfinite(length);
  }

  /// The attributes of a vertex other than its normal.
  struct Look {
    uint32_t vertex = 0;
    vec4 color{1.0F};
    vec4 uv{0.0F};
  };

  /// Returns the attributes of a corner, given by its vertex and its index into PlyBody::corners. The index matters
  /// only if faces have attributes.
  Look look_of(uint32_t vertex, size_t corner) const {
    Look look{vertex};
    if (!body_.colors.empty()) look.color = body_.colors[vertex];
    if (!body_.face_colors.empty()) look.color = body_.face_colors[polygon_];
    if (!has_uvs_) return look;
    const vec2 uv = body_.corner_uvs.empty() ? body_.uvs[vertex] : body_.corner_uvs[corner];
    // In a mesh v increases downwards, from the first row of a picture.
    look.uv = vec4(uv.x, static_cast<float>(1.0 - static_cast<double>(uv.y)), 0.0F, 0.0F);
    return look;
  }

  uint32_t add_vertex(const Look& look) {
    mesh_.positions.push_back(body_.positions[look.vertex]);
    if (has_colors_) mesh_.colors.push_back(look.color);
    if (has_uvs_) mesh_.uvs.push_back(look.uv);
    if (is_split_) previous_vertex_.push_back(kNone);
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
  }

  /// Returns the vertex with these attributes. The vertices at one position of the file form a chain, the newest first.
  uint32_t find_or_add_vertex(const Look& look) {
    uint32_t known = newest_vertex_[look.vertex];
    for (int i = 0; known != kNone && i < kMostTries; known = previous_vertex_[known], ++i) {
      const bool is_same =
          (!has_colors_ || mesh_.colors[known] == look.color) && (!has_uvs_ || mesh_.uvs[known] == look.uv);
      if (is_same) return known;
    }
    const uint32_t vertex = add_vertex(look);
    if (has_normals_) mesh_.normals.push_back(body_.normals[look.vertex]);
    previous_vertex_[vertex] = newest_vertex_[look.vertex];
    newest_vertex_[look.vertex] = vertex;
    return vertex;
  }

  bool is_drawable(std::span<const uint32_t> corners) {
    for (const uint32_t corner : corners) {
      if (is_in_range(dvec3(body_.positions[corner]))) continue;
      report_.repair({"ply.position.range", "a face has a vertex coordinate that is not a number up to 1e15", "",
                      "vertex " + std::to_string(corner), "export the mesh again, in a larger unit of length",
                      "promin omits the face"});
      return false;
    }
    return true;
  }

  void add_polygon(uint32_t count) {
    const std::span corners = std::span(body_.corners).subspan(first_corner_, count);
    if (!is_drawable(corners)) return;
    if (count == 3) {
      add_triangle(uvec3(0, 1, 2));
    } else {
      polygon_positions_.clear();
      for (const uint32_t corner : corners) polygon_positions_.push_back(body_.positions[corner]);
      for (const uvec3& triangle : triangulate_polygon(polygon_positions_)) add_triangle(triangle);
    }
    if (has_uvs_) mesh_.triangle_materials.resize(mesh_.triangles.size(), material_of_polygon());
  }

  /// Returns the material of the current polygon; kNone if the polygon shows no picture.
  uint32_t material_of_polygon() const {
    const uint32_t texture = body_.face_textures.empty() ? 0 : body_.face_textures[polygon_];
    return texture == PlyBody::kNoTexture ? kNone : material_of_texture_[texture];
  }

  /// Adds a triangle. `places` are the positions of its corners in the polygon.
  void add_triangle(const uvec3& places) {
    const uint32_t* corners = &body_.corners[first_corner_];
    const bool is_smooth =
        has_normal(corners[places.x]) && has_normal(corners[places.y]) && has_normal(corners[places.z]);
    if (!is_smooth) return add_sharp_triangle(places);
    uvec3 vertices;
    for (int i = 0; i < 3; ++i) {
      const uint32_t corner = corners[places[i]];
      vertices[i] = is_split_ ? find_or_add_vertex(look_of(corner, first_corner_ + places[i])) : new_index_[corner];
    }
    mesh_.triangles.push_back(vertices);
  }

  /// Adds a flat-shaded triangle. If it has no area, its normal may be any vector, because no ray hits it.
  void add_sharp_triangle(const uvec3& places) {
    const uint32_t* corners = &body_.corners[first_corner_];
    report_.repair({"ply.normal.zero", "a face has a normal that is 0 or not a number", "",
                    "vertex " + std::to_string(corners[places.x]), "export the mesh again", "the face is shaded flat"});
    const dvec3 a(body_.positions[corners[places.x]]);
    const dvec3 b(body_.positions[corners[places.y]]);
    const dvec3 c(body_.positions[corners[places.z]]);
    const dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    uvec3 vertices;
    for (int i = 0; i < 3; ++i) {
      vertices[i] = add_vertex(look_of(corners[places[i]], first_corner_ + places[i]));
      mesh_.normals.push_back(length > 0.0 ? vec3(normal / length) : vec3(0.0F, 1.0F, 0.0F));
    }
    mesh_.triangles.push_back(vertices);
  }

  const PlyBody& body_;
  const std::vector<uint32_t>& material_of_texture_;
  LoadReport& report_;
  bool has_normals_;
  bool has_colors_;
  bool has_uvs_;
  /// True if faces have attributes of corners, so that vertices must be split.
  bool is_split_;
  Mesh mesh_;
  /// The current polygon, and the index of its first corner.
  size_t polygon_ = 0;
  size_t first_corner_ = 0;
  /// The mesh vertex of each vertex of the file, if no vertex is split.
  std::vector<uint32_t> new_index_;
  /// If vertices are split, the newest mesh vertex at the position of each vertex of the file.
  std::vector<uint32_t> newest_vertex_;
  /// For each vertex of the mesh, the previous vertex at the same position.
  std::vector<uint32_t> previous_vertex_;
  std::vector<vec3> polygon_positions_;
};

/// Adds a material for each texture file whose picture can be shown, with its image and texture. Returns the index of
/// each file's material; kNone for a file without a material.
std::vector<uint32_t> add_textures(const std::vector<std::string>& files, bool takes_texels, Scene& scene,
                                   LoadReport& report) {
  std::vector<PictureSource> sources;
  for (const std::string& name : files) {
    PictureSource& source = sources.emplace_back();
    source.takes_texels = takes_texels;
    source.image->name = name;
    source.title = quote(name);
    read_picture(source, report, [&](LoadReport& attempt, uint64_t most_bytes) {
      std::optional<std::string> named = find_named_file(name, "", attempt);
      if (!named) named = find_by_last_part(name, "", attempt);
      const auto file = find_beside_scene(named.value_or(name), "", true, attempt);
      return file ? std::optional(read_file(*file, most_bytes)) : std::nullopt;
    });
  }
  decode_pictures(sources, report);
  std::vector<uint32_t> materials;
  for (const PictureSource& source : sources) {
    if (source.problem) {
      materials.push_back(kNone);
      continue;
    }
    materials.push_back(static_cast<uint32_t>(scene.materials.size()));
    Phong phong;
    phong.diffuse = vec3(1.0F);
    phong.ambient = vec3(1.0F);
    phong.diffuse_texture.texture = static_cast<uint32_t>(scene.textures.size());
    Material& material = scene.materials.emplace_back();
    material.name = source.image->name;
    material.model = phong;
    scene.textures.emplace_back().image = static_cast<uint32_t>(scene.images.size());
    scene.images.push_back(source.image);
  }
  return materials;
}

/// Adds the mesh if it is not empty, and the grey material if a triangle of the mesh uses it.
void add_mesh(Mesh mesh, Scene& scene) {
  const auto grey = static_cast<uint32_t>(scene.materials.size());
  std::vector<uint32_t>& materials = mesh.triangle_materials;
  std::ranges::replace(materials, kNone, grey);
  if (materials.empty() || std::ranges::find(materials, grey) != materials.end()) {
    scene.materials.emplace_back().name = "default";
  }
  if (mesh.triangles.empty()) return;
  const uint32_t first = materials.empty() ? grey : materials.front();
  if (std::ranges::count(materials, first) == static_cast<std::ptrdiff_t>(materials.size())) materials.clear();
  scene.add("", std::move(mesh), first);
}

}  // namespace

Scene load_ply(const LoadOptions& options, LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = parse_ply_header(file, report);
  report.throw_if_refused();
  check_elements(header, report);
  report.throw_if_refused();
  warn_about_ignored_elements(header, report);
  if (has_rounded_coordinates(header)) report.note_rounded_coordinates();
  const PlyBody body = read_ply_body(file, header, report);
  report.throw_if_refused();

  Scene scene;
  scene.file = report.file();
  const bool has_uvs = !body.uvs.empty() || !body.corner_uvs.empty();
  const std::vector<uint32_t> materials =
      add_textures(has_uvs ? header.texture_files : std::vector<std::string>(), options.decodes_images, scene, report);
  add_mesh(MeshMaker(body, materials, report).make(), scene);
  report.throw_if_refused();
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
