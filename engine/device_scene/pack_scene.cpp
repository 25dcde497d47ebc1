// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_scene.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <string>

#include "bvh/clip_triangle.h"
#include "bvh/read_node.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "core/unset_vector.h"
#include "device_scene/cut_triangles.h"
#include "promin/error.h"

namespace promin {
namespace {

using namespace layout;

/// Triangles or references that a thread takes at a time.
constexpr size_t kChunkSize = 16384;

uint32_t bits_of(float value) {
  return std::bit_cast<uint32_t>(value);
}

// How each shape becomes a primitive: the comment at layout::Primitive.
Primitive pack(const Sphere& s) {
  return {vec4(s.center, s.radius), vec4(0.0F), uvec4(0, 0, KIND_SPHERE, 0)};
}
Primitive pack(const Cylinder& c) {
  return {vec4(c.center, c.radius), vec4(c.axis, c.half_height), uvec4(0, 0, KIND_CYLINDER, 0)};
}
Primitive pack(const Cone& c) {
  return {vec4(c.center, c.radius_bottom), vec4(c.axis, c.half_height), uvec4(bits_of(c.radius_top), 0, KIND_CONE, 0)};
}
Primitive pack(const Plane& p) {
  return {vec4(p.point, 0.0F), vec4(p.normal, 0.0F), uvec4(0, 0, KIND_PLANE, 0)};
}
Primitive pack(const TrianglePart& part) {
  const auto& [a, b, c] = part;
  return {vec4(a.position, b.position.x), vec4(b.position.y, b.position.z, c.position.x, c.position.y),
          uvec4(bits_of(c.position.z), 0, KIND_TRIANGLE, 0)};
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

/// Primitive::c.w.
uint32_t hashes_of(size_t object, uint32_t primitive) {
  return hash_of({object}) | hash_of({object, primitive}) << 16;
}

/// Primitives, boxes and surfaces in (object, primitive) order; the tree reorders them afterwards.
struct Collected {
  UnsetVector<Primitive> solids;
  UnsetVector<SurfaceRecord> solid_surfaces;
  UnsetVector<Bounds> boxes;
  std::vector<Primitive> planes;
  std::vector<SurfaceRecord> plane_surfaces;
  std::vector<vec4> normals;
  std::vector<vec4> colors;
  PrimitiveNumbers numbers;
  uint32_t order = 0;
};

/// Throws RunError for "`who` `count` `what`" beyond `most`.
void check_at_most(uint32_t most, size_t count, const Scene& scene, const char* who, const char* what,
                   const char* cure = "") {
  if (count <= most) return;
  throw RunError({who + (" " + std::to_string(count)) + " " + what, scene.file.string(),
                  "promin holds at most " + std::to_string(most) + cure});
}

void check_count(const Scene& scene, size_t count) {
  check_at_most(CHILD_FIRST_MASK, count, scene, "the scene has", "primitives");
}

class Collector {
 public:
  explicit Collector(const Scene& scene) : scene_(scene), cut_triangles_(scene) {
    size_t count = 0;
    for (const Object& object : scene.objects) count += primitive_count(object.shape);
    check_count(scene, count);
    result_.solids.reserve(count);
    result_.solid_surfaces.reserve(count);
    result_.boxes.reserve(count);
    for (const Object& object : scene.objects) {
      object_ = static_cast<size_t>(&object - scene.objects.data());
      material_ = object.material;
      result_.numbers.first_order.push_back(result_.order);
      std::visit([this](const auto& shape) { add(shape); }, object.shape);
    }
    result_.numbers.first_order.push_back(result_.order);
  }

  Collected take() { return std::move(result_); }

 private:
  void add(const NotDrawn&) {}

  void add(const Plane& plane) {
    Primitive primitive = pack(plane);
    primitive.c.y = result_.order++;
    primitive.c.w = hashes_of(object_, 0);
    result_.planes.push_back(primitive);
    result_.plane_surfaces.push_back({uvec4(0, 0, 0, material_)});
  }

  template <typename Solid>
  void add(const Solid& solid) {
    add_solid(pack(solid), 0, bounds_of(solid), uvec4(0, 0, 0, material_));
  }

  void add(const Mesh& mesh) {
    first_vertex_ = static_cast<uint32_t>(std::max(result_.normals.size(), result_.colors.size()));
    uint32_t flags = 0;
    if (!mesh.normals.empty()) {
      flags |= SURFACE_IS_SMOOTH;
      result_.normals.resize(first_vertex_);
      for (const vec3& n : mesh.normals) result_.normals.emplace_back(n, 0.0F);
    }
    if (!mesh.colors.empty()) {
      flags |= SURFACE_IS_COLORED;
      result_.colors.resize(first_vertex_);
      result_.colors.insert(result_.colors.end(), mesh.colors.begin(), mesh.colors.end());
    }
    if (cut_triangles_.cut_any()) {
      add_cut(mesh, flags);
    } else {
      add_whole(mesh, flags);
    }
  }

  uint32_t material_of(const Mesh& mesh, uint32_t triangle) const {
    return mesh.triangle_materials.empty() ? material_ : mesh.triangle_materials[triangle];
  }

  /// The triangles of a mesh, none of which is in parts: each has its place.
  void add_whole(const Mesh& mesh, uint32_t flags) {
    const std::span<const uint32_t> degenerate = cut_triangles_.degenerate_triangles(object_);
    const size_t first = result_.solids.size();
    const size_t count = mesh.triangles.size() - degenerate.size();
    result_.solids.resize(first + count);
    result_.solid_surfaces.resize(first + count);
    result_.boxes.resize(first + count);
    for_each_chunk(mesh.triangles.size(), kChunkSize, 0, [&](size_t begin, size_t end) {
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
        Primitive primitive = pack(whole);
        primitive.c.y = result_.order + triangle;
        primitive.c.w = hashes_of(object_, triangle);
        result_.solids[place] = primitive;
        result_.solid_surfaces[place] = {
            uvec4(flags != 0 ? first_vertex_ + corners : uvec3(0), material_of(mesh, triangle) | flags)};
        result_.boxes[place] = bounds_of(whole);
      }
    });
    result_.order += static_cast<uint32_t>(mesh.triangles.size());
  }

  /// The triangles of a mesh, some of which may be in parts.
  void add_cut(const Mesh& mesh, uint32_t flags) {
    auto skipped = cut_triangles_.degenerate_triangles(object_).begin();
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
        add_solid(pack(part), i, bounds_of(part), uvec4(vertices, material_of(mesh, i) | flags));
      }
    }
  }

