// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/turned_normals.h"

#include <algorithm>
#include <limits>

#include "core/parallel.h"

namespace promin {
namespace {

/// Returns whether the three normals of a triangle point against its winding. Differences, products and sums of fp32
/// numbers are so exact in double that only normals within 1e-15 of the triangle's plane can have the wrong sign.
bool is_turned(const Mesh& mesh, const uvec3& triangle) {
  const dvec3 a(mesh.positions[triangle.x]);
  const dvec3 front = glm::cross(dvec3(mesh.positions[triangle.y]) - a, dvec3(mesh.positions[triangle.z]) - a);
  for (int i = 0; i < 3; ++i) {
    if (!(glm::dot(front, dvec3(mesh.normals[triangle[i]])) < 0.0)) return false;
  }
  return true;
}

/// Returns for each vertex whether it belongs to one of these triangles.
std::vector<bool> find_vertices(const Mesh& mesh, std::span<const uint32_t> triangles) {
  std::vector<bool> is_vertex(mesh.positions.size(), false);
  for (const uint32_t i : triangles) {
    for (int corner = 0; corner < 3; ++corner) is_vertex[mesh.triangles[i][corner]] = true;
  }
  return is_vertex;
}

/// Returns the other triangles that share a vertex with these triangles, which are sorted.
std::vector<uint32_t> find_neighbors(const Mesh& mesh, std::span<const uint32_t> triangles) {
  const std::vector<bool> is_vertex = find_vertices(mesh, triangles);
  return find_indices(mesh.triangles.size(), [&](uint32_t i) {
    const uvec3& corners = mesh.triangles[i];
    return (is_vertex[corners.x] || is_vertex[corners.y] || is_vertex[corners.z]) &&
           !std::ranges::binary_search(triangles, i);
  });
}

/// Appends a copy of a vertex, and returns its index.
uint32_t copy_vertex(Mesh& mesh, uint32_t vertex) {
  const auto copy = [vertex](auto& values) {
    if (!values.empty()) values.push_back(values[vertex]);
  };
  copy(mesh.positions);
  copy(mesh.normals);
  copy(mesh.colors);
  copy(mesh.uvs);
  copy(mesh.tangents);
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

void turn_vertex(Mesh& mesh, uint32_t vertex, bool tangents_follow_winding) {
  mesh.normals[vertex] = -mesh.normals[vertex];
  if (mesh.tangents.empty()) return;
  const vec4 tangent = mesh.tangents[vertex];
  mesh.tangents[vertex] = vec4(-vec3(tangent), tangents_follow_winding ? tangent.w : -tangent.w);
}

}  // namespace

std::vector<uint32_t> find_turned_triangles(const Mesh& mesh) {
  if (mesh.normals.empty()) return {};
  return find_indices(mesh.triangles.size(), [&](uint32_t i) { return is_turned(mesh, mesh.triangles[i]); });
}

void turn_normals(Mesh& mesh, std::span<const uint32_t> turned, bool tangents_follow_winding) {
  if (turned.empty()) return;
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  const std::vector<bool> is_kept = find_vertices(mesh, find_neighbors(mesh, turned));
  std::vector<uint32_t> turned_vertex(mesh.positions.size(), kNone);
  for (const uint32_t i : turned) {
    for (int corner = 0; corner < 3; ++corner) {
      uint32_t& vertex = mesh.triangles[i][corner];
      uint32_t& turned_one = turned_vertex[vertex];
      if (turned_one == kNone) {
        turned_one = is_kept[vertex] ? copy_vertex(mesh, vertex) : vertex;
        turn_vertex(mesh, turned_one, tangents_follow_winding);
      }
      vertex = turned_one;
    }
  }
}

}  // namespace promin
