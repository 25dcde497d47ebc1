// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::app {

/// The scale of the overlay, which is larger on displays with a high resolution.
struct OverlayScale {
  /// The number of pixels that correspond to one pixel of a display that does not scale.
  double content = 1.0;
  /// The number of pixels in a unit of the window's coordinates, in which the overlay is laid out.
  double pixel_ratio = 1.0;

  bool operator==(const OverlayScale&) const = default;
};

}  // namespace promin::app