  /// The vertex at a part's corner, from the mesh's first. Where a triangle was cut there is none with what it has
  /// there, so it is added.
  uint32_t vertex_of(const Mesh& mesh, const uvec3& corners, const PartCorner& corner) {
    if (corner.weights == dvec2(0, 0)) return corners.x;
    if (corner.weights == dvec2(1, 0)) return corners.y;
    if (corner.weights == dvec2(0, 1)) return corners.z;
    const auto mix = [&](const auto& values) {
      const auto& [u, v] = std::pair(static_cast<float>(corner.weights.x), static_cast<float>(corner.weights.y));
      return (1.0F - u - v) * values[corners.x] + u * values[corners.y] + v * values[corners.z];
    };
    const size_t vertex = std::max(result_.normals.size(), result_.colors.size());
    if (!mesh.normals.empty()) {
      result_.normals.resize(vertex);
      result_.normals.emplace_back(mix(mesh.normals), 0.0F);
    }
    if (!mesh.colors.empty()) {
      result_.colors.resize(vertex);
      result_.colors.push_back(mix(mesh.colors));
    }
    return static_cast<uint32_t>(vertex) - first_vertex_;
  }

  void add_part(const TrianglePart& part, bool is_first) {
    std::vector<PackedPart>& parts = result_.numbers.parts;
    PackedPart packed{result_.order, (parts.empty() ? 0 : parts.back().further_parts) + (is_first ? 0U : 1U), {}};
    for (size_t corner = 0; corner < 3; ++corner) packed.weights[corner] = vec2(part[corner].weights);
    parts.push_back(packed);
  }

  void add_solid(Primitive primitive, uint32_t number, const Bounds& box, const uvec4& surface) {
    check_count(scene_, result_.solids.size() + 1);
    primitive.c.y = result_.order++;
    primitive.c.w = hashes_of(object_, number);
    result_.solids.push_back(primitive);
    result_.solid_surfaces.push_back({surface});
    result_.boxes.push_back(box);
  }

  const Scene& scene_;
  CutTriangles cut_triangles_;
  Collected result_;
  size_t object_ = 0;
  uint32_t material_ = 0;
  /// Of the mesh at hand.
  uint32_t first_vertex_ = 0;
  /// Of the triangle at hand.
  std::vector<TrianglePart> parts_;
};

