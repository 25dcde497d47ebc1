// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/meshes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "core/rounding.h"
#include "formats/gltf/accessors.h"
#include "formats/gltf/json_rule.h"
#include "motion/skin.h"
#include "promin/validate.h"
#include "scene/limits.h"
#include "scene/world_scene.h"
#include "shapes/placement.h"

namespace promin {
namespace {

constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
/// The smallest determinant of a transform. With a smaller one, the transform is almost singular or overflows, and
/// normals may vanish.
constexpr double kLeastDeterminant = 1e-100;

/// Returns whether all vertices are in range in the world. Usually the corners of their box decide; otherwise each
/// vertex is tested.
bool is_mesh_in_range(const Mesh& mesh, const dmat4& world_from_object) {
  Bounds box;
  for (const vec3& position : mesh.positions) box.extend(position);
  bool are_corners_in_range = true;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p((corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                  (corner & 4) != 0 ? box.hi.z : box.lo.z);
    are_corners_in_range = are_corners_in_range && is_in_range(dvec3(world_from_object * dvec4(p, 1.0)));
  }
  return are_corners_in_range || std::ranges::all_of(mesh.positions, [&](const vec3& p) {
           return is_in_range(dvec3(world_from_object * dvec4(p, 1.0)));
         });
}

bool has_length(const dvec3& normal) {
  const double length = glm::length(normal);
  return length > 0.0 && std::isfinite(length);
}

void warn_of_normals(const std::string& place, LoadReport& report) {
  report.warn({"gltf.normals.zero", "a mesh primitive has normals of length 0", "", place, "",
               "promin uses flat shading for it"});
}

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
  PrimitiveReader(const GltfDocument& document, size_t mesh, size_t primitive, const std::vector<double>& weights,
                  const GltfPose* pose, LoadReport& report)
      : document_(document),
        primitive_(document.meshes[mesh].primitives[primitive]),
        place_("meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]"),
        weights_(weights),
        pose_(pose),
        report_(report) {}

  Mesh read() {
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

    Mesh mesh;
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
    if (pose_ != nullptr && mesh.positions.size() == used_vertices_.size()) pose(mesh);
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

  /// Adds the weighted values of the morph targets to an attribute of three components.
  void add_targets(const char* attribute, std::vector<float>& values) {
    for (size_t target = 0; target < std::min(weights_.size(), primitive_.targets.size()); ++target) {
      const auto found = primitive_.targets[target].find(attribute);
      if (weights_[target] == 0.0 || found == primitive_.targets[target].end()) continue;
      const GltfAccessor& accessor = document_.accessors[static_cast<size_t>(found->second)];
      if (3 * accessor.count != values.size() || accessor.component_count != 3) {
        report_.warn({"gltf.morph.count", "a morph target has a different number of vertices than its mesh", "",
                      place_ + ".targets[" + std::to_string(target) + "]", "", "promin ignores it"});
        continue;
      }
      const std::vector<float> moves = read_floats(document_, found->second, report_);
      for (size_t i = 0; i < values.size(); ++i) {
        values[i] =
            static_cast<float>(static_cast<double>(values[i]) + weights_[target] * static_cast<double>(moves[i]));
      }
    }
  }

  void read_positions(int accessor, Mesh& mesh) {
    std::vector<float> values = read_floats(document_, accessor, report_);
    add_targets("POSITION", values);
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
    std::vector<float> values = read_floats(document_, accessor, report_);
    add_targets("NORMAL", values);
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

  /// Moves the mesh with its joints.
  void pose(Mesh& mesh) {
    std::optional<SkinInfluences> influences = read_influences();
    if (!influences) return;
    pose_mesh(pose_->joint_matrices, *influences, mesh);
    if (std::ranges::all_of(mesh.normals, [](const vec3& normal) { return has_length(dvec3(normal)); })) return;
    warn_of_normals(place_, report_);
    mesh.normals.clear();
    mesh.tangents.clear();
  }

  /// Returns nullopt if there is nothing to pose, or if the data is wrong; the report then has the reason.
  std::optional<SkinInfluences> read_influences() {
    SkinInfluences influences;
    for (int set = 0; accessor_of(("JOINTS_" + std::to_string(set)).c_str()) >= 0; ++set)
      add_influences(set, influences);
    if (influences.per_vertex == 0) {
      report_.repair({"gltf.skin.weights", "a primitive of a skinned mesh has no joints and weights", "", place_,
                      "export the mesh again", "it is drawn without its skin"});
      return std::nullopt;
    }
    for (size_t i = 0; i < used_vertices_.size(); ++i) {
      repair_weights(i, influences);
      if (!has_valid_joints(i, influences)) return std::nullopt;
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
  bool has_valid_joints(size_t vertex, const SkinInfluences& influences) {
    for (size_t i = vertex * influences.per_vertex; i < (vertex + 1) * influences.per_vertex; ++i) {
      if (influences.weights[i] == 0.0F || influences.joints[i] < pose_->joint_matrices.size()) continue;
      report_.refuse(
          "gltf.skin.joint",
          "joint " + std::to_string(influences.joints[i]) + " is out of range, because the skin has only " +
              std::to_string(pose_->joint_matrices.size()) + " joints",
          element_place(("JOINTS_" + std::to_string(i % influences.per_vertex / 4)).c_str(), used_vertices_[vertex]),
          "export the file again");
      return false;
    }
    return true;
  }

  const GltfDocument& document_;
  const GltfPrimitive& primitive_;
  std::string place_;
  const std::vector<double>& weights_;
  const GltfPose* pose_;
  LoadReport& report_;
  size_t vertex_count_ = 0;
  std::vector<uint32_t> used_vertices_;
};

}  // namespace

Mesh read_gltf_mesh(const GltfDocument& document, size_t mesh, size_t primitive, const std::vector<double>& weights,
                    const GltfPose* pose, LoadReport& report) {
  return PrimitiveReader(document, mesh, primitive, weights, pose, report).read();
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

void place_gltf_mesh(const PlacedNode& placed, uint32_t geometry, const std::string& place, Scene& scene,
                     Object& object, LoadReport& report) {
  object.geometry = geometry;
  object.world_from_object = placed.world_from_object;
  const Mesh& mesh = std::get<Mesh>(scene.geometries[geometry]);
  if (!is_mesh_in_range(mesh, placed.world_from_object)) {
    report.refuse("gltf.position.far", "a vertex lies beyond 1e15 in the world",
                  "nodes[" + std::to_string(placed.node) + "]",
                  "use a smaller translation or scale in it and its parents");
    return;
  }
  const double determinant = std::abs(glm::determinant(dmat3(placed.world_from_object)));
  if (determinant >= kLeastDeterminant && determinant <= 1.0 / kLeastDeterminant) return;
  Mesh source = mesh;
  const Placement placement(placed.world_from_object);
  const bool has_normals = std::ranges::all_of(
      source.normals, [&](const vec3& normal) { return has_length(placement.normal(dvec3(normal))); });
  if (!has_normals) {
    warn_of_normals(place, report);
    source.normals.clear();
  }
  object.geometry = static_cast<uint32_t>(scene.geometries.size());
  object.world_from_object = dmat4(1.0);
  scene.geometries.emplace_back(world::place(source, placed.world_from_object));
}

}  // namespace promin
