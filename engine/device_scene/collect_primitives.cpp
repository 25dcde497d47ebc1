// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/collect_primitives.h"

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <span>
#include <string>

#include "core/hash.h"
#include "core/parallel.h"
#include "device_scene/cut_triangles.h"
#include "promin/error.h"
#include "scene/facets.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

using namespace layout;

/// The number of triangles that a thread processes at a time.
constexpr size_t kTriangleChunkSize = 16384;

uint32_t bits_of(float value) {
  return std::bit_cast<uint32_t>(value);
}

/// Packs the corners in the form that shaders/trace/primitives/triangle.glsl and triangle_corners read: corner0,
/// corner1 and corner2.
Primitive pack_part(const TrianglePart& part) {
  const auto& [a, b, c] = part;
  return {vec4(a.position, b.position.x), vec4(b.position.y, b.position.z, c.position.x, c.position.y),
          uvec4(bits_of(c.position.z), 0, KIND_TRIANGLE, 0)};
}

template <class Shape>
Primitive pack_with_kind(const Shape& shape) {
  Primitive primitive = promin::pack(shape);
  primitive.c.z = KindOf<Shape>::value;
  return primitive;
}

Bounds bounds_of(const TrianglePart& part) {
  Bounds bounds;
  for (const PartCorner& corner : part) bounds.extend(corner.position);
  return bounds;
}

uint32_t hash_of(std::initializer_list<uint64_t> words) {
  Hash64 hash;
  for (const uint64_t word : words) hash.add(word);
  return static_cast<uint32_t>(hash.value() >> 48);
}

void check_count(const world::Scene& scene, size_t count) {
  check_at_most(CHILD_FIRST_MASK, count, scene, "the scene has", "primitives");
}

vec4 record_of(const vec3& value) {
  return {value, 0.0F};
}
vec4 record_of(const vec4& value) {
  return value;
}

class Collector {
 public:
  Collector(const world::Scene& scene, std::span<const uint32_t> numbers_of_object)
      : scene_(scene), cut_triangles_(scene) {
    size_t count = 0;
    for (const world::Object& object : scene.objects) count += world::primitive_count(object.shape);
    check_count(scene, count);
    result_.bounded.reserve(count);
    result_.bounded_surfaces.reserve(count);
    result_.boxes.reserve(count);
    for (const world::Object& object : scene.objects) {
      object_ = static_cast<size_t>(&object - scene.objects.data());
      material_ = object.material;
      result_.numbers.first_order.push_back(result_.order);
      result_.numbers.is_rewound.push_back(object.is_rewound);
      std::visit([this](const auto& shape) { add(shape); }, object.shape);
      if (!numbers_of_object.empty()) result_.order += numbers_of_object[object_];
    }
    result_.numbers.first_order.push_back(result_.order);
  }

  Collected take() { return std::move(result_); }

 private:
  void add(const world::NotDrawn&) {}

#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                            \
  void add(const world::TYPE& shape) {                                                          \
    add_bounded(pack_with_kind(shape), 0, promin::bounds_of(shape), uvec4(0, 0, 0, material_)); \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  void add(const world::TYPE& shape) {                                   \
    add_unbounded(pack_with_kind(shape));                                \
  }
#include "promin/kinds/primitives.def"

  void add_unbounded(Primitive primitive) {
    primitive.c.y = result_.order++;
    primitive.c.w = hashes_of(object_, 0);
    result_.unbounded.push_back(primitive);
    result_.unbounded_surfaces.push_back({uvec4(0, 0, 0, material_)});
  }

  void add(const Mesh& mesh) {
    VertexRecords& vertices = result_.vertices;
    first_vertex_ = static_cast<uint32_t>(vertices.count());
    uint32_t flags = 0;
    const auto add_all = [&](uint32_t flag, const auto& values, std::vector<vec4>& records) {
      if (values.empty()) return;
      flags |= flag;
      records.resize(first_vertex_);
      for (const auto& value : values) records.push_back(record_of(value));
    };
    add_all(SURFACE_IS_SMOOTH, mesh.normals, vertices.normals);
    add_all(SURFACE_IS_COLORED, mesh.colors, vertices.colors);
    add_all(SURFACE_HAS_UVS, mesh.uvs, vertices.uvs);
    add_all(SURFACE_HAS_TANGENTS, mesh.tangents, vertices.tangents);
    if (cut_triangles_.cut_any()) {
      add_cut(mesh, flags);
    } else {
      add_whole(mesh, flags);
    }
  }

  /// Adds the triangles of a mesh in which no triangle has several parts, so that the position of each is known in
  /// advance.
  void add_whole(const Mesh& mesh, uint32_t flags) {
    const std::span<const uint32_t> degenerate = cut_triangles_.degenerate_triangles(object_);
    result_.degenerate_count += degenerate.size();
    const size_t first = result_.bounded.size();
    const size_t count = mesh.triangles.size() - degenerate.size();
    result_.bounded.resize(first + count);
    result_.bounded_surfaces.resize(first + count);
    result_.boxes.resize(first + count);
    for_each_chunk(mesh.triangles.size(), kTriangleChunkSize, 0, [&](size_t begin, size_t end) {
      auto skipped = std::lower_bound(degenerate.begin(), degenerate.end(), begin);
      for (size_t i = begin; i < end; ++i) {
        if (skipped != degenerate.end() && *skipped == i) {
          ++skipped;
          continue;
        }
        const auto triangle = static_cast<uint32_t>(i);
        const uvec3& corners = mesh.triangles[i];
        const TrianglePart whole = whole_triangle(mesh, triangle);
        const size_t place = first + i - static_cast<size_t>(skipped - degenerate.begin());
        Primitive primitive = pack_part(whole);
        primitive.c.y = result_.order + triangle;
        primitive.c.w = hashes_of(object_, triangle);
        result_.bounded[place] = primitive;
        result_.bounded_surfaces[place] = {uvec4(flags != 0 ? first_vertex_ + corners : uvec3(0),
                                                 triangle_material(mesh, triangle, material_) | flags)};
        result_.boxes[place] = bounds_of(whole);
      }
    });
    result_.order += static_cast<uint32_t>(mesh.triangles.size());
  }

  /// Adds the triangles of a mesh in which some triangles may have several parts.
  void add_cut(const Mesh& mesh, uint32_t flags) {
    auto skipped = cut_triangles_.degenerate_triangles(object_).begin();
    result_.degenerate_count += cut_triangles_.degenerate_triangles(object_).size();
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      if (skipped != cut_triangles_.degenerate_triangles(object_).end() && *skipped == i) {
        ++skipped;
        ++result_.order;
        continue;
      }
      cut_triangles_.cut(mesh, i, parts_);
      for (const TrianglePart& part : parts_) {
        uvec3 vertices(0);
        for (int corner = 0; corner < 3 && flags != 0; ++corner) {
          vertices[corner] = first_vertex_ + vertex_of(mesh, mesh.triangles[i], part[static_cast<size_t>(corner)]);
        }
        if (parts_.size() > 1) add_part(part, &part == parts_.data());
        add_bounded(pack_part(part), i, bounds_of(part),
                    uvec4(vertices, triangle_material(mesh, i, material_) | flags));
      }
    }
  }

