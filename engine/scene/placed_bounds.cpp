// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/placed_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
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
/// The number of cells along an edge of a cube, each with its candidates, and the least number of uses for which they
/// pay.
constexpr size_t kCells = 8;
constexpr size_t kLeastUsesOfCandidates = 4096;
/// A point is no candidate if another one lies farther by this share of the points' reach. It is far more than the
/// rounding error of transforms that move the points by at most kMostDistance times their reach.
constexpr double kMargin = 0x1p-28;
constexpr double kMostDistance = 0x1p10;

/// Returns the index of the cell that contains a direction.
size_t cell_of(const dvec3& direction) {
  const dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const auto cell_along = [&](int other) {
    const double place = 0.5 * kCells * (1.0 + direction[other] / size[axis]);
    return std::min(static_cast<size_t>(place), kCells - 1);
  };
  const size_t face = 2 * static_cast<size_t>(axis) + (direction[axis] > 0.0 ? 1 : 0);
  return (face * kCells + cell_along((axis + 1) % 3)) * kCells + cell_along((axis + 2) % 3);
}

/// The directions of a cell's corners. Each direction in the cell is a sum of their multiples.
using Cell = std::array<dvec3, 4>;

Cell make_cell(size_t index) {
  const size_t face = index / (kCells * kCells);
  const auto axis = static_cast<int>(face / 2);
  Cell cell;
  for (size_t i = 0; i < cell.size(); ++i) {
    const auto place = [](size_t line) { return 2.0 * static_cast<double>(line) / kCells - 1.0; };
    cell[i][axis] = face % 2 == 1 ? 1.0 : -1.0;
    cell[i][(axis + 1) % 3] = place(index / kCells % kCells + i % 2);
    cell[i][(axis + 2) % 3] = place(index % kCells + i / 2);
  }
  return cell;
}

}  // namespace

PlacedBounds::PlacedBounds(std::vector<vec3> points, size_t uses) : points_(std::move(points)) {
  const auto count = static_cast<uint32_t>(points_.size());
  while ((count >> depth_) > kPointsOfPart) ++depth_;
  parts_.resize((size_t{2} << depth_) - 1);
  divide(0, 0, count, 0);
  if (uses >= kLeastUsesOfCandidates && count > kPointsOfPart) find_candidates();
}

dvec3 PlacedBounds::reach() const {
  return glm::abs(parts_[0].center) + parts_[0].half;
}

uint32_t PlacedBounds::find_farthest(const dvec3& direction, uint32_t start) const {
  uint32_t farthest = start;
  double most = glm::dot(direction, dvec3(points_[start]));
  const auto take = [&](uint32_t i) {
    most = glm::dot(direction, dvec3(points_[i]));
    farthest = i;
  };
  visit_beyond(
      direction, 0.0, [&] { return most; }, take);
  return farthest;
}

void PlacedBounds::find_candidates() {
  constexpr size_t kCellCount = 6 * kCells * kCells;
  const auto search = [&](size_t begin, size_t end, std::vector<std::vector<uint32_t>>& found) {
    for (size_t i = begin; i < end; ++i) found.push_back(find_candidates(i));
  };
  first_candidates_.push_back(0);
  for (const auto& some : make_parts(kCellCount, kCells, 0, std::vector<std::vector<uint32_t>>(), search)) {
    for (const std::vector<uint32_t>& of_cell : some) {
      candidates_.insert(candidates_.end(), of_cell.begin(), of_cell.end());
      first_candidates_.push_back(static_cast<uint32_t>(candidates_.size()));
    }
  }
}

