// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::app {

/// How large the overlay is on a display of many pixels an inch.
struct OverlayScale {
  /// Pixels for one of an ordinary display.
  double content = 1.0;
  /// Pixels for a unit of the window's coordinates, in which the overlay is laid out.
  double pixel_ratio = 1.0;

  bool operator==(const OverlayScale&) const = default;
};

}  // namespace promin::app
