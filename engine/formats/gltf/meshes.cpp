// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/meshes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/rounding.h"
#include "formats/gltf/accessors.h"
#include "formats/gltf/buffers.h"
#include "formats/gltf/json_rule.h"
#include "motion/deform.h"
#include "motion/place_mesh.h"
#include "promin/validate.h"
#include "scene/limits.h"

namespace promin {
namespace {

constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
/// Returns a valid component of a vertex colour: a negative value becomes 0, and a NaN becomes 1, which has no effect.
float drawable(float component) {
  return std::isfinite(component) ? std::max(component, 0.0F) : 1.0F;
}

bool is_coordinate(float uv) {
  // The comparison is written so that NaN fails.
  return std::abs(uv) <= kMaxCoordinate;
}

/// Reads one mesh primitive.
class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, size_t mesh, size_t primitive, LoadReport& report)
      : document_(document),
        primitive_(document.meshes[mesh].primitives[primitive]),
        place_("meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]"),
        report_(report) {}

  DeformingMesh read(const GltfMeshNeeds& needs) {
    const int positions = accessor_of("POSITION");
    if (primitive_.mode < kGltfTriangles) {
      report_.warn({"gltf.primitive.lines", "a mesh primitive contains points or lines", "", place_, "",
                    "promin does not draw them"});
      return {};
    }
    if (positions < 0) {
      report_.warn(
          {"gltf.primitive.positions", "a mesh primitive has no POSITION", "", place_, "", "promin does not draw it"});
      return {};
    }
    vertex_count_ = document_.accessors[static_cast<size_t>(positions)].count;

    DeformingMesh result;
    Mesh& mesh = result.base;
    mesh.triangles = assemble(read_corners());
    if (mesh.triangles.empty()) {
      report_.warn({"gltf.primitive.short", "a mesh primitive has too few corners for a triangle", "", place_, "",
                    "promin does not draw it"});
      return {};
    }
    keep_used_vertices(mesh.triangles);
    read_positions(positions, mesh);
    if (const int normals = accessor_of("NORMAL"); normals >= 0) read_normals(normals, mesh);
    if (const int colors = accessor_of("COLOR_0"); colors >= 0) read_colors(colors, mesh);
    read_uvs(mesh);
    // The specification ignores tangents if there are no normals.
    if (const int tangents = accessor_of("TANGENT"); tangents >= 0 && !mesh.normals.empty() && !mesh.uvs.empty()) {
      read_tangents(tangents, mesh);
    }
    if (mesh.positions.size() != used_vertices_.size()) return result;
    if (needs.targets) read_targets(result);
    if (needs.joint_count > 0) result.influences = read_influences(needs.joint_count);
    return result;
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
    report_.refuse("gltf.indices.range",
                   "index " + std::to_string(*wrong) + " is out of range, because there are only " +
                       std::to_string(vertex_count_) + " vertices",
                   place_ + ".indices, element " + std::to_string(wrong - corners.begin()), "export the file again");
    return {};
  }

  /// Returns the triangles in file order, with the winding that the specification requires.
  std::vector<uvec3> assemble(const std::vector<uint32_t>& corners) {
    std::vector<uvec3> triangles;
    const size_t count = corners.size();
    if (primitive_.mode == kGltfTriangles) {
      triangles.reserve(count / 3);
      for (size_t i = 0; i + 2 < count; i += 3) triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
      if (count % 3 != 0) {
        report_.warn({"gltf.primitive.incomplete", "a mesh primitive ends with an incomplete triangle", "", place_, "",
                      "promin ignores this triangle"});
      }
    } else if (primitive_.mode == kGltfTriangleStrip) {
      for (size_t i = 0; i + 2 < count; ++i) {
        triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
      }
    } else {
      for (size_t i = 1; i + 1 < count; ++i) triangles.emplace_back(corners[i], corners[i + 1], corners[0]);
    }
    return triangles;
  }

  /// Keeps only the vertices that the triangles use, in the accessor's order. Several primitives may share one large
  /// accessor, and each then has its own vertices.
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

