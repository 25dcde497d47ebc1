// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "trace/film/progressive_picture.h"
#include "view/animation_clock.h"
#include "view/display/finished_frame.h"
#include "view/panel/overlay_scale.h"
#include "view/panel/screen_cover.h"
#include "view/scene/file_dialog.h"
#include "view/scene/scene_preparer.h"

namespace promin::app {

/// The recent cost of frames. The values are means, in which about the last tenth of a second has the largest weight.
class FrameStatistics {
 public:
  void add(const FinishedFrame& frame);

  double frame_ms() const { return frame_ms_; }
  const StageTimes& stages() const { return stages_; }
  /// Returns the rates of primary, shadow and reflection rays, in millions per second of tracing.
  const dvec3& mrays_per_s() const { return mrays_per_s_; }
  /// Returns the milliseconds of a frame's work that are not tracing.
  double overhead_ms() const { return stages_.display; }

 private:
  bool is_first_ = true;
  double frame_ms_ = 0.0;
  StageTimes stages_;
  dvec3 mrays_per_s_{0.0};
};

/// The choices that the user made, in the overlay or otherwise.
struct Switches {
  SceneChoice scene;
  Surroundings surroundings;
  uint32_t max_depth = View{}.max_depth;
  bool has_mirrors = true;
  bool has_shadows = true;
  DebugView debug_view = DebugView::kNone;
  Integrator integrator = Integrator::kWhitted;
  /// The exposure in stops; empty if the user has not chosen one, and the scene's own is used.
  std::optional<float> exposure_ev;
  /// The scale, in the form that ProgressivePicture::fix_scale() takes.
  std::optional<double> scale;
  bool is_paused = false;

  uint32_t effective_depth() const { return has_mirrors ? max_depth : 0; }
};

/// A file path that the user types if the desktop has no dialog.
struct PathEntry {
  FileUse use = FileUse::kOpen;
  std::array<char, 4096> text{};
  /// True if the entry has not been shown yet. It then gets the keyboard focus.
  bool is_new = true;
};

/// Further data that the overlay shows.
struct OverlayContent {
  const FrameStatistics* statistics = nullptr;
  /// The current picture; null before the first one.
  const ProgressivePicture* picture = nullptr;
  /// The current scene; null before it is read.
  const Scene* scene = nullptr;
  std::string device;
  double speed = 0.0;
  /// Exposure of the scene in stops.
  float exposure_ev = 0.0F;
  /// The colour of the scene's background, sRGB.
  vec3 background{0.0F};
  /// A description of the work in progress in addition to the picture; empty if there is none.
  std::string awaited;
  /// The last message. Failures are highlighted.
  std::string message;
  bool is_failure = false;
  std::vector<Camera> bookmarks;
  /// The clock of the scene's animations, which the user can change; null during a replay.
  AnimationClock* clock = nullptr;
  /// The path that the user is typing; null if there is none.
  PathEntry* entry = nullptr;
};

/// Returns two lines about a picture with an error target: the share of pixels whose claimed error is within
/// ShownPicture::wanted_error, the mean number of samples and the largest claimed error.
std::string describe_accuracy(const ShownPicture& shown, bool is_settled);

/// Returns the distance between a new panel and the window's edges, in the interface's units.
float overlay_margin();

/// Creates ImGui's fonts and sizes again. Must not be called within a frame.
void scale_overlay(const OverlayScale& scale);

/// The user's actions in the overlay, except switches.
struct OverlayAnswer {
  /// The camera that the user chose from the lists.
  std::optional<Camera> camera;
  /// The new speed of flying.
  std::optional<double> speed;
  /// The purpose for which the user requests a file.
  std::optional<FileUse> asked;
  /// True if the typed path is complete.
  bool has_typed = false;
  /// True if the user has cancelled the entry of the path.
  bool gives_up = false;
  /// The area of the overlay's panel.
  WindowArea area;
  /// The height of the panel's text, in the interface's units. The panel gets this height in the next frame.
  float height = 0.0F;
};

/// Shows the overlay, and lets the user change the switches. To be called between ImguiRenderer's begin_frame() and
/// end_frame().
OverlayAnswer show_overlay(const OverlayContent& content, Switches& switches);

/// Shows the actions of keys and pointer, at the right edge.
void show_help();
/// Returns whether there is space for the help beside the panel at the left edge.
bool has_room_beside_help();
}  // namespace promin::app
