// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/meshes.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "formats/gltf/accessors.h"
#include "promin/load_scene.h"

namespace promin {
namespace {

constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

/// One mesh primitive on its way from the file to the world.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, size_t mesh, size_t primitive, const PlacedNode& placed,
                  LoadReport& report)
      : document_(document),
        primitive_(document.meshes[mesh].primitives[primitive]),
        place_("meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]"),
        placed_(placed),
        report_(report) {}

  Mesh read() {
    const int positions = accessor_of("POSITION");
    if (primitive_.mode < kGltfTriangles) {
      report_.warn(place_ + " holds points or lines, which are not drawn");
      return {};
    }
    if (positions < 0) {
      report_.warn(place_ + " has no POSITION and is not drawn");
      return {};
    }
    vertex_count_ = document_.accessors[static_cast<size_t>(positions)].count;

    Mesh mesh;
    mesh.triangles = assemble(read_corners());
    if (mesh.triangles.empty()) {
      report_.warn(place_ + " has too few corners for a triangle and is not drawn");
      return {};
    }
    keep_used_vertices(mesh.triangles);
    read_positions(positions, mesh);
    if (const int normals = accessor_of("NORMAL"); normals >= 0) read_normals(normals, mesh);
    if (const int colors = accessor_of("COLOR_0"); colors >= 0) read_colors(colors, mesh);
    if (glm::determinant(glm::dmat3(placed_.world_from_object)) < 0.0) {
      for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    }
    return mesh;
  }

 private:
  int accessor_of(const char* attribute) const {
    const auto found = primitive_.attributes.find(attribute);
    return found == primitive_.attributes.end() ? -1 : found->second;
  }

  std::vector<uint32_t> read_corners() {
    if (primitive_.indices < 0) {
      std::vector<uint32_t> corners(vertex_count_);
      std::iota(corners.begin(), corners.end(), 0U);
      return corners;
    }
    std::vector<uint32_t> corners = read_indices(document_, primitive_.indices, report_);
    const auto wrong = std::find_if(corners.begin(), corners.end(), [&](uint32_t i) { return i >= vertex_count_; });
    if (wrong == corners.end()) return corners;
    report_.refuse("index " + std::to_string(*wrong) + " is out of range, there are " + std::to_string(vertex_count_) +
                       " vertices",
                   place_ + ".indices, element " + std::to_string(wrong - corners.begin()), "export the file again");
    return {};
  }

  /// Triangles in file order, wound as the specification says.
  std::vector<uvec3> assemble(const std::vector<uint32_t>& corners) {
    std::vector<uvec3> triangles;
    const size_t count = corners.size();
    if (primitive_.mode == kGltfTriangles) {
      triangles.reserve(count / 3);
      for (size_t i = 0; i + 2 < count; i += 3) triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
      if (count % 3 != 0) report_.warn(place_ + " ends in an incomplete triangle, which is ignored");
    } else if (primitive_.mode == kGltfTriangleStrip) {
      for (size_t i = 0; i + 2 < count; ++i) {
        triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
      }
    } else {
      for (size_t i = 1; i + 1 < count; ++i) triangles.emplace_back(corners[i], corners[i + 1], corners[0]);
    }
    return triangles;
  }

  /// Several primitives may share one large accessor: each keeps its own vertices, in the accessor's order.
  void keep_used_vertices(std::vector<uvec3>& triangles) {
    std::vector<uint32_t> new_index(vertex_count_, kUnused);
    for (const uvec3& triangle : triangles) {
      for (int i = 0; i < 3; ++i) new_index[triangle[i]] = 0;
    }
    for (uint32_t vertex = 0; vertex < vertex_count_; ++vertex) {
      if (new_index[vertex] == kUnused) continue;
      new_index[vertex] = static_cast<uint32_t>(used_vertices_.size());
      used_vertices_.push_back(vertex);
    }
    for (uvec3& triangle : triangles) {
      for (int i = 0; i < 3; ++i) triangle[i] = new_index[triangle[i]];
    }
  }

  std::string element_place(const char* attribute, uint32_t vertex) const {
    return place_ + ".attributes." + attribute + ", element " + std::to_string(vertex);
  }

  void read_positions(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    mesh.positions.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* p = &values[3 * size_t{vertex}];
      const dvec3 local(p[0], p[1], p[2]);
      const dvec3 world(placed_.world_from_object * dvec4(local, 1.0));
      if (!is_in_range(local)) {
        report_.refuse("a vertex coordinate is not finite or beyond 1e15", element_place("POSITION", vertex),
                       "export the mesh again, in a larger unit of length");
        return;
      }
      if (!is_in_range(world)) {
        report_.refuse("a vertex lies beyond 1e15 in the world", "nodes[" + std::to_string(placed_.node) + "]",
                       "use a smaller translation or scale in it and its parents");
        return;
      }
      mesh.positions.emplace_back(world);
    }
  }

  static bool is_in_range(const dvec3& p) {
    // Written so that NaN fails.
    return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate && std::abs(p.z) <= kMaxCoordinate;
  }

  /// Normals go with the inverse transpose, here as the matrix of cofactors, which needs no inverse: it is the same
  /// up to the determinant, of which the sign counts.
  void read_normals(int accessor, Mesh& mesh) {
    const dmat3 m(placed_.world_from_object);
    const double sign = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
    const dmat3 cofactors(sign * glm::cross(m[1], m[2]), sign * glm::cross(m[2], m[0]), sign * glm::cross(m[0], m[1]));
    const std::vector<float> values = read_floats(document_, accessor, report_);
    std::vector<vec3> normals;
    normals.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* n = &values[3 * size_t{vertex}];
      const dvec3 normal = cofactors * dvec3(n[0], n[1], n[2]);
      const double length = glm::length(normal);
      if (!(length > 0.0) || !std::isfinite(length)) {
        report_.warn(place_ + " has normals of no length, so it is drawn with sharp edges");
        return;
      }
      normals.emplace_back(normal / length);
    }
    mesh.normals = std::move(normals);
  }

  void read_colors(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    const size_t components = values.size() / vertex_count_;
    mesh.colors.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* c = &values[components * vertex];
      const vec4 color(c[0], c[1], c[2], components == 4 ? c[3] : 1.0F);
      if (!(color.r >= 0.0F && color.g >= 0.0F && color.b >= 0.0F && is_finite(vec3(color)) &&
            std::isfinite(color.a))) {
        report_.refuse("a vertex colour is negative or not finite", element_place("COLOR_0", vertex),
                       "export the mesh again");
        return;
      }
      mesh.colors.push_back(color);
    }
  }

  const GltfDocument& document_;
  const GltfPrimitive& primitive_;
  std::string place_;
  const PlacedNode& placed_;
  LoadReport& report_;
  size_t vertex_count_ = 0;
  std::vector<uint32_t> used_vertices_;
};

}  // namespace

Mesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const PlacedNode& placed,
                    LoadReport& report) {
  return PrimitiveReader(document, mesh, primitive, placed, report).read();
}

}  // namespace promin