MaterialRecord pack(const Material& m) {
  return {vec4(m.ambient, 0.0F), vec4(m.diffuse, 0.0F), vec4(m.specular, m.shininess), vec4(m.reflection, 0.0F),
          vec4(m.emissive, 0.0F)};
}

uint32_t kind_of(const Light& light) {
  switch (light.kind) {
    case LightKind::kPoint:
      return LIGHT_POINT;
    case LightKind::kDirectional:
      return LIGHT_DIRECTIONAL;
    case LightKind::kSpot:
      return LIGHT_SPOT;
    case LightKind::kHeadlight:
      return LIGHT_HEADLIGHT;
  }
  return LIGHT_POINT;
}

LightRecord pack(const Light& light) {
  const double cos_outer = std::cos(static_cast<double>(light.outer_cone_angle));
  const double cos_inner = std::cos(static_cast<double>(light.inner_cone_angle));
  return {vec4(light.position, 1.0F / light.range), vec4(light.direction, static_cast<float>(cos_outer)),
          vec4(light.diffuse, static_cast<float>(1.0 / std::max(0.001, cos_inner - cos_outer))),
          vec4(light.specular, 0.0F),
          uvec4(kind_of(light), light.attenuation == Attenuation::kInverseSquare ? 1 : 0, 0, 0)};
}

/// Appends records at the next multiple of their stride; returns their first index in that stride.
template <typename Records>
uint32_t append_records(std::vector<std::byte>& bytes, const Records& records) {
  using Record = typename Records::value_type;
  const size_t first = (bytes.size() + sizeof(Record) - 1) / sizeof(Record);
  bytes.resize((first + records.size()) * sizeof(Record));
  if (!records.empty()) {
    std::memcpy(bytes.data() + first * sizeof(Record), records.data(), records.size() * sizeof(Record));
  }
  return static_cast<uint32_t>(first);
}

template <typename Host>
auto pack_all(const std::vector<Host>& hosts) {
  std::vector<decltype(pack(hosts.front()))> records;
  records.reserve(hosts.size());
  for (const Host& host : hosts) records.push_back(pack(host));
  return records;
}

/// What builders that split primitives see of them: triangles exactly, other shapes by their boxes.
Bounds clip(const Primitive& p, const Bounds& window) {
  if (p.c.z != KIND_TRIANGLE) return window;
  return clip_triangle(triangle_corners(p), window);
}

/// The tree's references, ordered by kind within each leaf: traversal takes a leaf kind by kind.
UnsetVector<uint32_t> sort_leaves_by_kind(const Bvh& bvh, std::span<const Primitive> solids) {
  UnsetVector<uint32_t> references = bvh.references;
  const auto is_before = [&](uint32_t a, uint32_t b) { return solids[a].c.z < solids[b].c.z; };
  for_each_chunk(bvh.nodes.size(), kChunkSize, 0, [&](size_t begin, size_t end) {
    for (const BvhNode& node : std::span(bvh.nodes).subspan(begin, end - begin)) {
      if (node.count == 0) continue;
      const auto first = references.begin() + node.first;
      if (!std::is_sorted(first, first + node.count, is_before)) std::stable_sort(first, first + node.count, is_before);
    }
  });
  return references;
}

/// Center and max-norm radius of a box: no corner is farther from the center in any axis.
vec4 center_and_radius(const Bounds& box) {
  if (box.is_empty()) return vec4(0.0F);
  const vec3 center = box.center();
  const dvec3 reach = glm::max(dvec3(box.hi) - dvec3(center), dvec3(center) - dvec3(box.lo));
  return {center, round_up(std::max({reach.x, reach.y, reach.z}))};
}

/// Without what tells which object a primitive is of.
uint64_t hash_geometry(std::span<const Primitive> solids) {
  Hash64 hash;
  hash.add(solids.size());
  for (const Primitive& p : solids) {
    const std::array words = {p.a, p.b};
    hash.add(std::as_bytes(std::span(words)));
    hash.add(p.c.x | uint64_t{p.c.z} << 32);
  }
  return hash.value();
}

