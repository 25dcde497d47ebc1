// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/skin.h"

#include "shapes/placement.h"

namespace promin {
namespace {

dmat4 blend(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, size_t vertex) {
  dmat4 sum(0.0);
  double total = 0.0;
  for (size_t i = vertex * influences.per_vertex; i < (vertex + 1) * influences.per_vertex; ++i) {
    const auto weight = static_cast<double>(influences.weights[i]);
    if (weight == 0.0) continue;
    sum += weight * joint_matrices[influences.joints[i]];
    total += weight;
  }
  return sum / total;
}

vec3 to_unit(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? vec3(v / length) : vec3(0.0F);
}

}  // namespace

void pose_mesh(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, Mesh& mesh) {
  for (size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const dmat4 matrix = blend(joint_matrices, influences, vertex);
    // The addition turns -0 into 0, as in meshes that are not posed.
    mesh.positions[vertex] = vec3(matrix * dvec4(mesh.positions[vertex], 1.0)) + 0.0F;
    if (mesh.normals.empty()) continue;
    const Placement placement(matrix);
    mesh.normals[vertex] = to_unit(placement.normal(dvec3(mesh.normals[vertex])));
    if (mesh.tangents.empty()) continue;
    const vec4 tangent = mesh.tangents[vertex];
    mesh.tangents[vertex] =
        vec4(to_unit(placement.direction(dvec3(vec3(tangent)))), placement.is_mirroring() ? -tangent.w : tangent.w);
  }
}

}  // namespace promin
