// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

namespace promin::app {

/// A rectangle of the desktop, in screen coordinates.
struct ScreenArea {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Returns the display that shows most of the window; the first display if no display shows it.
inline size_t find_display(std::span<const ScreenArea> displays, const ScreenArea& window) {
  const auto shared = [&](const ScreenArea& display) {
    const int right = std::min(display.x + display.width, window.x + window.width);
    const int bottom = std::min(display.y + display.height, window.y + window.height);
    return static_cast<long long>(std::max(0, right - std::max(display.x, window.x))) *
           std::max(0, bottom - std::max(display.y, window.y));
  };
  const auto most = std::max_element(displays.begin(), displays.end(),
                                     [&](const ScreenArea& a, const ScreenArea& b) { return shared(a) < shared(b); });
  return static_cast<size_t>(most - displays.begin());
}

}  // namespace promin::app