  /// Returns the index of the vertex at a part's corner, relative to the mesh's first. At a cut the mesh has no such
  /// vertex, so it is added with interpolated values.
  uint32_t vertex_of(const Mesh& mesh, const uvec3& corners, const PartCorner& corner) {
    if (corner.weights == dvec2(0, 0)) return corners.x;
    if (corner.weights == dvec2(1, 0)) return corners.y;
    if (corner.weights == dvec2(0, 1)) return corners.z;
    const auto mix = [&](const auto& values) {
      const auto& [u, v] = std::pair(static_cast<float>(corner.weights.x), static_cast<float>(corner.weights.y));
      return (1.0F - u - v) * values[corners.x] + u * values[corners.y] + v * values[corners.z];
    };
    const size_t vertex = result_.vertices.count();
    const auto add_mixed = [&](const auto& values, std::vector<vec4>& records) {
      if (values.empty()) return;
      records.resize(vertex);
      records.push_back(record_of(mix(values)));
    };
    add_mixed(mesh.normals, result_.vertices.normals);
    add_mixed(mesh.colors, result_.vertices.colors);
    add_mixed(mesh.uvs, result_.vertices.uvs);
    add_mixed(mesh.tangents, result_.vertices.tangents);
    return static_cast<uint32_t>(vertex) - first_vertex_;
  }

  void add_part(const TrianglePart& part, bool is_first) {
    std::vector<PackedPart>& parts = result_.numbers.parts;
    PackedPart packed{result_.order, (parts.empty() ? 0 : parts.back().further_parts) + (is_first ? 0U : 1U), {}};
    for (size_t corner = 0; corner < 3; ++corner) packed.weights[corner] = vec2(part[corner].weights);
    parts.push_back(packed);
  }

  void add_bounded(Primitive primitive, uint32_t number, const Bounds& box, const uvec4& surface) {
    check_count(scene_, result_.bounded.size() + 1);
    primitive.c.y = result_.order++;
    primitive.c.w = hashes_of(object_, number);
    result_.bounded.push_back(primitive);
    result_.bounded_surfaces.push_back({surface});
    result_.boxes.push_back(box);
  }

  const world::Scene& scene_;
  CutTriangles cut_triangles_;
  Collected result_;
  size_t object_ = 0;
  uint32_t material_ = 0;
  /// The first vertex of the current mesh.
  uint32_t first_vertex_ = 0;
  /// The parts of the current triangle.
  std::vector<TrianglePart> parts_;
};

}  // namespace

uint32_t hashes_of(size_t object, uint32_t primitive) {
  return hash_of({object}) | hash_of({object, primitive}) << 16;
}

Collected collect_primitives(const world::Scene& scene, std::span<const uint32_t> numbers_of_object) {
  return Collector(scene, numbers_of_object).take();
}

void check_at_most(uint32_t most, size_t count, const world::Scene& scene, const char* who, const char* what,
                   const char* cure, Setting setting) {
  if (count <= most) return;
  throw RunError({"scene.size.limit", who + (" " + std::to_string(count)) + " " + what, scene.file.string(),
                  "use fewer, because promin supports at most " + std::to_string(most) + cure, setting});
}

}  // namespace promin
