// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/camera.h"
#include "promin/display.h"
#include "view/panel/pixel_query.h"
#include "view/panel/screen_cover.h"

namespace promin::app {

/// A panel that says where a pixel's color comes from, as a tree of its rays with colors as they are displayed. It is
/// as large as its text where the window has room, and stands in the corner of the window where it hides least of the
/// scene, of the pixel's rays and of the other panel.
class ExplanationPanel {
 public:
  void open(ExplainedPixel explained);
  void close() { explained_.reset(); }
  bool is_open() const { return explained_.has_value(); }

  /// Shows it while it is open, between ImguiRenderer's begin_frame and end_frame, and draws the rays into the picture
  /// as the camera sees them. `other_panel` is the area that the overlay takes, if it is shown. The user may close it.
  void show(const Camera& camera, const DisplayTransform& display, const std::optional<WindowArea>& other_panel);

 private:
  /// The size of its text is known a frame after it has changed.
  static constexpr int kFramesToPlace = 2;

  std::optional<ExplainedPixel> explained_;
  /// How many more frames move it to its corner. The user may move it later.
  int frames_to_place_ = 0;
  // The size of the window and its own, in the interface's units.
  dvec2 window_{0.0};
  dvec2 size_{0.0};
};

}  // namespace promin::app
