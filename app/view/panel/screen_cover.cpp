// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/screen_cover.h"

#include <algorithm>
#include <cmath>

#include "scene/choose_instances.h"
#include "scene/facets.h"
#include "scene/placed_bounds.h"

namespace promin::app {
namespace {

const dvec2 kCells(ScreenCover::kColumns, ScreenCover::kRows);
/// The largest number of steps along a side in which a facet is sampled.
constexpr int kMostSteps = 2 * ScreenCover::kColumns;

/// Calls `use` with points of a triangle. `steps` is the number of steps along each side.
template <class Vector, class Use>
void sample_triangle(const std::array<Vector, 3>& corners, int steps, const Use& use) {
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps - i; ++j) {
      const double u = double(i) / steps;
      const double v = double(j) / steps;
      use(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]));
    }
  }
}

/// Returns the number of steps between two places for which no cell is missed.
int count_steps(const dvec2& lo, const dvec2& hi) {
  const dvec2 cells = (hi - lo) * kCells;
  return 1 + static_cast<int>(std::min(std::max(cells.x, cells.y), kMostSteps - 1.0));
}

/// Calls `use` with the column and row of each cell whose middle lies in an area.
template <class Use>
void for_each_cell(const WindowArea& area, const Use& use) {
  for (size_t y = 0; y < ScreenCover::kRows; ++y) {
    for (size_t x = 0; x < ScreenCover::kColumns; ++x) {
      const dvec2 middle = (dvec2(x, y) + 0.5) / kCells;
      if (glm::all(glm::greaterThan(middle, area.lo)) && glm::all(glm::lessThan(middle, area.hi))) use(x, y);
    }
  }
}

void raise_facet(ScreenCover& cover, const std::array<dvec3, 3>& facet, const FreeCamera& camera, double aspect_ratio) {
  std::array<dvec2, 3> places;
  size_t count = 0;
  for (const dvec3& corner : facet) {
    if (const auto place = project(corner, camera, aspect_ratio)) places[count++] = *place;
  }
  if (count == facet.size()) return cover.raise_triangle(places, 1.0F);
  if (count == 0) return;
  // The facet reaches behind the camera.
  sample_triangle(facet, kMostSteps, [&](const dvec3& point) {
    if (const auto place = project(point, camera, aspect_ratio)) cover.raise(*place, 1.0F);
  });
}

}  // namespace

std::optional<dvec2> project(const dvec3& point, const FreeCamera& camera, double aspect_ratio) {
  const dvec3 way = point - camera.position();
  const double ahead = glm::dot(way, camera.look());
  if (!(ahead > 0.0)) return std::nullopt;
  const Camera& lens = camera.camera();
  const bool is_perspective = lens.projection == Projection::kPerspective;
  const double half = is_perspective ? ahead * std::tan(0.5 * double{lens.yfov}) : double{lens.ymag};
  return 0.5 + 0.5 / half * dvec2(glm::dot(way, camera.right()) / aspect_ratio, -glm::dot(way, camera.up()));
}

void ScreenCover::raise(const dvec2& place, float cost) {
  const dvec2 cell = place * kCells;
  if (!(cell.x >= 0.0 && cell.y >= 0.0 && cell.x < kCells.x && cell.y < kCells.y)) return;
  float& own = costs_[static_cast<size_t>(cell.y)][static_cast<size_t>(cell.x)];
  own = std::max(own, cost);
}

void ScreenCover::raise_line(const dvec2& from, const dvec2& to, float cost) {
  const int steps = count_steps(glm::min(from, to), glm::max(from, to));
  for (int i = 0; i <= steps; ++i) raise(glm::mix(from, to, double(i) / steps), cost);
}

void ScreenCover::raise_triangle(const std::array<dvec2, 3>& corners, float cost) {
  const dvec2 lo = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const dvec2 hi = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  if (hi.x < 0.0 || hi.y < 0.0 || lo.x > 1.0 || lo.y > 1.0) return;
  sample_triangle(corners, count_steps(lo, hi), [&](const dvec2& place) { raise(place, cost); });
}

void ScreenCover::raise_area(const WindowArea& area, float cost) {
  for_each_cell(area, [&](size_t x, size_t y) { costs_[y][x] = std::max(costs_[y][x], cost); });
}

double ScreenCover::cost_of(const WindowArea& area) const {
  double sum = 0.0;
  for_each_cell(area, [&](size_t x, size_t y) { sum += double{costs_[y][x]}; });
  return sum;
}

ScreenCover find_cover(const Scene& scene, const Camera& camera, double aspect_ratio) {
  ScreenCover cover;
  const FreeCamera pose(camera);
  const auto raise = [&](const Facet& facet) {
    raise_facet(cover, facet.corners, pose, aspect_ratio);
    return false;
  };
  // Instances may have billions of triangles, so their boxes count.
  const std::vector<bool> is_instance = choose_instances(scene, Instancing::kAuto);
  any_facet(
      scene, [&](size_t object) { return is_instance[object]; }, raise);
  if (std::ranges::count(is_instance, true) == 0) return cover;
  const std::vector<Bounds> boxes = bounds_of_objects(scene);
  for (size_t i = 0; i < boxes.size(); ++i) {
    if (is_instance[i]) FacetFinder<decltype(raise)>{scene, scene.objects[i], raise}.use_box(boxes[i]);
  }
  return cover;
}

WindowArea choose_corner(const ScreenCover& cover, const dvec2& size, const dvec2& margin) {
  const dvec2 last = glm::max(1.0 - margin - size, margin);
  std::array<WindowArea, 4> areas;
  std::array<double, 4> costs{};
  const std::array places = {dvec2(last.x, margin.y), last, dvec2(margin.x, last.y), margin};
  for (size_t i = 0; i < places.size(); ++i) {
    areas[i] = {places[i], places[i] + size};
    costs[i] = cover.cost_of(areas[i]);
  }
  return areas[static_cast<size_t>(std::ranges::min_element(costs) - costs.begin())];
}

}  // namespace promin::app
