// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_hull.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "scene/framing.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

constexpr size_t kBlockSize = 1024;

/// Returns the positions that triangles use. If all positions are used, the span refers to the mesh itself, otherwise
/// to `copy`.
std::span<const vec3> find_used(const Mesh& mesh, std::vector<vec3>& copy) {
  std::vector<uint8_t> is_used(mesh.positions.size(), 0);
  for (const uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) is_used[triangle[i]] = 1;
  }
  const auto count = static_cast<size_t>(std::ranges::count(is_used, 1));
  if (count == is_used.size()) return mesh.positions;
  copy.reserve(count);
  for (size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) copy.push_back(mesh.positions[i]);
  }
  return copy;
}

/// Returns the corners, in the world, of the triangles whose bounds have their centre in the box.
std::vector<vec3> find_corners_within(const Bounds& box, const Mesh& mesh, const dmat4& world_from_object) {
  std::vector<vec3> found;
  for (const uvec3& triangle : mesh.triangles) {
    std::array<vec3, 3> corners;
    Bounds bounds;
    for (int i = 0; i < 3; ++i) {
      const auto corner = static_cast<size_t>(i);
      corners[corner] = vec3(world_from_object * dvec4(mesh.positions[triangle[i]], 1.0));
      bounds.extend(corners[corner]);
    }
    if (holds(box, bounds.center())) found.insert(found.end(), corners.begin(), corners.end());
  }
  return found;
}

}  // namespace

/// Adds an object's geometry to the hull.
struct SceneHull::Adder {
  SceneHull& hull;
  const Object& object;
  size_t number;

  void operator()(const Mesh& mesh) const { hull.add(mesh, object, number); }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                                         \
  void operator()(const TYPE& shape) const {                                                                 \
    const std::optional placed = place(shape, Placement(object.world_from_object));                          \
    if (!placed || (hull.part_.centers && !holds(*hull.part_.centers, bounds_of(*placed).center()))) return; \
    hull.solids_.emplace_back(*placed);                                                                      \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  void operator()(const TYPE& /*shape*/) const {}
#include "promin/kinds/primitives.def"
};

SceneHull::SceneHull(const Scene& scene)
    : part_(find_main_part(scene)),
      bounds_(part_.bounds.is_empty() ? frame_of(scene) : part_.bounds),
      center_(middle_of(bounds_)) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.geometry != Object::kNoGeometry) std::visit(Adder{*this, object, i}, scene.geometries[object.geometry]);
  }
  if (part_.bounds.is_empty()) solids_.emplace_back(world::Box{.center = bounds_.center(), .half_size = vec3(1.0F)});
}

void SceneHull::add(const Mesh& mesh, const Object& object, size_t number) {
  const bool is_whole = part_.is_whole(number);
  if (is_whole && part_.centers && !holds(*part_.centers, part_.wholes[number].center())) return;
  if (part_.centers && !is_whole) {
    positions_.push_back(find_corners_within(*part_.centers, mesh, object.world_from_object));
    parts_.push_back(cut(positions_.back()));
    meshes_.push_back({nullptr, &parts_.back()});
    return;
  }
  const auto [place, is_new] = blocks_of_.try_emplace(object.geometry);
  if (is_new) place->second = cut(find_used(mesh, positions_.emplace_back()));
  meshes_.push_back({&object.world_from_object, &place->second});
}

SceneHull::Blocks SceneHull::cut(std::span<const vec3> positions) {
  std::vector<Block>& blocks = blocks_.emplace_back();
  for (size_t begin = 0; begin < positions.size(); begin += kBlockSize) {
    Block block{positions.subspan(begin, std::min(kBlockSize, positions.size() - begin)), {}};
    for (const vec3& position : block.positions) block.bounds.extend(position);
    blocks.push_back(block);
  }
  Bounds bounds;
  for (const Block& block : blocks) bounds.extend(block.bounds);
  return {blocks, bounds};
}

void SceneHull::find_farthest(const PlacedMesh& mesh, const dvec3& direction, Farthest& farthest) const {
  const dmat3 turn = mesh.world_from_object == nullptr ? dmat3(1.0) : dmat3(*mesh.world_from_object);
  const dvec3 origin = (mesh.world_from_object == nullptr ? dvec3(0.0) : dvec3((*mesh.world_from_object)[3])) - center_;
  const dvec3 own = direction * turn;
  const double offset = glm::dot(direction, origin);
  double most = farthest.value - offset;
  const vec3* found = nullptr;
  const auto may_reach = [&](const Bounds& bounds) {
    const dvec3 half = 0.5 * (dvec3(bounds.hi) - dvec3(bounds.lo));
    return glm::dot(own, middle_of(bounds)) + glm::dot(glm::abs(own), half) > most;
  };
  if (!may_reach(mesh.of->bounds)) return;
  for (const Block& block : mesh.of->blocks) {
    if (!may_reach(block.bounds)) continue;
    for (const vec3& position : block.positions) {
      const double value = own.x * double{position.x} + own.y * double{position.y} + own.z * double{position.z};
      if (!(value > most)) continue;
      most = value;
      found = &position;
    }
  }
  if (found != nullptr) farthest = {most + offset, turn * dvec3(*found) + origin};
}

dvec3 SceneHull::farthest(const dvec3& direction) const {
  Farthest farthest{-std::numeric_limits<double>::infinity(), dvec3(0.0)};
  for (const Solid& solid : solids_) {
    std::visit(
        [&]<class Shape>(const Shape& shape) {
          if constexpr (!std::is_same_v<Shape, std::monostate>) {
            const dvec3 point = farthest_of(shape, direction) - center_;
            const double value = glm::dot(point, direction);
            if (value > farthest.value) farthest = {value, point};
          }
        },
        solid);
  }
  for (const PlacedMesh& mesh : meshes_) find_farthest(mesh, direction, farthest);
  return farthest.point;
}

}  // namespace promin
