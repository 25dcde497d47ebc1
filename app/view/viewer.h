// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "output/console.h"
#include "output/deferred_signals.h"
#include "promin/framing.h"
#include "view/animation_clock.h"
#include "view/camera_control.h"
#include "view/display/display_pass.h"
#include "view/display/frame_queue.h"
#include "view/display/imgui_renderer.h"
#include "view/display/screenshot.h"
#include "view/display/window.h"
#include "view/flight.h"
#include "view/panel/describe_command.h"
#include "view/panel/overlay.h"
#include "view/panel/pixel_query.h"
#include "view/panel/show_explanation.h"
#include "view/scene/file_dialog.h"
#include "view/scene/open_scene.h"
#include "view/scene/scene_preparer.h"
#include "work/pictures/run_stats.h"

namespace promin::app {

/// Returns the title of a window that shows a file.
std::string title_of(const std::filesystem::path& file);

/// The options with which a viewer starts.
struct ViewerStart {
  std::filesystem::path file;
  OpenScene open;
  SceneChoice choice;
  LookOptions look;
  /// The up direction of the scene.
  vec3 up{0.0F, 1.0F, 0.0F};
  EnvironmentOptions environment;
  /// The error target for pictures that show light while the camera rests. Members that depend on the display are set
  /// from the scene.
  ErrorTarget error_target;
  std::optional<std::string> present_mode;
  /// Target time of a frame in milliseconds. If empty, it is the display's refresh interval if the device is fast
  /// enough, otherwise kCpuTargetMs.
  std::optional<double> target_ms;
  /// The scale of first pictures, in the form that ProgressivePicture::fix_scale() takes.
  std::optional<double> scale;
  /// True if the window stays open after a replay.
  bool stays_open = false;
  /// The file for recording the camera's flight. It is written when the window closes.
  std::optional<std::filesystem::path> record;

  static constexpr double kCpuTargetMs = 100.0;
};

/// The main loop of the window: it handles input, requests pictures and shows them until the user quits. Long work
/// never runs on the loop's thread. Other threads read scenes, build trees and compile kernels. Pictures are traced on
/// devices other than the one that draws.
class Viewer {
 public:
  /// `device` draws to the window. `opening` opens the scene. Throws RunError, vk::SystemError.
  Viewer(Window& window, std::shared_ptr<const gpu::Device> device, const Console& console, ViewerStart start,
         Background<OpenedScene> opening);
  ~Viewer();

  /// Runs until the user quits. SIGINT, SIGTERM and SIGHUP end the loop in the same way. The program ends after the
  /// recorded flight is written. Throws InputError if the scene is not valid, RunError if the flight cannot be written,
  /// and vk::SystemError.
  void run();
  /// Returns whether there is work that the destructor would wait for.
  bool is_busy() const;
  const RunStats& stats() const { return opened_.stats; }

 private:
  void show_frames(const DeferredSignals& signals);
  void handle_input();
  void handle_press(Press press);
  void handle_clicks();
  /// Carries out a key that plays the animation.
  void move_clock(Press press);
  void print_command();
  /// Returns the pixel of the full picture at a position in the window, which is given in the window's pixels.
  uvec2 pixel_at(const dvec2& place) const;
  /// Turns the camera to the point that a pixel shows, and orbits it, as soon as the point is known.
  void look_at(const View& view, const uvec2& pixel);
  /// Opens another scene.
  void open(const std::filesystem::path& file);
  /// Requests a file from the user, with a dialog of the desktop or in the panel.
  void ask_for_file(FileUse use);
  void take_file(FileUse use, const std::filesystem::path& file);
  /// Writes the picture to a file as soon as it is complete.
  void save(std::filesystem::path file);
  /// Frames the scene in the current direction, or from a side.
  void frame_from(std::optional<Framing> from);
  /// Moves the camera to another of the scene's cameras, `step` places further in their order.
  void show_camera(int step);
  void move_camera(bool is_of_flight);
  /// Keeps the world positions of all cameras if a scene has another center.
  void move_cameras(const dvec3& offset);
  /// Adds the camera to the flight being recorded, if any.
  void keep_camera();
  bool is_replaying() const { return replay_ && has_replay_started_; }
  /// Returns whether the next picture of a replay is due.
  bool is_picture_due() const;
  /// Starts the replay when its first camera is shown, and ends it.
  void update_replay();
  /// Reports finished and failed screenshots.
  void update_screenshot();
  /// Switches to a scene that has been opened.
  void update_opening();
  void show_scene(OpenedScene opened);
  /// Destroys pictures that are no longer needed, which may take some time.
  void dispose();
  /// Copies a changed environment to the devices, while nothing is traced there.
  void update_surroundings();
  /// Returns whether this is needed and the devices are not busy with long work.
  bool may_put_surroundings() const;
  /// Switches to a picture that is ready, and requests pictures for changed switches and files.
  void update_picture();
  void show_picture(ReadyPicture ready);
  /// Reports the answers to pixel queries.
  void update_answers();
  /// Returns whether only the first picture of a view is traced.
  bool holds_refinement() const { return switches_.is_paused || clock_.is_playing(); }
  /// Returns whether the next pose may replace the shown picture.
  bool has_shown_pose() const { return !clock_.is_playing() || !traced_ || traced_->picture().shown(); }
  /// Moves the clock, and logs how many poses it has shown when it stops, if verbose.
  void move_time(double now_s);
  RenderMode asked_mode() const { return {switches_.debug_view, switches_.has_shadows, switches_.integrator}; }
  PictureRequest request() const;
  /// Returns whether promin is making a picture in a mode that differs from the mode of the shown picture.
  bool awaits_mode() const;
  /// Returns a description of the current work in addition to the picture.
  std::string describe_awaited() const;
  /// Adapts everything to the window's size. Returns false while it has no pixels.
  bool fit_window();
  /// Handles finished frames, and begins the next.
  void trace();
  void take_finished(const FinishedFrame& finished);
  /// Logs the first time that a better kind of picture is shown, if verbose.
  void log_shown();
  bool has_tracing() const;
  void begin_frame();
  void record_screenshot(const vk::raii::CommandBuffer& commands);
  /// Draws the window if there is something new.
  void draw();
  void build_overlay();
  /// Requests drawing after a change other than the picture.
  void draw_again() { frames_to_draw_ = kSettlingFrames; }
  bool is_at_rest() const;
  void report(const std::string& text);
  void report_failure(const std::string& text);
  /// Returns the data from which describe_command makes the command for a view's picture.
  DescribedScene described_scene(const View& view) const;
  /// Returns the picture's display transform.
  DisplayTransform display() const;
  View current_view() const;
  View view_of_middle() const;
  /// Returns the shown view with its samples, if complete; else the current one.
  View reproducible_view() const;

