// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "camera.h"
#include "promin/scene.h"

namespace promin::app {

/// Where the window shows a point, as shares of its width and height from the upper left; none where it lies behind the
/// camera.
std::optional<dvec2> project(const dvec3& point, const FreeCamera& camera, double aspect_ratio);

/// A rectangle of the window, in shares of its width and height.
struct WindowArea {
  dvec2 lo{0.0};
  dvec2 hi{0.0};
};

/// How much would be lost by what a panel hides, in cells of the window. All places are shares of its size; what lies
/// outside has no effect.
class ScreenCover {
 public:
  static constexpr int kColumns = 64;
  static constexpr int kRows = 36;

  // These raise the cost of the cells they meet to this one.
  void raise(const dvec2& place, float cost);
  void raise_line(const dvec2& from, const dvec2& to, float cost);
  void raise_triangle(const std::array<dvec2, 3>& corners, float cost);
  void raise_area(const WindowArea& area, float cost);

  /// The sum over the cells whose middle lies in an area.
  double cost_of(const WindowArea& area) const;

 private:
  std::array<std::array<float, kColumns>, kRows> costs_{};
};

/// What a camera sees of everything finite in a scene, each cell at the cost 1.
ScreenCover find_cover(const Scene& scene, const Camera& camera, double aspect_ratio);

/// The corner of the window where a panel of this size costs least, in this order: the upper right one, the lower
/// right, the lower left, the upper left. `margin` is kept from the edges.
WindowArea choose_corner(const ScreenCover& cover, const dvec2& size, const dvec2& margin);

}  // namespace promin::app
