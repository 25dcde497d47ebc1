// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/stray_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <variant>

#include "core/parallel.h"
#include "core/rounding.h"
#include "scene/choose_instances.h"
#include "scene/placed_bounds.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

constexpr double kLeastShare = 0.99;
constexpr float kFar = 64.0F;
constexpr size_t kBinCount = 128;
/// The largest number of passes. Each pass at least halves the box, and fp32 has 24 bits.
constexpr int kMostPasses = 24;

/// Adds the bounds and the surface area of each finite primitive of an object, in the world, to a sum. Many triangles
/// are added in parts, whose sums are added afterwards.
template <class Sum>
struct FinitePrimitives {
  const dmat4& world_from_object;
  Sum& sum;

  void operator()(const Mesh& mesh) const {
    const bool is_moved = !Placement(world_from_object).is_identity();
    constexpr size_t kTriangles = 16384;
    for (const Sum& part :
         make_parts(mesh.triangles.size(), kTriangles, 0, sum.start_part(), [&](size_t begin, size_t end, Sum&some) {
           for (size_t i = begin; i < end; ++i) add_triangle(some, mesh, mesh.triangles[i], is_moved);
         })) {
      sum.add_part(part);
    }
  }
  void add_triangle(Sum& some, const Mesh& mesh, const uvec3& triangle, bool is_moved) const {
    std::array<dvec3, 3> corners;
    Bounds bounds;
    for (int i = 0; i < 3; ++i) {
      const dvec3 p(mesh.positions[triangle[i]]);
      dvec3& corner = corners[static_cast<size_t>(i)];
      corner = is_moved ? dvec3(world_from_object * dvec4(p, 1.0)) : p;
      bounds.extend(vec3(corner));
    }
    some.add(bounds, 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
  }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)         \
  void operator()(const TYPE& shape) const {                                 \
    const std::optional placed = place(shape, Placement(world_from_object)); \
    if (placed) add_box(promin::bounds_of(*placed));                         \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  void operator()(const TYPE& /*shape*/) const {}
#include "promin/kinds/primitives.def"

  void add_box(const Bounds& bounds) const {
    const dvec3 size(bounds.extent());
    sum.add(bounds, 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x));
  }
};

/// The objects that count as wholes, with their bounds and surface areas. The areas are exact if a transform scales all
/// axes alike.
struct Wholes {
  std::span<const Bounds> bounds;
  std::vector<double> areas;

  Wholes(const Scene& scene, std::span<const Bounds> of_objects) : bounds(of_objects), areas(of_objects.size()) {
    std::map<uint32_t, double> own_areas;
    for (size_t i = 0; i < areas.size(); ++i) {
      if (bounds[i].is_empty()) continue;
      const Object& object = scene.objects[i];
      const auto [own, is_new] = own_areas.try_emplace(object.geometry, 0.0);
      if (is_new) own->second = area_of(std::get<Mesh>(scene.geometries[object.geometry]));
      areas[i] = own->second * std::pow(std::abs(glm::determinant(dmat3(object.world_from_object))), 2.0 / 3.0);
    }
  }

  static double area_of(const Mesh& mesh) {
    double sum = 0.0;
    for (const uvec3& triangle : mesh.triangles) {
      const dvec3 a(mesh.positions[triangle.x]);
      sum +=
          0.5 * glm::length(glm::cross(dvec3(mesh.positions[triangle.y]) - a, dvec3(mesh.positions[triangle.z]) - a));
    }
    return sum;
  }
};

template <class Sum>
Sum add_up(const Scene& scene, const Wholes& wholes, Sum sum) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.geometry == Object::kNoGeometry) continue;
    const Geometry& geometry = scene.geometries[object.geometry];
    if (!wholes.bounds[i].is_empty()) {
      sum.add(wholes.bounds[i], wholes.areas[i], primitive_count(scene, object));
    } else {
      std::visit(FinitePrimitives<Sum>{object.world_from_object, sum}, geometry);
    }
  }
  return sum;
}

/// The surface area in each slice of a box along an axis.
using Slices = std::array<double, kBinCount>;

/// Returns the shortest run of slices, as [first, last), with at least this surface area.
std::pair<size_t, size_t> find_shortest_run(const Slices& slices, double least) {
  std::pair<size_t, size_t> best(0, kBinCount);
  double sum = 0.0;
  size_t first = 0;
  for (size_t last = 1; last <= kBinCount; ++last) {
    sum += slices[last - 1];
    while (first < last && sum - slices[first] >= least) sum -= slices[first++];
    if (sum >= least && last - first < best.second - best.first) best = {first, last};
  }
  return best;
}

