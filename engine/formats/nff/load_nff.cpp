// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/nff/load_nff.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <variant>

#include "core/file.h"
#include "formats/nff/text.h"
#include "formats/text_lines.h"
#include "formats/triangulate.h"

namespace promin {
namespace {

/// Returns the material in promin's model. NFF has no ambient light; ambient light that a user adds uses the diffuse
/// colour.
Phong to_phong(const NffMaterial& nff) {
  Phong phong;
  phong.diffuse = nff.diffuse * nff.color;
  phong.ambient = phong.diffuse;
  phong.specular = vec3(nff.specular);
  phong.shininess = nff.shininess;
  phong.reflection = vec3(nff.specular);
  phong.transmission = vec3(nff.transmittance);
  // Files have an index of 0 if nothing is refracted.
  phong.ior = nff.ior > 0.0F ? nff.ior : 1.0F;
  return phong;
}

/// Adds polygons to a mesh. Polygons share no corners, because a file lists the corners of each polygon.
class PolygonMesh {
 public:
  PolygonMesh(const NffText& text, LoadReport& report) : text_(text), report_(report) {}

  void add(const NffPolygon& polygon) {
    const std::span corners = std::span(text_.corners).subspan(polygon.first_corner, polygon.corner_count);
    const bool is_smooth = polygon.has_normals && has_directions(normals_of(polygon));
    if (is_smooth) {
      make_smooth();
      add_smooth(corners, normals_of(polygon));
    } else {
      for (const uvec3& triangle : triangulate_polygon(corners)) add_sharp(corners, triangle);
    }
  }

  Mesh take() { return std::move(mesh_); }

 private:
  std::span<const vec3> normals_of(const NffPolygon& polygon) const {
    return std::span(text_.normals).subspan(polygon.first_normal, polygon.corner_count);
  }

  bool has_directions(std::span<const vec3> normals) {
    const bool result = std::ranges::find(normals, vec3(0.0F)) == normals.end();
    if (!result) {
      report_.repair({"nff.normal.zero", "a polygon has a normal that is 0 or not a number", "", "",
                      "give each corner a direction", "the polygon is shaded flat"});
    }
    return result;
  }

  /// Gives the flat-shaded polygons that were added so far the normals of their triangles.
  void make_smooth() {
    for (size_t i = mesh_.normals.size(); i < mesh_.positions.size(); i += 3) add_normals(i);
  }

  /// Sets the normals of a flat-shaded triangle, given by the index of its first vertex.
  void add_normals(size_t first) {
    const dvec3 a(mesh_.positions[first]);
    const dvec3 normal = glm::cross(dvec3(mesh_.positions[first + 1]) - a, dvec3(mesh_.positions[first + 2]) - a);
    const double length = glm::length(normal);
    // A triangle without area is never hit, so its normal does not matter.
    mesh_.normals.insert(mesh_.normals.end(), 3, length > 0.0 ? vec3(normal / length) : vec3(0.0F, 1.0F, 0.0F));
  }

  void add_smooth(std::span<const vec3> corners, std::span<const vec3> normals) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    mesh_.positions.insert(mesh_.positions.end(), corners.begin(), corners.end());
    mesh_.normals.insert(mesh_.normals.end(), normals.begin(), normals.end());
    for (const uvec3& triangle : triangulate_polygon(corners)) mesh_.triangles.push_back(first + triangle);
  }

  void add_sharp(std::span<const vec3> corners, const uvec3& triangle) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (int i = 0; i < 3; ++i) mesh_.positions.push_back(corners[triangle[i]]);
    if (!mesh_.normals.empty()) add_normals(first);
    mesh_.triangles.emplace_back(first, first + 1, first + 2);
  }

  const NffText& text_;
  LoadReport& report_;
  Mesh mesh_;
};

/// Adds the lights. Each of n sources without a colour has the power sqrt(n) / (2 n), as in the Standard Procedural
/// Databases, so the total power grows slowly with n.
void add_lights(const NffText& text, Scene& scene) {
  const auto count = static_cast<double>(text.lights.size());
  for (const NffLight& source : text.lights) {
    Light light;
    light.position = source.position;
    light.diffuse = source.color.value_or(vec3(static_cast<float>(std::sqrt(count) / (2.0 * count))));
    light.specular = light.diffuse;
    scene.lights.push_back(light);
  }
}

/// Adds the shapes of a group. All polygons of the group form one mesh, at the place of the first polygon.
void add_group(const NffText& text, const NffGroup& group, Scene& scene, LoadReport& report) {
  const auto material = static_cast<uint32_t>(scene.materials.size());
  if (group.material) {
    scene.materials.emplace_back().model = to_phong(*group.material);
  } else {
    scene.materials.emplace_back().name = "default";
    report.warn("shapes before the first f are drawn grey");
  }
  PolygonMesh polygons(text, report);
  std::optional<size_t> mesh_geometry;
  const auto add = [&](Geometry geometry) { scene.add("", std::move(geometry), material); };
  for (const NffShape& shape : group.shapes) {
    if (const auto* polygon = std::get_if<NffPolygon>(&shape)) {
      if (!mesh_geometry) {
        mesh_geometry = scene.geometries.size();
        add(Mesh());
      }
      polygons.add(*polygon);
    } else {
      std::visit(
          [&](const auto& solid) {
            if constexpr (std::is_constructible_v<Geometry, decltype(solid)>) add(solid);
          },
          shape);
    }
  }
  if (mesh_geometry) scene.geometries[*mesh_geometry] = polygons.take();
}

}  // namespace

Scene load_nff(const LoadOptions& /*options*/, LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const NffText text = parse_nff_text(without_zero_bytes_at_end(file), report);
  report.throw_if_refused();

  Scene scene;
  scene.file = report.file();
  scene.is_classic = true;
  scene.cameras = text.cameras;
  scene.environment.background = text.background.value_or(vec3(0.0F));
  add_lights(text, scene);
  for (const NffGroup& group : text.groups) add_group(text, group, scene, report);
  report.throw_if_refused();
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
