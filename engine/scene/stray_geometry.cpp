// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/stray_geometry.h"

#include <algorithm>
#include <array>
#include <variant>

#include "core/rounding.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

constexpr double kLeastShare = 0.99;
constexpr float kFar = 64.0F;
constexpr int kBinCount = 128;
/// Each halves the box at least, and fp32 has 24 bits.
constexpr int kMostPasses = 24;

/// Calls `use` with the bounds and the surface of each finite primitive of an object, in the world.
template <class Use>
struct FinitePrimitives {
  const dmat4& world_from_object;
  const Use& use;

  void operator()(const Mesh& mesh) const {
    for (const uvec3& triangle : mesh.triangles) {
      std::array<dvec3, 3> corners;
      Bounds bounds;
      for (int i = 0; i < 3; ++i) {
        const auto corner = static_cast<size_t>(i);
        corners[corner] = dvec3(world_from_object * dvec4(mesh.positions[triangle[i]], 1.0));
        bounds.extend(vec3(corners[corner]));
      }
      use(bounds, 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
    }
  }
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)         \
  void operator()(const TYPE& shape) const {                                 \
    const std::optional placed = place(shape, Placement(world_from_object)); \
    if (placed) use_box(promin::bounds_of(*placed));                         \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  void operator()(const TYPE& /*shape*/) const {}
#include "promin/kinds/primitives.def"

  void use_box(const Bounds& bounds) const {
    const dvec3 size(bounds.extent());
    use(bounds, 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x));
  }
};

template <class Use>
void for_each_finite_primitive(const Scene& scene, const Use& use) {
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) continue;
    std::visit(FinitePrimitives<Use>{object.world_from_object, use}, scene.geometries[object.geometry]);
  }
}

/// The surface in slices of a box along an axis.
using Slices = std::array<double, kBinCount>;

/// The shortest run of slices, as [first, last), that holds so much surface.
std::pair<int, int> find_shortest_run(const Slices& slices, double least) {
  std::pair<int, int> best(0, kBinCount);
  double sum = 0.0;
  int first = 0;
  for (int last = 1; last <= kBinCount; ++last) {
    sum += slices[static_cast<size_t>(last - 1)];
    while (first < last && sum - slices[static_cast<size_t>(first)] >= least)
      sum -= slices[static_cast<size_t>(first++)];
    if (sum >= least && last - first < best.second - best.first) best = {first, last};
  }
  return best;
}

/// The surface of primitives by the places of their centers in a box.
struct Histogram {
  std::array<Slices, 3> slices{};
  dvec3 slice_size{0.0};
  double total = 0.0;
};

Histogram make_histogram(const Scene& scene, const Bounds& box) {
  Histogram result;
  result.slice_size = (dvec3(box.hi) - dvec3(box.lo)) / static_cast<double>(kBinCount);
  const dvec3 scale = glm::mix(dvec3(0.0), 1.0 / result.slice_size, glm::greaterThan(result.slice_size, dvec3(0.0)));
  for_each_finite_primitive(scene, [&](const Bounds& bounds, double surface) {
    const vec3 center = bounds.center();
    if (!holds(box, center)) return;
    result.total += surface;
    const dvec3 at = (dvec3(center) - dvec3(box.lo)) * scale;
    for (int axis = 0; axis < 3; ++axis) {
      const auto slice = std::min(static_cast<size_t>(at[axis]), size_t{kBinCount - 1});
      result.slices[static_cast<size_t>(axis)][slice] += surface;
    }
  });
  return result;
}

/// The box without what lies beside its shortest runs of slices.
Bounds shrink(const Bounds& box, const Histogram& histogram, double least) {
  Bounds shrunk = box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [first, last] = find_shortest_run(histogram.slices[static_cast<size_t>(axis)], least);
    const double slice = histogram.slice_size[axis];
    shrunk.lo[axis] = static_cast<float>(double{box.lo[axis]} + slice * first);
    if (last < kBinCount) shrunk.hi[axis] = static_cast<float>(double{box.lo[axis]} + slice * last);
  }
  return shrunk;
}

/// A box that holds the centers of nearly all of the surface; the given one where these are spread over it.
Bounds find_dense_box(const Scene& scene, const Bounds& bounds, double& total) {
  Bounds box = bounds;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Histogram histogram = make_histogram(scene, box);
    if (pass == 0) total = histogram.total;
    // Each of three axes may lose a third of what may be left out; the caller checks what all passes lose.
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
  const MainPart all{.bounds = bounds_of(scene)};
  if (all.bounds.is_empty()) return all;
  double total = 0.0;
  const Bounds box = find_dense_box(scene, all.bounds, total);
  if (!is_far_smaller(box, all.bounds)) return all;

  MainPart part{.bounds = {}, .centers = box};
  double kept = 0.0;
  for_each_finite_primitive(scene, [&](const Bounds& bounds, double surface) {
    if (!holds(box, bounds.center())) {
      ++part.stray_count;
      return;
    }
    kept += surface;
    part.bounds.extend(bounds);
  });
  return kept > 0.0 && kept >= kLeastShare * total && is_far_smaller(part.bounds, all.bounds) ? part : all;
}

}  // namespace promin
