// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "console.h"
#include "deferred_signals.h"
#include "run_stats.h"
#include "trace/progressive_picture.h"
#include "view/camera_control.h"
#include "view/describe_command.h"
#include "view/display_pass.h"
#include "view/flight.h"
#include "view/frame_queue.h"
#include "view/imgui_renderer.h"
#include "view/overlay.h"
#include "view/pixel_query.h"
#include "view/scene_preparer.h"
#include "view/screenshot.h"
#include "view/window.h"

namespace promin::app {

/// The options that a viewer starts with.
struct ViewerStart {
  std::filesystem::path file;
  SceneChoice choice;
  LookOptions look;
  EnvironmentOptions environment;
  /// LoadOptions::material_variant.
  std::string variant;
  /// LoadOptions::root.
  std::filesystem::path root;
  View view;
  /// Of pictures at rest that show light; what hangs on how they are shown follows from the scene.
  ErrorTarget error_target;
  std::optional<std::string> present_mode;
  /// None: the display's refresh interval where the device keeps up with it, else kCpuTargetMs.
  std::optional<double> target_ms;
  /// The scale, as ProgressivePicture::fix_scale takes it.
  std::optional<double> scale;

  /// The pictures of a flight to play, and whether the window stays open after it.
  std::optional<PathPictures> replay;
  bool stays_open = false;
  /// The file for the camera's flight, which is written when the window closes.
  std::optional<std::filesystem::path> record;

  static constexpr double kCpuTargetMs = 100.0;
};

/// The window's program: it takes input, records frames and shows them, until the user quits.
class Viewer {
 public:
  /// Throws RunError, vk::SystemError.
  Viewer(Window& window, const gpu::Device& device, const Console& console, ScenePreparer& preparer,
         ReadyPicture picture, ViewerStart start, RunStats stats);
  ~Viewer();

  /// SIGINT, SIGTERM and SIGHUP end it as the user does, and the program when what was recorded is written. Throws
  /// RunError where the flight cannot be written, vk::SystemError.
  void run();

 private:
  void show_frames(const DeferredSignals& signals);
  void handle_input();
  void handle_press(Press press);
  void move_camera(Frame& frame);
  /// Keeps all cameras where they are in the world, when a scene has another center.
  void move_cameras(const dvec3& offset);
  /// Adds the camera to the flight that is recorded, if one is.
  void keep_camera();
  bool is_replaying() const { return replay_ && has_replay_started_; }
  /// Whether the next picture of a replay is due.
  bool is_picture_due() const;
  /// Begins the replay when its first camera is shown, and ends it.
  void update_replay();
  /// Reports what has become of screenshots.
  void update_screenshot();
  /// Takes over a picture that is ready, and asks for those that changed switches and files need.
  void update_picture();
  void show_picture(ReadyPicture ready);
  /// Reports the answers to questions about pixels.
  void update_answers();
  RenderMode asked_mode() const { return {switches_.debug_view, switches_.has_shadows}; }
  /// Whether a picture in another mode than the one shown is being made.
  bool awaits_mode() const;
  /// The work that goes on beside the picture, in words.
  std::string describe_awaited() const;
  /// Fits everything to the window. False while it has no pixels.
  bool fit_window();
  /// Fits the picture to the window's images.
  void fit_picture();
  void finish_frames();
  void take_finished(const FinishedFrame& finished);
  bool has_work() const;
  void record(Frame& frame);
  void record_tracing(Frame& frame);
  void record_display(const Frame& frame);
  void build_overlay();
  /// Shows what has changed beside the picture.
  void draw_again() { frames_to_draw_ = kSettlingFrames; }
  void report(const std::string& text);
  void report_failure(const std::string& text);
  /// What describe_command needs for the command that gives a view's picture.
  DescribedScene described_scene(const View& view) const;
  /// How the picture's light is shown.
  DisplayTransform display() const;
  View current_view() const;
  /// The view that is shown, with its samples, where it is complete; else the current one.
  View reproducible_view() const;

  /// ImGui settles its windows within this many frames.
  static constexpr int kSettlingFrames = 3;

  Window& window_;
  const gpu::Device& device_;
  const Console& console_;
  ScenePreparer& preparer_;
  /// What the window was opened with.
  const ViewerStart start_;
  RunStats stats_;
  /// Whether the target is the refresh interval of the display that the window is on.
  bool follows_display_;
  double target_ms_;

  std::shared_ptr<const ShownScene> scene_;
  /// The mode of the picture.
  RenderMode mode_;
  Switches switches_;
  PixelQuery query_;
  /// Whether an orbit begins when its center is found.
  bool wants_orbit_ = false;
  CameraControl control_;
  std::vector<Camera> bookmarks_;
  std::optional<FlightReplay> replay_;
  bool has_replay_started_ = false;
  FlightRecorder recorder_;

  Swapchain swapchain_;
  /// The size that the swapchain was made for; 0 before it is.
  uvec2 asked_size_{0};
  DisplayPass display_;
  std::unique_ptr<ImguiRenderer> imgui_;
  FrameQueue frames_;
  std::optional<ProgressivePicture> picture_;
  /// The value of ProgressivePicture::shown_count when a picture was encoded last.
  uint64_t encoded_count_ = 0;
  Screenshot screenshot_;
  bool wants_screenshot_ = false;

  FrameStatistics statistics_;
  std::string message_;
  bool is_failure_ = false;
  /// Empty where no text is shown.
  PixelText explanation_;
  bool has_overlay_ = true;
  bool has_help_ = false;
  bool is_quitting_ = false;
  /// The number of frames to draw although there is nothing to trace, because the overlay answers to events.
  int frames_to_draw_ = 0;
};

}  // namespace promin::app
