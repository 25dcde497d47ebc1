// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/deform.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "shapes/placement.h"

namespace promin {
namespace {

/// An affine transform without the last row of its matrix.
struct Affine {
  dvec3 columns[4] = {dvec3(0.0), dvec3(0.0), dvec3(0.0), dvec3(0.0)};

  dvec3 point(const dvec3& p) const { return (columns[0] * p.x + columns[1] * p.y) + (columns[2] * p.z + columns[3]); }
};

/// Returns the weighted mean of the transforms of a vertex's joints.
Affine blend(std::span<const dmat4> joint_matrices, const SkinInfluences& influences, size_t vertex) {
  Affine sum;
  double total = 0.0;
  for (size_t i = vertex * influences.per_vertex; i < (vertex + 1) * influences.per_vertex; ++i) {
    const auto weight = static_cast<double>(influences.weights[i]);
    if (weight == 0.0) continue;
    const dmat4& joint = joint_matrices[influences.joints[i]];
    for (int column = 0; column < 4; ++column) sum.columns[column] += weight * dvec3(joint[column]);
    total += weight;
  }
  for (dvec3& column : sum.columns) column /= total;
  return sum;
}

dmat4 matrix_of(const Affine& affine) {
  return {dvec4(affine.columns[0], 0.0), dvec4(affine.columns[1], 0.0), dvec4(affine.columns[2], 0.0),
          dvec4(affine.columns[3], 1.0)};
}

vec3 to_unit(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? vec3(v / length) : vec3(0.0F);
}

/// A morph target with a weight other than 0.
struct ActiveTarget {
  const MorphTarget& target;
  double weight;
};

/// Returns a value with the weighted displacements of all targets, in double.
template <class Wide, class Narrow>
Wide displace(const Narrow& value, std::span<const ActiveTarget> targets, std::vector<Narrow> MorphTarget::*list,
              size_t vertex) {
  Wide sum(value);
  for (const ActiveTarget& active : targets) {
    const std::vector<Narrow>& displacements = active.target.*list;
    if (!displacements.empty()) sum += active.weight * Wide(displacements[vertex]);
  }
  return sum;
}

/// Returns a colour in its range: no component is negative, and alpha is at most 1.
vec4 to_color(const dvec4& sum) {
  const dvec4 color = glm::max(sum, dvec4(0.0));
  return vec4(dvec4(dvec3(color), std::min(color.w, 1.0)));
}

class Deformation {
 public:
  Deformation(const DeformingMesh& source, std::span<const double> weights, std::span<const dmat4> joint_matrices)
      : source_(source),
        joint_matrices_(source.influences.per_vertex == 0 ? std::span<const dmat4>{} : joint_matrices) {
    for (size_t i = 0; i < std::min(weights.size(), source.targets.size()); ++i) {
      if (weights[i] != 0.0) targets_.push_back({source.targets[i], weights[i]});
    }
  }

  Mesh make() const {
    Mesh mesh = source_.base;
    for_each_pixel(mesh.positions.size(), [&](size_t vertex) { deform_vertex(vertex, mesh); });
    return mesh;
  }

 private:
  void deform_vertex(size_t vertex, Mesh& mesh) const {
    const bool is_skinned = !joint_matrices_.empty();
    if (targets_.empty() && !is_skinned) return;
    const Affine joint = is_skinned ? blend(joint_matrices_, source_.influences, vertex) : Affine{};
    dvec3 position = displace<dvec3>(mesh.positions[vertex], targets_, &MorphTarget::positions, vertex);
    if (is_skinned) position = joint.point(position);
    // The addition turns -0 into 0, as in meshes that are not deformed.
    mesh.positions[vertex] = vec3(position) + 0.0F;
    if (!mesh.normals.empty()) deform_frame(vertex, joint, mesh);
    if (targets_.empty()) return;
    if (!mesh.uvs.empty()) {
      mesh.uvs[vertex] = vec4(displace<dvec4>(mesh.uvs[vertex], targets_, &MorphTarget::uvs, vertex));
    }
    if (!mesh.colors.empty()) {
      mesh.colors[vertex] = to_color(displace<dvec4>(mesh.colors[vertex], targets_, &MorphTarget::colors, vertex));
    }
  }

  /// Deforms the normal and the tangent of a vertex.
  void deform_frame(size_t vertex, const Affine& joint, Mesh& mesh) const {
    const dvec3 normal = displace<dvec3>(mesh.normals[vertex], targets_, &MorphTarget::normals, vertex);
    if (joint_matrices_.empty()) {
      mesh.normals[vertex] = vec3(normal);
      if (mesh.tangents.empty()) return;
      const vec4 tangent = mesh.tangents[vertex];
      mesh.tangents[vertex] =
          vec4(vec3(displace<dvec3>(vec3(tangent), targets_, &MorphTarget::tangents, vertex)), tangent.w);
      return;
    }
    const Placement placement(matrix_of(joint));
    mesh.normals[vertex] = to_unit(placement.normal(normal));
    if (mesh.tangents.empty()) return;
    const vec4 tangent = mesh.tangents[vertex];
    const dvec3 along = displace<dvec3>(vec3(tangent), targets_, &MorphTarget::tangents, vertex);
    mesh.tangents[vertex] =
        vec4(to_unit(placement.direction(along)), placement.is_mirroring() ? -tangent.w : tangent.w);
  }

  const DeformingMesh& source_;
  std::span<const dmat4> joint_matrices_;
  std::vector<ActiveTarget> targets_;
};

}  // namespace

Mesh deform(const DeformingMesh& mesh, std::span<const double> weights, std::span<const dmat4> joint_matrices) {
  return Deformation(mesh, weights, joint_matrices).make();
}

bool has_length(const dvec3& normal) {
  const double length = glm::length(normal);
  return length > 0.0 && std::isfinite(length);
}

bool drop_vanished_normals(Mesh& mesh) {
  if (std::ranges::all_of(mesh.normals, [](const vec3& normal) { return has_length(dvec3(normal)); })) return false;
  mesh.normals.clear();
  mesh.tangents.clear();
  return true;
}

}  // namespace promin
