// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/placed_bounds.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <variant>

#include "core/parallel.h"
#include "promin/error.h"
#include "scene/framing.h"
#include "shapes/placement.h"

namespace promin {
namespace {

constexpr uint32_t kPointsOfPart = 16;
constexpr size_t kPlacedChunk = 256;
/// The least numbers of objects and of triangles of a mesh for which a hierarchy pays.
constexpr uint32_t kLeastUsers = 3;
constexpr size_t kLeastTrianglesOfHierarchy = 64;
/// Far more than the rounding error of a transformed coordinate, relative to its largest term.
constexpr double kSlack = 0x1p-40;

}  // namespace

PlacedBounds::PlacedBounds(std::vector<vec3> points) : points_(std::move(points)) {
  const auto count = static_cast<uint32_t>(points_.size());
  while ((count >> depth_) > kPointsOfPart) ++depth_;
  parts_.resize((size_t{2} << depth_) - 1);
  divide(0, 0, count, 0);
}

void PlacedBounds::divide(size_t part, uint32_t begin, uint32_t end, size_t depth) {
  Bounds box;
  for (uint32_t i = begin; i < end; ++i) box.extend(points_[i]);
  if (begin < end) {
    parts_[part] = {0.5 * (dvec3(box.lo) + dvec3(box.hi)), 0.5 * (dvec3(box.hi) - dvec3(box.lo)), begin, end};
  }
  if (depth == depth_) return;
  const vec3 size = begin < end ? box.extent() : vec3(0.0F);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const uint32_t middle = begin + (end - begin) / 2;
  const auto at = [&](uint32_t i) { return points_.begin() + i; };
  std::nth_element(at(begin), at(middle), at(end), [&](const vec3& a, const vec3& b) { return a[axis] < b[axis]; });
  divide(2 * part + 1, begin, middle, depth + 1);
  divide(2 * part + 2, middle, end, depth + 1);
}

Bounds PlacedBounds::of(const dmat4& world_from_object) const {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    extend(bounds, world_from_object, axis, false);
    extend(bounds, world_from_object, axis, true);
  }
  return bounds;
}

/// Extends the bounds by the points that lie farthest along an axis. A part is skipped if none of its points can lie
/// beyond the bounds.
void PlacedBounds::extend(Bounds& bounds, const dmat4& matrix, int axis, bool is_high) const {
  const double sign = is_high ? 1.0 : -1.0;
  const dvec3 row = sign * dvec3(matrix[0][axis], matrix[1][axis], matrix[2][axis]);
  const double offset = sign * matrix[3][axis];
  // The product with an identity would change the sign of a zero.
  const bool is_identity = Placement(matrix).is_identity();
  const dvec3 size = glm::abs(row);
  const double slack =
      kSlack * (glm::dot(size, glm::abs(parts_[0].center) + parts_[0].half) + glm::abs(matrix[3][axis]));
  const auto value_of = [&](const dvec3& point) { return glm::dot(row, point) + offset + slack; };
  const auto reach_of = [&](const Part& part) { return value_of(part.center) + glm::dot(size, part.half); };
  const auto find_most = [&] { return sign * double{is_high ? bounds.hi[axis] : bounds.lo[axis]}; };
  const size_t first_leaf = (size_t{1} << depth_) - 1;
  std::array<size_t, 64> open{};
  size_t count = 0;
  open[count++] = 0;
  while (count > 0) {
    const size_t part = open[--count];
    const double most = find_most();
    if (parts_[part].begin == parts_[part].end || reach_of(parts_[part]) <= most) continue;
    if (part >= first_leaf) {
      for (uint32_t i = parts_[part].begin; i < parts_[part].end; ++i) {
        if (value_of(dvec3(points_[i])) <= most) continue;
        bounds.extend(is_identity ? points_[i] : vec3(matrix * dvec4(points_[i], 1.0)));
      }
      continue;
    }
    const bool is_first_farther = reach_of(parts_[2 * part + 1]) >= reach_of(parts_[2 * part + 2]);
    open[count++] = 2 * part + (is_first_farther ? 2 : 1);
    open[count++] = 2 * part + (is_first_farther ? 1 : 2);
  }
}

std::vector<vec3> find_corners(const Mesh& mesh) {
  std::vector<uint8_t> is_used(mesh.positions.size(), 0);
  for (const uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      if (triangle[i] >= is_used.size()) {
        throw InputError({"scene.reference.range", "a triangle refers to a position that does not exist", "mesh",
                          "see the problems that validate() returns"});
      }
      is_used[triangle[i]] = 1;
    }
  }
  std::vector<vec3> corners;
  for (size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] != 0) corners.push_back(mesh.positions[i]);
  }
  return corners;
}

std::vector<Bounds> bounds_of_objects(const Scene& scene) {
  std::vector<uint32_t> users(scene.geometries.size(), 0);
  for (const Object& object : scene.objects) {
    if (object.geometry < users.size()) ++users[object.geometry];
  }
  std::map<uint32_t, PlacedBounds> shared;
  for (uint32_t i = 0; i < users.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[i]);
    if (mesh == nullptr || users[i] < kLeastUsers || mesh->triangles.size() < kLeastTrianglesOfHierarchy) continue;
    shared.emplace(i, find_corners(*mesh));
  }
  std::vector<Bounds> bounds(scene.objects.size());
  for_each_chunk(bounds.size(), kPlacedChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto found = shared.find(scene.objects[i].geometry);
      if (found != shared.end()) bounds[i] = found->second.of(scene.objects[i].world_from_object);
    }
  });
  for (size_t i = 0; i < bounds.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.geometry != Object::kNoGeometry && !shared.contains(object.geometry)) {
      bounds[i] = bounds_of(scene, object);
    }
  }
  return bounds;
}

}  // namespace promin
