// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/turned_normals.h"

#include <limits>
#include <vector>

namespace promin {
namespace {

/// Differences of fp32 numbers, their products and sums are exact enough in double that only normals within 1e-15 of
/// the triangle's plane can have the wrong sign.
bool is_turned(const Mesh& mesh, const uvec3& triangle) {
  const dvec3 a(mesh.positions[triangle.x]);
  const dvec3 front = glm::cross(dvec3(mesh.positions[triangle.y]) - a, dvec3(mesh.positions[triangle.z]) - a);
  for (int i = 0; i < 3; ++i) {
    if (!(glm::dot(front, dvec3(mesh.normals[triangle[i]])) < 0.0)) return false;
  }
  return true;
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

uint64_t count_turned_triangles(const Mesh& mesh) {
  if (mesh.normals.empty()) return 0;
  uint64_t count = 0;
  for (const uvec3& triangle : mesh.triangles) count += is_turned(mesh, triangle) ? 1 : 0;
  return count;
}

void turn_normals(Mesh& mesh, bool tangents_follow_winding) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<bool> is_kept(mesh.positions.size(), false);
  std::vector<uint32_t> turned;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const uvec3& triangle = mesh.triangles[i];
    if (is_turned(mesh, triangle)) {
      turned.push_back(i);
    } else {
      for (int corner = 0; corner < 3; ++corner) is_kept[triangle[corner]] = true;
    }
  }
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