/// What a scene is packed to beside its tree, whose references are there.
void pack_contents(PackedScene& packed, const Scene& scene, Collected& collected) {
  packed.numbers = std::move(collected.numbers);
  packed.solid_count = static_cast<uint32_t>(collected.solids.size());
  const std::span<const uint32_t> references = packed.references;
  UnsetVector<SurfaceRecord> surfaces(references.size());
  packed.primitives.resize(references.size());
  for_each_chunk(references.size(), kChunkSize, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      packed.primitives[i] = collected.solids[references[i]];
      surfaces[i] = collected.solid_surfaces[references[i]];
    }
  });
  packed.dispatch.counts =
      uvec4(packed.primitives.size(), collected.planes.size(), scene.lights.size(), LOOP_CHECK_TURNS);
  packed.primitives.insert(packed.primitives.end(), collected.planes.begin(), collected.planes.end());
  surfaces.insert(surfaces.end(), collected.plane_surfaces.begin(), collected.plane_surfaces.end());
  if (packed.primitives.empty()) packed.primitives.push_back({});

  append_records(packed.shading, surfaces);
  packed.frame.first_index.x = append_records(packed.shading, pack_all(scene.materials));
  packed.frame.first_index.y = append_records(packed.shading, pack_all(scene.lights));
  packed.frame.first_index.z = append_records(packed.shading, collected.normals);
  packed.frame.first_index.w = append_records(packed.shading, collected.colors);

  packed.frame.ambient = vec4(scene.ambient, 0.0F);
  packed.frame.background = vec4(scene.background, 0.0F);
  Bounds tree_bounds;
  for (const Bounds& box : collected.boxes) tree_bounds.extend(box);
  packed.frame.tree_bounds = center_and_radius(tree_bounds);
}

}  // namespace

TreeView PackedScene::tree() const {
  if (file) return file->tree();
  return {nodes, references, solid_count, stack_size, geometry_hash, bvh};
}

PackedScene pack_scene(const Scene& scene, std::string_view builder, const BuildOptions& options) {
  Collected collected = Collector(scene).take();

  const Stopwatch building;
  const Bvh bvh =
      build_bvh(builder,
                {collected.boxes,
                 [&](uint32_t primitive, const Bounds& window) { return clip(collected.solids[primitive], window); }},
                options);
  check_at_most(CHILD_FIRST_MASK, bvh.references.size(), scene, "the tree refers to", "parts of primitives",
                "; take --builder sah");
  PackedScene packed;
  packed.bvh_ms = building.ms();
  packed.bvh = measure_bvh(builder, bvh);
  PackedTree tree = pack_tree(bvh);
  check_at_most(MAX_NODES, tree.nodes.size(), scene, "the scene's tree has", "nodes");
  packed.nodes = std::move(tree.nodes);
  packed.stack_size = tree.stack_size;
  packed.bvh.bytes = packed.nodes.size() * sizeof(Node);
  packed.references = sort_leaves_by_kind(bvh, collected.solids);
  packed.geometry_hash = hash_geometry(collected.solids);
  pack_contents(packed, scene, collected);
  return packed;
}

PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const Scene& scene) {
  Collected collected = Collector(scene).take();

  const Stopwatch reading;
  PackedScene packed;
  packed.file = std::make_shared<const BvhFile>(bvh_file);
  packed.geometry_hash = hash_geometry(collected.solids);
  packed.file->check_scene(packed.geometry_hash, collected.solids.size());
  packed.bvh_ms = reading.ms();
  const TreeView& tree = packed.file->tree();
  packed.bvh = tree.stats;
  packed.stack_size = tree.stack_size;
  packed.references.assign(tree.references.begin(), tree.references.end());
  pack_contents(packed, scene, collected);
  return packed;
}

namespace {

/// The last part at or before a number; null if there is none.
const PackedPart* find_part(const PrimitiveNumbers& numbers, uint32_t order) {
  const auto next = std::upper_bound(numbers.parts.begin(), numbers.parts.end(), order,
                                     [](uint32_t number, const PackedPart& part) { return number < part.order; });
  return next == numbers.parts.begin() ? nullptr : &*(next - 1);
}

}  // namespace

PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order) {
  // The last object that begins at or before it: objects without primitives begin where the next one does.
  const auto next = std::upper_bound(numbers.first_order.begin(), numbers.first_order.end(), order);
  assert(next != numbers.first_order.begin() && next != numbers.first_order.end());
  const auto further_parts = [&](uint32_t number) {
    const PackedPart* part = find_part(numbers, number);
    return part == nullptr ? 0 : part->further_parts;
  };
  const uint32_t first = *(next - 1);
  return {static_cast<uint32_t>(next - numbers.first_order.begin()) - 1,
          order - first - (further_parts(order) - further_parts(first))};
}

vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, const vec2& weights) {
  const PackedPart* part = find_part(numbers, order);
  if (part == nullptr || part->order != order) return weights;
  return part->weights[0] + weights.x * (part->weights[1] - part->weights[0]) +
         weights.y * (part->weights[2] - part->weights[0]);
}

}  // namespace promin