  void read_targets(DeformingMesh& mesh) {
    for (size_t i = 0; i < primitive_.targets.size(); ++i) {
      MorphTarget& target = mesh.targets.emplace_back();
      const bool has_frame = !mesh.base.normals.empty();
      read_displacements(i, "POSITION", 3, target.positions);
      if (has_frame) read_displacements(i, "NORMAL", 3, target.normals);
      if (has_frame && !mesh.base.tangents.empty()) read_displacements(i, "TANGENT", 3, target.tangents);
      if (!mesh.base.uvs.empty()) read_uv_displacements(i, target.uvs);
      if (mesh.base.colors.empty()) continue;
      const size_t components = accessor_at(accessor_of("COLOR_0")).component_count;
      if (components == 4) return read_displacements(i, "COLOR_0", 4, target.colors);
      std::vector<vec3> colors;
      read_displacements(i, "COLOR_0", 3, colors);
      for (const vec3& color : colors) target.colors.emplace_back(color, 0.0F);
    }
  }

  void read_uv_displacements(size_t target, std::vector<vec4>& displacements) {
    std::vector<vec2> sets[2];
    read_displacements(target, "TEXCOORD_0", 2, sets[0]);
    read_displacements(target, "TEXCOORD_1", 2, sets[1]);
    if (sets[0].empty() && sets[1].empty()) return;
    for (size_t i = 0; i < used_vertices_.size(); ++i) {
      const auto move = [&](const std::vector<vec2>& set) { return set.empty() ? vec2(0.0F) : set[i]; };
      displacements.emplace_back(move(sets[0]), move(sets[1]));
    }
  }

  /// Reads the displacements of an attribute for the vertices that are used. If there are none, or they do not fit, the
  /// list stays empty.
  template <class Vector>
  void read_displacements(size_t target, const char* attribute, size_t components, std::vector<Vector>& displacements) {
    const auto found = primitive_.targets[target].find(attribute);
    if (found == primitive_.targets[target].end()) return;
    const std::string place = place_ + ".targets[" + std::to_string(target) + "]";
    const GltfAccessor& accessor = accessor_at(found->second);
    if (accessor.count != vertex_count_ || accessor.component_count != components) {
      return report_.warn({"gltf.morph.count", "a morph target has a different number of vertices than its mesh", "",
                           place, "", "promin ignores it"});
    }
    const bool has_bytes = has_accessor_bytes(document_, found->second);
    const std::vector<float> values = has_bytes ? read_floats(document_, found->second, report_) : std::vector<float>{};
    const bool is_right = has_bytes && std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
    if (!is_right) {
      return report_.repair({"gltf.morph.range", "a morph target has numbers that are missing or not finite", "", place,
                             "export the file again", "promin ignores it"});
    }
    displacements.resize(used_vertices_.size());
    for (size_t i = 0; i < used_vertices_.size(); ++i) {
      for (size_t c = 0; c < components; ++c) {
        displacements[i][static_cast<int>(c)] = values[components * used_vertices_[i] + c];
      }
    }
  }

  const GltfAccessor& accessor_at(int index) const { return document_.accessors[static_cast<size_t>(index)]; }

