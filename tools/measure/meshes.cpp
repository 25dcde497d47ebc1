// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/meshes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/parse_number.h"
#include "promin/error.h"
#include "promin/load_scene.h"

namespace promin::measure {
namespace {

/// Does what scene_of() does, without a copy of the mesh.
world::Scene scene_of_mesh(Mesh mesh, const std::string& name) {
  std::vector<world::Shape> shapes;
  shapes.emplace_back(std::move(mesh));
  return scene_of(std::move(shapes), name);
}

}  // namespace

world::Scene scene_of(std::vector<world::Shape> shapes, const std::string& name) {
  world::Scene scene;
  scene.file = name;
  scene.materials.resize(1);
  for (world::Shape& shape : shapes) scene.objects.push_back({"", std::move(shape), 0});
  return scene;
}

Mesh make_triangle(const dvec3& center, Random& random, double size) {
  const dvec3 right = random.direction();
  const dvec3 up = random.perpendicular(right);
  Mesh mesh;
  for (const dvec2& corner : {dvec2(-1.0, -0.5), dvec2(1.0, -0.5), dvec2(0.2, 0.7)}) {
    mesh.positions.emplace_back(center + size * (corner.x * right + corner.y * up));
  }
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

world::Scene make_wavy_sphere(uint32_t triangle_count) {
  const auto rings = std::max(2U, static_cast<uint32_t>(std::lround(0.5 * std::sqrt(triangle_count))));
  const uint32_t columns = 2 * rings;
  Mesh mesh;
  mesh.positions.emplace_back(0.0F, 1.0F, 0.0F);
  for (uint32_t i = 1; i < rings; ++i) {
    for (uint32_t j = 0; j < columns; ++j) {
      const double polar = 3.141592653589793 * i / rings;
      const double azimuth = 6.283185307179586 * j / columns;
      const double radius = 1.0 + 0.1 * std::sin(9.0 * polar) * std::sin(7.0 * azimuth);
      mesh.positions.emplace_back(
          radius * dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)));
    }
  }
  mesh.positions.emplace_back(0.0F, -1.0F, 0.0F);
  const auto last = static_cast<uint32_t>(mesh.positions.size()) - 1;
  for (uint32_t j = 0; j < columns; ++j) {
    const uint32_t next = (j + 1) % columns;
    mesh.triangles.emplace_back(0, 1 + next, 1 + j);
    for (uint32_t i = 0; i + 2 < rings; ++i) {
      const uint32_t row = 1 + i * columns;
      mesh.triangles.emplace_back(row + j, row + next, row + columns + j);
      mesh.triangles.emplace_back(row + next, row + columns + next, row + columns + j);
    }
    mesh.triangles.emplace_back(last, last - columns + j, last - columns + next);
  }
  return scene_of_mesh(std::move(mesh), "wavy sphere");
}

world::Scene make_needles(uint32_t triangle_count) {
  std::mt19937 generator(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(generator()) * 0x1p-32 - 1.0; };
  const auto in_ball = [&] {
    dvec3 v;
    do {
      const double x = uniform();
      const double y = uniform();
      v = dvec3(x, y, uniform());
    } while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-6);
    return v;
  };
  Mesh mesh;
  for (uint32_t i = 0; i < triangle_count; ++i) {
    const dvec3 start = in_ball();
    const dvec3 along = 0.2 * glm::normalize(in_ball());
    const dvec3 across = 0.02 * glm::length(along) * glm::normalize(glm::cross(along, in_ball()));
    for (const dvec3& corner : {start, start + along, start + across}) mesh.positions.emplace_back(corner);
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return scene_of_mesh(std::move(mesh), "needles");
}

world::Scene open_scene(const std::string& word) {
  const size_t colon = word.find(':');
  const std::string kind = word.substr(0, colon);
  if (colon == std::string::npos || (kind != "wavy" && kind != "needles")) return world::flatten(load_scene(word));
  const uint32_t count = to_number<uint32_t>(std::string_view(word).substr(colon + 1)).value_or(0);
  if (count < 16 || count > 50'000'000) {
    throw UsageError({"usage.option.value", "this is no number of triangles from 16 to 50000000", word,
                      "write " + kind + ":100000"});
  }
  world::Scene scene = kind == "wavy" ? make_wavy_sphere(count) : make_needles(count);
  scene.file = word;
  return scene;
}

bool is_generated_and_closed(const world::Scene& scene) {
  return scene.file.string().rfind("wavy:", 0) == 0;
}

}  // namespace promin::measure