/// Returns the points that may lie farthest in a direction of the cell. If one point lies farther than another one in
/// the directions of all corners, it does so in each direction of the cell.
std::vector<uint32_t> PlacedBounds::find_candidates(size_t index) const {
  const Cell cell = make_cell(index);
  dvec4 margin;
  for (int i = 0; i < 4; ++i) margin[i] = kMargin * glm::dot(glm::abs(cell[static_cast<size_t>(i)]), reach());
  const auto values_of = [&](const dvec3& point, const dvec3& half) {
    dvec4 values;
    for (int i = 0; i < 4; ++i) {
      const dvec3& corner = cell[static_cast<size_t>(i)];
      values[i] = glm::dot(corner, point) + glm::dot(glm::abs(corner), half);
    }
    return values;
  };
  // The farthest points in some directions of the cell exclude most of the others.
  std::vector<dvec4> far;
  uint32_t farthest = find_farthest(cell[0] + cell[3], 0);
  far.push_back(values_of(dvec3(points_[farthest]), dvec3(0.0)));
  for (const dvec3& corner : cell) {
    farthest = find_farthest(corner, farthest);
    far.push_back(values_of(dvec3(points_[farthest]), dvec3(0.0)));
  }
  const auto may_be_farthest = [&](const dvec4& values) {
    return std::ranges::none_of(
        far, [&](const dvec4& other) { return glm::all(glm::lessThanEqual(values + margin, other)); });
  };
  std::vector<uint32_t> found;
  const size_t first_leaf = (size_t{1} << depth_) - 1;
  std::vector<size_t> open = {0};
  while (!open.empty()) {
    const size_t number = open.back();
    open.pop_back();
    const Part& part = parts_[number];
    if (part.begin == part.end || !may_be_farthest(values_of(part.center, part.half))) continue;
    if (number < first_leaf) {
      open.insert(open.end(), {2 * number + 1, 2 * number + 2});
      continue;
    }
    for (uint32_t i = part.begin; i < part.end; ++i) {
      const dvec4 values = values_of(dvec3(points_[i]), dvec3(0.0));
      if (!may_be_farthest(values)) continue;
      found.push_back(i);
      far.push_back(values);
    }
  }
  std::erase_if(found, [&](uint32_t i) { return !may_be_farthest(values_of(dvec3(points_[i]), dvec3(0.0))); });
  return found;
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

template <typename Most, typename Take>
void PlacedBounds::visit_beyond(const dvec3& row, double offset, const Most& most, const Take& take) const {
  const dvec3 size = glm::abs(row);
  const auto value_of = [&](const dvec3& point) { return glm::dot(row, point) + offset; };
  const auto reach_of = [&](const Part& part) { return value_of(part.center) + glm::dot(size, part.half); };
  const size_t first_leaf = (size_t{1} << depth_) - 1;
  struct Open {
    size_t part;
    double reach;
  };
  std::array<Open, 64> open{};
  size_t count = 0;
  const auto push = [&](size_t part, double reach) {
    if (parts_[part].begin < parts_[part].end) open[count++] = {part, reach};
  };
  push(0, reach_of(parts_[0]));
  while (count > 0) {
    const auto [part, reach] = open[--count];
    if (reach <= most()) continue;
    if (part >= first_leaf) {
      for (uint32_t i = parts_[part].begin; i < parts_[part].end; ++i) {
        if (value_of(dvec3(points_[i])) > most()) take(i);
      }
      continue;
    }
    const double first = reach_of(parts_[2 * part + 1]);
    const double second = reach_of(parts_[2 * part + 2]);
    if (first >= second) push(2 * part + 2, second);
    push(2 * part + 1, first);
    if (first < second) push(2 * part + 2, second);
  }
}

/// Extends the bounds by the points that lie farthest along an axis. A part is skipped if none of its points can lie
/// beyond the bounds.
void PlacedBounds::extend(Bounds& bounds, const dmat4& matrix, int axis, bool is_high) const {
  const double sign = is_high ? 1.0 : -1.0;
  const dvec3 row = sign * dvec3(matrix[0][axis], matrix[1][axis], matrix[2][axis]);
  // The product with an identity would change the sign of a zero.
  const bool is_identity = Placement(matrix).is_identity();
  const double size = glm::dot(glm::abs(row), reach());
  const double distance = std::abs(matrix[3][axis]);
  const double offset = sign * matrix[3][axis] + kSlack * (size + distance);
  const auto most = [&] { return sign * double{is_high ? bounds.hi[axis] : bounds.lo[axis]}; };
  const auto take = [&](uint32_t i) {
    bounds.extend(is_identity ? points_[i] : vec3(matrix * dvec4(points_[i], 1.0)));
  };
  if (candidates_.empty() || !(size > 0.0) || distance > kMostDistance * size) {
    return visit_beyond(row, offset, most, take);
  }
  const size_t cell = cell_of(row);
  for (uint32_t k = first_candidates_[cell]; k < first_candidates_[cell + 1]; ++k) {
    const uint32_t i = candidates_[k];
    if (glm::dot(row, dvec3(points_[i])) + offset > most()) take(i);
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
    shared.try_emplace(i, find_corners(*mesh), users[i]);
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