  void read_positions(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    mesh.positions.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* p = &values[3 * size_t{vertex}];
      if (!is_in_range(dvec3(p[0], p[1], p[2]))) {
        report_.refuse("gltf.position.range", "a vertex coordinate is beyond 1e15 or not finite",
                       element_place("POSITION", vertex), "export the mesh again, in a larger unit of length");
        return;
      }
      // The addition turns -0 into 0, as a transform does. A mesh without morph targets and one whose targets have no
      // effect then have the same bits.
      mesh.positions.emplace_back(p[0] + 0.0F, p[1] + 0.0F, p[2] + 0.0F);
    }
  }

  void read_normals(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    std::vector<vec3> normals;
    normals.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* n = &values[3 * size_t{vertex}];
      normals.emplace_back(n[0], n[1], n[2]);
      if (has_length(dvec3(normals.back()))) continue;
      warn_of_normals(place_, report_);
      return;
    }
    mesh.normals = std::move(normals);
  }

  void read_colors(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    const size_t components = values.size() / vertex_count_;
    mesh.colors.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* c = &values[components * vertex];
      // Alpha has a meaning only in 0...1 (glTF 2.0, section 3.7.2.1).
      const vec4 given(c[0], c[1], c[2], components == 4 ? c[3] : 1.0F);
      const vec4 color(drawable(given.r), drawable(given.g), drawable(given.b), std::min(drawable(given.a), 1.0F));
      if (const int wrong = find_wrong_component(given, color); wrong >= 0) {
        report_.repair({"gltf.color.range", "a vertex colour is negative or not a number", std::to_string(given[wrong]),
                        element_place("COLOR_0", vertex), "export the mesh again",
                        "0 is used for a negative value, 1 for one that is not a number"});
      }
      mesh.colors.push_back(color);
    }
  }

  /// Returns the component of a vertex colour whose repair changed it by more than rounding; -1 if there is none.
  static int find_wrong_component(const vec4& given, const vec4& color) {
    for (int i = 0; i < 4; ++i) {
      const bool is_alpha_too_large = i == 3 && given[i] > 1.0F && std::isfinite(given[i]);
      // The comparison is written so that NaN fails.
      if (!is_alpha_too_large && !(std::abs(given[i] - color[i]) <= static_cast<float>(kMostRounding))) return i;
    }
    return -1;
  }

  void read_uvs(Mesh& mesh) {
    const std::array<int, 2> accessors = {accessor_of("TEXCOORD_0"), accessor_of("TEXCOORD_1")};
    if (accessors[0] < 0 && accessors[1] < 0) return;
    mesh.uvs.resize(used_vertices_.size(), vec4(0.0F));
    for (int set = 0; set < 2; ++set) {
      if (accessors[static_cast<size_t>(set)] < 0) continue;
      const std::vector<float> values = read_floats(document_, accessors[static_cast<size_t>(set)], report_);
      for (size_t i = 0; i < used_vertices_.size(); ++i) {
        const float* uv = &values[2 * size_t{used_vertices_[i]}];
        if (!is_coordinate(uv[0]) || !is_coordinate(uv[1])) {
          report_.repair({"gltf.uv.range", "a texture coordinate is beyond 1e15 or not finite",
                          std::to_string(is_coordinate(uv[0]) ? uv[1] : uv[0]),
                          element_place(set == 0 ? "TEXCOORD_0" : "TEXCOORD_1", used_vertices_[i]),
                          "export the mesh again", "0 is used"});
          continue;
        }
        mesh.uvs[i][2 * set] = uv[0];
        mesh.uvs[i][2 * set + 1] = uv[1];
      }
    }
  }

  void read_tangents(int accessor, Mesh& mesh) {
    const std::vector<float> values = read_floats(document_, accessor, report_);
    std::vector<vec4> tangents;
    tangents.reserve(used_vertices_.size());
    for (const uint32_t vertex : used_vertices_) {
      const float* t = &values[4 * size_t{vertex}];
      const vec4 tangent(t[0], t[1], t[2], t[3] < 0.0F ? -1.0F : 1.0F);
      if (!has_length(dvec3(vec3(tangent)))) {
        report_.warn({"gltf.tangents.zero", "a mesh primitive has tangents of length 0", "", place_, "",
                      "promin computes them from its texture coordinates"});
        return;
      }
      tangents.push_back(tangent);
    }
    mesh.tangents = std::move(tangents);
  }

  /// Returns no influences if the primitive has none.
  SkinInfluences read_influences(size_t joint_count) {
    SkinInfluences influences;
    for (int set = 0; accessor_of(("JOINTS_" + std::to_string(set)).c_str()) >= 0; ++set)
      add_influences(set, influences);
    if (influences.per_vertex == 0) {
      report_.repair({"gltf.skin.weights", "a primitive of a skinned mesh has no joints and weights", "", place_,
                      "export the mesh again", "it is drawn without its skin"});
    }
    for (size_t i = 0; influences.per_vertex > 0 && i < used_vertices_.size(); ++i) {
      repair_weights(i, influences);
      if (!has_valid_joints(i, joint_count, influences)) return {};
    }
    return influences;
  }

  /// Adds four joints and their weights to each vertex, after its earlier sets.
  void add_influences(int set, SkinInfluences& influences) {
    const std::string number = std::to_string(set);
    const int weights = accessor_of(("WEIGHTS_" + number).c_str());
    if (weights < 0) return;
    const std::vector<uint32_t> set_joints =
        read_indices(document_, accessor_of(("JOINTS_" + number).c_str()), report_);
    const std::vector<float> set_weights = read_floats(document_, weights, report_);
    const size_t before = influences.per_vertex;
    SkinInfluences longer{before + 4};
    for (size_t i = 0; i < used_vertices_.size(); ++i) {
      const auto append = [&](const auto& old, const auto& added, auto& result) {
        const auto first_old = old.begin() + static_cast<std::ptrdiff_t>(i * before);
        result.insert(result.end(), first_old, first_old + static_cast<std::ptrdiff_t>(before));
        const auto first_added = added.begin() + static_cast<std::ptrdiff_t>(4 * size_t{used_vertices_[i]});
        result.insert(result.end(), first_added, first_added + 4);
      };
      append(influences.joints, set_joints, longer.joints);
      append(influences.weights, set_weights, longer.weights);
    }
    influences = std::move(longer);
  }

  void repair_weights(size_t vertex, SkinInfluences& influences) {
    const std::span weights =
        std::span(influences.weights).subspan(vertex * influences.per_vertex, influences.per_vertex);
    double sum = 0.0;
    for (const float weight : weights) sum += static_cast<double>(weight);
    // The comparisons are written so that NaN fails.
    if (std::abs(sum) >= 1e-6 && std::abs(sum) <= kMaxCoordinate) return;
    report_.repair({"gltf.skin.weights", "a vertex of a skinned mesh has no weights, or weights that are not numbers",
                    "", element_place("WEIGHTS_0", used_vertices_[vertex]), "export the mesh again",
                    "it follows the first of its joints"});
    std::ranges::fill(weights, 0.0F);
    weights[0] = 1.0F;
  }

  /// Returns whether the joints of a vertex exist. A joint with weight 0 may have any index.
  bool has_valid_joints(size_t vertex, size_t joint_count, const SkinInfluences& influences) {
    for (size_t i = vertex * influences.per_vertex; i < (vertex + 1) * influences.per_vertex; ++i) {
      if (influences.weights[i] == 0.0F || influences.joints[i] < joint_count) continue;
      report_.refuse(
          "gltf.skin.joint",
          "joint " + std::to_string(influences.joints[i]) + " is out of range, because the skin has only " +
              std::to_string(joint_count) + " joints",
          element_place(("JOINTS_" + std::to_string(i % influences.per_vertex / 4)).c_str(), used_vertices_[vertex]),
          "export the file again");
      return false;
    }
    return true;
  }

  const GltfDocument& document_;
  const GltfPrimitive& primitive_;
  std::string place_;
  LoadReport& report_;
  size_t vertex_count_ = 0;
  std::vector<uint32_t> used_vertices_;
};

}  // namespace

DeformingMesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const GltfMeshNeeds& needs,
                             LoadReport& report) {
  return PrimitiveReader(document, mesh, primitive, report).read(needs);
}

void warn_of_normals(const std::string& place, LoadReport& report) {
  report.warn({"gltf.normals.zero", "a mesh primitive has normals of length 0", "", place, "",
               "promin uses flat shading for it"});
}

uint64_t count_gltf_triangles(const GltfDocument& document, size_t mesh, size_t primitive) {
  const GltfPrimitive& source = document.meshes[mesh].primitives[primitive];
  const auto positions = source.attributes.find("POSITION");
  if (source.mode < kGltfTriangles || positions == source.attributes.end()) return 0;
  const int corners = source.indices < 0 ? positions->second : source.indices;
  const uint64_t count = document.accessors[static_cast<size_t>(corners)].count;
  if (source.mode == kGltfTriangles) return count / 3;
  return count < 3 ? 0 : count - 2;
}

void place_gltf_mesh(const PlacedNode& placed, uint32_t geometry, const Bounds& box, const std::string& place,
                     Scene& scene, Object& object, LoadReport& report) {
  object.geometry = geometry;
  object.world_from_object = placed.world_from_object;
  const Mesh& mesh = std::get<Mesh>(scene.geometries[geometry]);
  if (!is_mesh_in_range(mesh, box, placed.world_from_object)) {
    report.refuse("gltf.position.far", "a vertex lies beyond 1e15 in the world",
                  "nodes[" + std::to_string(placed.node) + "]",
                  "use a smaller translation or scale in it and its parents");
    return;
  }
  if (!is_singular(placed.world_from_object)) return;
  bool has_lost_normals = false;
  Mesh flat = apply_transform(mesh, placed.world_from_object, has_lost_normals);
  if (has_lost_normals) warn_of_normals(place, report);
  object.geometry = static_cast<uint32_t>(scene.geometries.size());
  object.world_from_object = dmat4(1.0);
  scene.geometries.emplace_back(std::move(flat));
}

}  // namespace promin
