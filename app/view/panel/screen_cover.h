// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "promin/scene.h"
#include "work/pictures/camera.h"

namespace promin::app {

/// Returns the place of a point in the window, as fractions of its width and height from the upper left; empty if the
/// point lies behind the camera.
std::optional<dvec2> project(const dvec3& point, const FreeCamera& camera, double aspect_ratio);

/// A rectangle of the window, in fractions of its width and height.
struct WindowArea {
  dvec2 lo{0.0};
  dvec2 hi{0.0};
};

/// The costs of hiding parts of the window behind a panel, stored for a grid of cells. All places are fractions of the
/// window's size. Places outside the window have no effect.
class ScreenCover {
 public:
  static constexpr int kColumns = 64;
  static constexpr int kRows = 36;

  // The following functions raise the costs of the cells that they touch to at least `cost`.
  void raise(const dvec2& place, float cost);
  void raise_line(const dvec2& from, const dvec2& to, float cost);
  void raise_triangle(const std::array<dvec2, 3>& corners, float cost);
  void raise_area(const WindowArea& area, float cost);

  /// Returns the sum of the costs of all cells whose middle lies in the area.
  double cost_of(const WindowArea& area) const;

 private:
  std::array<std::array<float, kColumns>, kRows> costs_{};
};

/// Returns a cover in which the cells with visible finite parts of a scene have cost 1.
ScreenCover find_cover(const Scene& scene, const Camera& camera, double aspect_ratio);

/// Returns the corner of the window in which a panel of this size hides the least cost. If several corners have the
/// same cost, the first of upper right, lower right, lower left, upper left is returned. The panel keeps the distance
/// `margin` from the edges.
WindowArea choose_corner(const ScreenCover& cover, const dvec2& size, const dvec2& margin);

}  // namespace promin::app