  /// The successive kinds of pictures.
  enum class Shown { kNothing, kDraft, kWhole, kRefined };

  /// ImGui settles its windows within this many frames.
  static constexpr int kSettlingFrames = 3;

  Window& window_;
  std::shared_ptr<const gpu::Device> device_;
  const Console& console_;
  /// The options with which the window was opened.
  const ViewerStart start_;
  /// True if the target is the refresh interval of the display that the window is on.
  bool follows_display_;
  double target_ms_;

  /// The file of the scene that is being opened, or is open.
  std::filesystem::path file_;
  Background<OpenedScene> opening_;
  /// The open scene; it is empty before the first scene is open.
  OpenedScene opened_;
  std::unique_ptr<ScenePreparer> preparer_;
  std::shared_ptr<ShownScene> scene_;
  /// The mode of the picture.
  RenderMode mode_;
  bool is_draft_ = false;
  /// The current picture; null before the first one. Older pictures are destroyed in parallel.
  std::unique_ptr<TracedPicture> traced_;
  std::vector<std::unique_ptr<TracedPicture>> retired_;
  std::vector<std::future<void>> disposals_;
  Switches switches_;
  PixelQuery query_;
  /// The work that copies the environment to the devices. Its result is true.
  Background<bool> putting_;
  /// True if an orbit starts when its center is found.
  bool wants_orbit_ = false;
  /// True if the center is that of the picture. On a miss, the middle of the scene replaces it.
  bool is_of_middle_ = false;
  CameraControl control_{Camera(), Bounds(), vec3(0.0F, 1.0F, 0.0F)};
  AnimationClock clock_;
  /// The number of poses that were shown since the clock began to play, the number of those that reused a scene on the
  /// device, and the time in seconds of the first one. The time is empty while the clock stands.
  int played_poses_ = 0;
  int reused_scenes_ = 0;
  std::optional<double> playing_since_s_;
  Background<Camera> framing_;
  int camera_index_ = -1;
  std::vector<Camera> bookmarks_;
  std::optional<FlightReplay> replay_;
  bool has_replay_started_ = false;
  FlightRecorder recorder_;

  Swapchain swapchain_;
  /// The window size for which the swapchain was made; 0 before it is made.
  uvec2 asked_size_{0};
  DisplayPass display_;
  std::unique_ptr<ImguiRenderer> imgui_;
  FrameQueue frames_;
  Screenshot screenshot_;
  bool wants_screenshot_ = false;
  /// The file in which to save the picture; empty for a screenshot.
  std::optional<std::filesystem::path> saved_file_;
  /// The command that gives the picture being saved; empty if there is none.
  std::string saved_command_;
  FileDialog dialog_;
  std::optional<PathEntry> path_entry_;
  /// True if the command is printed as soon as there is a picture.
  bool wants_command_ = false;
  /// Called when the frame that copies a screenshot is finished.
  std::function<void(const FinishedFrame&)> on_copied_;

  FrameStatistics statistics_;
  Shown best_shown_ = Shown::kNothing;
  /// The work beside the picture as the overlay shows it.
  std::string shown_awaited_;
  std::string message_;
  bool is_failure_ = false;
  ExplanationPanel explanation_;
  bool has_overlay_ = true;
  bool has_help_ = false;
  bool is_quitting_ = false;
  /// The number of frames still to draw, because of a new picture or events in the overlay.
  int frames_to_draw_ = kSettlingFrames;
  float overlay_height_ = 0.0F;
  double next_draw_s_ = 0.0;
};

}  // namespace promin::app
