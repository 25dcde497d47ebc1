// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/camera.h"
#include "promin/display.h"
#include "view/panel/pixel_query.h"
#include "view/panel/screen_cover.h"

namespace promin::app {

/// A panel that explains a pixel's colour as a tree of its rays, with colours as they are displayed. It has the size of
/// its text if the window has space for it. It is placed in the corner of the window where it hides the least of the
/// scene, of the pixel's rays and of the other panel.
class ExplanationPanel {
 public:
  void open(ExplainedPixel explained);
  void close() { explained_.reset(); }
  bool is_open() const { return explained_.has_value(); }

  /// Shows the panel while it is open, and draws the rays into the picture as the camera sees them. To be called
  /// between ImguiRenderer's begin_frame() and end_frame(). `other_panel` is the area of the overlay if it is shown.
  /// The user may close the panel.
  void show(const Camera& camera, const DisplayTransform& display, const std::optional<WindowArea>& other_panel);

 private:
  /// Number of frames in which the panel is placed. The size of its text is known one frame after the text has changed.
  static constexpr int kFramesToPlace = 2;

  std::optional<ExplainedPixel> explained_;
  /// Number of further frames that move the panel to its corner. Later the user may move it.
  int frames_to_place_ = 0;
  // The sizes of the window and of the panel, in the interface's units.
  dvec2 window_{0.0};
  dvec2 size_{0.0};
};

}  // namespace promin::app
