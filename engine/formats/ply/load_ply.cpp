// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/ply/load_ply.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/file.h"
#include "formats/ply/body.h"
#include "formats/ply/header.h"
#include "formats/triangulate.h"
#include "promin/validate.h"

namespace promin {
namespace {

constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

bool has_property(const PlyElement& element, std::string_view name) {
  return std::ranges::find(element.properties, name, &PlyProperty::name) != element.properties.end();
}

bool lists_vertices(const PlyElement* element) {
  if (element == nullptr || element->row_count == 0) return false;
  return std::ranges::any_of(element->properties, &PlyProperty::lists_vertices);
}

void warn_about_what_is_ignored(const PlyHeader& header, LoadReport& report) {
  for (const PlyElement& element : header.elements) {
    const auto has = [&](std::string_view name) { return has_property(element, name); };
    if (element.name == "vertex" || element.name == "face") {
      if (has("s") || has("u") || has("texture_u") || has("texcoord")) {
        report.warn("texture coordinates of PLY are ignored");
      }
      if (element.name == "face" && has("red")) report.warn("colours of faces are ignored");
    } else if (element.name != "tristrips" && element.row_count > 0) {
      report.warn("the element " + quote(element.name) + " is ignored");
    }
  }
}

bool has_rounded_coordinates(const PlyHeader& header) {
  if (header.encoding == PlyEncoding::kText) return false;
  const auto is_rounded = [](const PlyProperty& property) {
    return property.type == PlyType::kFloat32 && (property.name == "x" || property.name == "y" || property.name == "z");
  };
  return std::ranges::any_of(header.find("vertex")->properties, is_rounded);
}

/// What the header has to have.
void check_elements(const PlyHeader& header, LoadReport& report) {
  const PlyElement* vertices = header.find("vertex");
  if (vertices == nullptr) {
    report.refuse("there is no element \"vertex\"", "", "name a PLY file of a mesh");
    return;
  }
  if (!has_property(*vertices, "x") || !has_property(*vertices, "y") || !has_property(*vertices, "z")) {
    report.refuse("the vertices have no x, y and z", "", "export it with positions");
  }
  if (vertices->row_count >= kUnused) report.refuse("there are too many vertices", "", "cut the mesh in several");
  if (vertices->row_count == 0 || lists_vertices(header.find("face")) || lists_vertices(header.find("tristrips")))
    return;
  report.refuse("the file has " + std::to_string(vertices->row_count) + " vertices but no faces", "",
                "export it with faces; point clouds are not drawn");
}

bool is_in_range(const vec3& p) {
  // Written so that NaN fails.
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate;
}

/// Makes a mesh of what a file has.
class MeshMaker {
 public:
  MeshMaker(const PlyBody& body, LoadReport& report) : body_(body), report_(report) {}

  Mesh make() {
    add_vertices();
    report_.throw_if_refused();
    size_t first = 0;
    for (const uint32_t count : body_.corner_counts) {
      add_polygon(&body_.corners[first], count);
      first += count;
    }
    return std::move(mesh_);
  }

 private:
  /// Those that faces use, in the file's order; others may hold anything. What has no normal gets its vertices with its
  /// triangles.
  void add_vertices() {
    new_index_.resize(body_.positions.size(), kUnused);
    for (const uint32_t corner : body_.corners) new_index_[corner] = 0;
    mesh_.positions.reserve(body_.positions.size());
    mesh_.normals.reserve(body_.normals.size());
    mesh_.colors.reserve(body_.colors.size());
    for (uint32_t vertex = 0; vertex < new_index_.size(); ++vertex) {
      if (new_index_[vertex] == kUnused) continue;
      if (!is_in_range(body_.positions[vertex])) {
        report_.refuse("a vertex coordinate is not finite or beyond 1e15", "vertex " + std::to_string(vertex),
                       "export the mesh again, in a larger unit of length");
        return;
      }
      if (!has_normal(vertex)) continue;
      new_index_[vertex] = add_vertex(vertex);
      if (!body_.normals.empty()) mesh_.normals.push_back(body_.normals[vertex]);
    }
  }

  /// Whether the vertex needs none, or has one of some length.
  bool has_normal(uint32_t vertex) const {
    if (body_.normals.empty()) return true;
    const double length = glm::length(dvec3(body_.normals[vertex]));
    return length > 0.0 && std::isfinite(length);
  }

  uint32_t add_vertex(uint32_t vertex) {
    mesh_.positions.push_back(body_.positions[vertex]);
    if (!body_.colors.empty()) mesh_.colors.push_back(body_.colors[vertex]);
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
  }

  void add_polygon(const uint32_t* corners, uint32_t count) {
    if (count == 3) return add_triangle(uvec3(corners[0], corners[1], corners[2]));
    polygon_.clear();
    for (uint32_t i = 0; i < count; ++i) polygon_.push_back(body_.positions[corners[i]]);
    for (const uvec3& t : triangulate_polygon(polygon_)) {
      add_triangle(uvec3(corners[t.x], corners[t.y], corners[t.z]));
    }
  }

  /// `corners` are indices of the file.
  void add_triangle(const uvec3& corners) {
    uvec3 vertices(new_index_[corners.x], new_index_[corners.y], new_index_[corners.z]);
    if (!has_normal(corners.x) || !has_normal(corners.y) || !has_normal(corners.z)) {
      vertices = add_sharp_corners(corners);
    }
    mesh_.triangles.push_back(vertices);
  }

  /// A triangle without area is never hit, so any normal will do for it.
  uvec3 add_sharp_corners(const uvec3& corners) {
    report_.warn("there are normals of no length, faces that use them are drawn sharp");
    const dvec3 a(body_.positions[corners.x]);
    const dvec3 normal = glm::cross(dvec3(body_.positions[corners.y]) - a, dvec3(body_.positions[corners.z]) - a);
    const double length = glm::length(normal);
    uvec3 vertices;
    for (int i = 0; i < 3; ++i) {
      vertices[i] = add_vertex(corners[i]);
      mesh_.normals.push_back(length > 0.0 ? vec3(normal / length) : vec3(0.0F, 1.0F, 0.0F));
    }
    return vertices;
  }

  const PlyBody& body_;
  LoadReport& report_;
  Mesh mesh_;
  std::vector<uint32_t> new_index_;
  std::vector<vec3> polygon_;
};

}  // namespace

Scene load_ply(const LoadOptions& /*options*/, LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = parse_ply_header(file, report);
  report.throw_if_refused();
  check_elements(header, report);
  report.throw_if_refused();
  warn_about_what_is_ignored(header, report);
  if (has_rounded_coordinates(header)) report.note_rounded_coordinates();
  const PlyBody body = read_ply_body(file, header, report);
  report.throw_if_refused();

  Scene scene;
  scene.file = report.file();
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  Mesh mesh = MeshMaker(body, report).make();
  if (!mesh.triangles.empty()) scene.add("", std::move(mesh));
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
