// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "console.h"
#include "run_stats.h"
#include "view/camera_control.h"
#include "view/describe_command.h"
#include "view/display_pass.h"
#include "view/flight.h"
#include "view/frame_queue.h"
#include "view/imgui_renderer.h"
#include "view/live_picture.h"
#include "view/overlay.h"
#include "view/screenshot.h"
#include "view/window.h"

namespace promin::app {

/// What a viewer starts with.
struct ViewerStart {
  std::filesystem::path file;
  LoadedScene scene;
  SceneChoice choice;
  bool has_shadows = true;
  View view;
  std::optional<std::string> present_mode;
  /// None: the display's refresh interval on a GPU, kCpuTargetMs on a CPU device.
  std::optional<double> target_ms;

  /// What of a flight to play, and whether the window stays open after it.
  std::optional<PathPictures> replay;
  bool stays_open = false;
  /// Where the camera's flight goes when the window closes.
  std::optional<std::filesystem::path> record;

  static constexpr double kCpuTargetMs = 100.0;
};

/// The window's program: takes input in, records frames, shows them, until the user quits.
class Viewer {
 public:
  /// Throws RunError, vk::SystemError.
  Viewer(Window& window, const gpu::Device& device, const Console& console, ViewerStart start, RunStats stats);
  ~Viewer();

  /// Throws RunError where the flight cannot be written, vk::SystemError.
  void run();

 private:
  void handle_input();
  void handle_press(Press press);
  void move_camera(Frame& frame);
  /// Takes the camera down for the flight that is recorded, if one is.
  void keep_camera();
  bool is_replaying() const { return replay_ && has_replay_started_; }
  /// Of a replay.
  bool is_picture_due() const;
  /// Begins the replay when its first camera is shown, and ends it.
  void update_replay();
  /// Says what has become of screenshots.
  void update_screenshot();
  /// Starts what changed switches ask for, takes in what has been loaded.
  void update_scene();
  void show_scene(const LoadedScene& loaded);
  /// A picture of a scene with the pipeline that the switches ask for.
  void make_picture(std::shared_ptr<const DeviceScene> scene, FeatureMask scene_features);
  /// Of a scene with its shadows on or off.
  FeatureMask light_features(FeatureMask scene_features) const;
  void explain(const uvec2& pixel);
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
  void report(const std::string& text);
  void report_failure(const std::string& text);
  /// Of the command that gives a view's picture.
  DescribedScene described_scene(const View& view) const;
  View current_view() const;
  /// The view that is shown, with its samples, where it is complete; else the current one.
  View reproducible_view() const;

  Window& window_;
  const gpu::Device& device_;
  const Console& console_;
  std::filesystem::path file_;
  RunStats stats_;
  double target_ms_;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const DeviceScene> device_scene_;
  PrimitiveNumbers numbers_;
  FeatureMask scene_features_ = 0;
  Switches switches_;
  SceneChoice asked_choice_;
  /// What of scene_ is on the device.
  SceneChoice shown_choice_;
  /// Of the picture's pipeline.
  FeatureMask features_ = 0;
  SceneLoader loader_;
  double next_file_check_ = 0.0;
  CameraControl control_;
  std::vector<Camera> bookmarks_;
  std::optional<FlightReplay> replay_;
  bool has_replay_started_ = false;
  bool stays_open_;
  std::optional<std::filesystem::path> record_file_;
  FlightRecorder recorder_;

  Swapchain swapchain_;
  /// That the swapchain was made for; 0 before it is.
  uvec2 asked_size_{0};
  DisplayPass display_;
  std::unique_ptr<ImguiRenderer> imgui_;
  FrameQueue frames_;
  std::optional<LivePicture> picture_;
  /// LivePicture::shown_count of what was encoded last.
  uint64_t encoded_count_ = 0;
  Screenshot screenshot_;
  bool wants_screenshot_ = false;

  FrameStatistics statistics_;
  std::string message_;
  bool is_failure_ = false;
  /// Of a pixel; empty where none is shown.
  std::string explanation_title_;
  std::string explanation_;
  bool has_overlay_ = true;
  bool has_help_ = false;
  bool is_quitting_ = false;
  /// Frames to draw although there is nothing to trace: the overlay answers to events.
  int frames_to_draw_ = 0;
};

}  // namespace promin::app