/// The surface area of primitives, sorted by the slice of the box that contains their centre.
struct Histogram {
  Bounds box;
  dvec3 slice_size;
  dvec3 slices_per_length;
  std::array<Slices, 3> slices{};
  double total = 0.0;

  explicit Histogram(const Bounds& bounds)
      : box(bounds),
        slice_size((dvec3(box.hi) - dvec3(box.lo)) / static_cast<double>(kBinCount)),
        slices_per_length(glm::mix(dvec3(0.0), 1.0 / slice_size, glm::greaterThan(slice_size, dvec3(0.0)))) {}

  Histogram start_part() const { return Histogram(box); }
  void add(const Bounds& bounds, double surface, uint64_t /*count*/ = 1) {
    const vec3 center = bounds.center();
    if (!holds(box, center)) return;
    total += surface;
    const dvec3 at = (dvec3(center) - dvec3(box.lo)) * slices_per_length;
    for (int axis = 0; axis < 3; ++axis) {
      const auto slice = std::min(static_cast<size_t>(at[axis]), kBinCount - 1);
      slices[static_cast<size_t>(axis)][slice] += surface;
    }
  }
  void add_part(const Histogram& part) {
    total += part.total;
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t i = 0; i < kBinCount; ++i) slices[axis][i] += part.slices[axis][i];
    }
  }
};

/// The surface area of the primitives that have their centre in a box, and the number of primitives outside the box.
struct Content {
  Bounds box;
  MainPart part = {};
  double surface = 0.0;

  Content start_part() const { return {box}; }
  void add(const Bounds& bounds, double of_primitive, uint64_t count = 1) {
    if (!holds(box, bounds.center())) {
      part.stray_count += count;
      return;
    }
    surface += of_primitive;
    part.bounds.extend(bounds);
  }
  void add_part(const Content& content) {
    surface += content.surface;
    part.bounds.extend(content.part.bounds);
    part.stray_count += content.part.stray_count;
  }
};

/// Returns the box reduced to its shortest runs of slices.
Bounds shrink(const Bounds& box, const Histogram& histogram, double least) {
  Bounds shrunk = box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [first, last] = find_shortest_run(histogram.slices[static_cast<size_t>(axis)], least);
    const double slice = histogram.slice_size[axis];
    shrunk.lo[axis] = static_cast<float>(double{box.lo[axis]} + slice * static_cast<double>(first));
    if (last < kBinCount)
      shrunk.hi[axis] = static_cast<float>(double{box.lo[axis]} + slice * static_cast<double>(last));
  }
  return shrunk;
}

/// Returns a box that contains the centres of nearly all of the surface area. If the centres are spread over the given
/// box, returns that box.
Bounds find_dense_box(const Scene& scene, const Wholes& wholes, const Bounds& bounds, double& total) {
  Bounds box = bounds;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Histogram histogram = add_up(scene, wholes, Histogram(box));
    if (pass == 0) total = histogram.total;
    // Each of the three axes may exclude a third of the area that may be excluded. The caller checks the total of all
    // passes.
    const Bounds shrunk = shrink(box, histogram, total * (1.0 - (1.0 - kLeastShare) / 3.0));
    if (max_component(shrunk.extent()) > 0.5F * max_component(box.extent())) break;
    box = shrunk;
  }
  return box;
}

bool is_far_smaller(const Bounds& part, const Bounds& all) {
  return kFar * max_component(part.extent()) < max_component(all.extent());
}

}  // namespace

bool holds(const Bounds& bounds, const vec3& point) {
  return glm::all(glm::lessThanEqual(bounds.lo, point)) && glm::all(glm::lessThanEqual(point, bounds.hi));
}

MainPart find_main_part(const Scene& scene) {
  MainPart all;
  all.wholes = bounds_of_objects(scene);
  for (const Bounds& box : all.wholes) all.bounds.extend(box);
  const std::vector<bool> is_whole = choose_instances(scene, Instancing::kAuto);
  for (size_t i = 0; i < is_whole.size(); ++i) {
    if (!is_whole[i]) all.wholes[i] = {};
  }
  if (all.bounds.is_empty()) return all;
  double total = 0.0;
  const Wholes wholes(scene, all.wholes);
  const Bounds box = find_dense_box(scene, wholes, all.bounds, total);
  if (!is_far_smaller(box, all.bounds)) return all;

  Content content = add_up(scene, wholes, Content{box});
  content.part.centers = box;
  content.part.wholes = all.wholes;
  return content.surface > 0.0 && content.surface >= kLeastShare * total &&
                 is_far_smaller(content.part.bounds, all.bounds)
             ? content.part
             : all;
}

}  // namespace promin
