// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "promin/scene.h"
#include "work/pictures/camera.h"

namespace promin::app {

/// Returns the place at which the window shows a point, as shares of its width and height from the upper left; empty if
/// the point lies behind the camera.
std::optional<dvec2> project(const dvec3& point, const FreeCamera& camera, double aspect_ratio);

/// A rectangle of the window, in shares of its width and height.
struct WindowArea {
  dvec2 lo{0.0};
  dvec2 hi{0.0};
};

/// The costs of hiding parts of the window behind a panel, as a grid of cells. All places are shares of the window's
/// size; places outside have no effect.
class ScreenCover {
 public:
  static constexpr int kColumns = 64;
  static constexpr int kRows = 36;

  // These raise the costs of the cells that they touch to at least this one.
  void raise(const dvec2& place, float cost);
  void raise_line(const dvec2& from, const dvec2& to, float cost);
  void raise_triangle(const std::array<dvec2, 3>& corners, float cost);
  void raise_area(const WindowArea& area, float cost);

  /// Returns the sum of the costs of all cells with their middle in the area.
  double cost_of(const WindowArea& area) const;

 private:
  std::array<std::array<float, kColumns>, kRows> costs_{};
};

/// Returns the cells in which a camera sees finite parts of a scene, each at cost 1.
ScreenCover find_cover(const Scene& scene, const Camera& camera, double aspect_ratio);

/// Returns the corner of the window in which a panel of this size hides the least cost. Among equal costs the order is
/// upper right, lower right, lower left, upper left. The panel keeps the distance `margin` from the edges.
WindowArea choose_corner(const ScreenCover& cover, const dvec2& size, const dvec2& margin);

}  // namespace promin::app
