// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "view/keys.h"
#include "view/overlay_scale.h"

struct GLFWwindow;

namespace promin::app {

/// A window of the desktop and what its user does with keys and pointer. One at a time, on the main thread.
class Window {
 public:
  /// `size` is in screen coordinates. Throws DeviceError where there is no display.
  Window(const uvec2& size, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// The surface that a device needs to present here; valid as long as the window.
  gpu::Presentation presentation() const;
  GLFWwindow* handle() const { return window_; }

  /// The size in pixels; 0 while minimised.
  uvec2 framebuffer_size() const { return is_minimised_ ? uvec2(0) : framebuffer_size_; }
  /// The number of pixels of the framebuffer in a unit of screen coordinates.
  double pixel_ratio() const { return overlay_scale_.pixel_ratio; }
  /// The scale that the overlay is to have.
  const OverlayScale& overlay_scale() const { return overlay_scale_; }
  /// The refresh interval of the display that most of the window is on, in milliseconds.
  double refresh_interval_ms() const;
  /// The time in seconds, by a clock of the window.
  static double now();

  /// Takes events in, and waits until one comes, for at most so many seconds.
  void wait(double seconds);
  /// The longest time from one wait() to the next, in milliseconds: no event has waited longer.
  double longest_turn_ms() const { return 1e3 * longest_turn_s_; }
  /// The most time of a processor that was taken from one wait() to the next, in milliseconds: what the longest turn
  /// would be on a machine that does nothing else.
  double longest_work_ms() const { return 1e3 * longest_work_s_; }
  /// How many times keys have gone down.
  uint64_t key_count() const { return key_count_; }

  bool should_close() const;
  /// Whether the window was asked to close, or the key to quit is among the presses that are to be taken.
  bool wants_to_close() const;
  void set_title(const std::string& title);
  /// Makes it as large, in screen coordinates, where the user has left it as it was made.
  void resize(const uvec2& size);
  void toggle_fullscreen();
  bool is_fullscreen() const;
  /// Puts a text on the clipboard.
  void copy(const std::string& text) const;
  /// Takes it off the display at once.
  void hide();

  // These return what happened since they were last called.
  Motion take_motion() { return motion_.take(now()); }
  std::vector<Press> take_presses();
  /// Places where the pointer was clicked once without being dragged, in pixels; a while after, as a second click might
  /// follow.
  std::vector<dvec2> take_clicks();
  /// Where it was clicked twice.
  std::vector<dvec2> take_double_clicks() { return std::exchange(double_clicks_, {}); }
  /// Files that were dropped.
  std::vector<std::string> take_dropped() { return std::exchange(dropped_, {}); }
  /// Whether the window may be on another display; at first it may.
  bool take_change_of_place() { return std::exchange(may_have_moved_, false); }
  /// Whether anything happened at all.
  bool take_activity();

  /// Whether a key is down that moves the camera.
  bool is_moving() const { return motion_.is_held(); }
  /// Whether the pointer has moved the camera since the last take_motion().
  bool has_turned() const { return motion_.has_any(); }

  /// Where the pointer is, in screen coordinates; nowhere while it turns the camera without a button.
  std::optional<dvec2> pointer() const { return is_captured_ ? std::nullopt : std::optional(pointer_); }
  /// Which of its first buttons are down, or went down since the last call.
  using Buttons = std::array<bool, 3>;
  Buttons take_buttons();

  /// Whether the overlay wants keys and pointer for itself; to be called after each of its frames.
  void set_overlay_wants(bool keys, bool pointer);

 private:
  struct Callbacks;

  void on_key(int key, int action);
  void on_button(int button, int action, int modifiers);
  void on_wheel(double steps);
  void on_click();
  void on_pointer(const dvec2& place);
  void change_place();
  /// Asks the display, which takes a while, for what changes with the place.
  void ask_display();
  void release();
  void capture_pointer(bool is_captured);

  GLFWwindow* window_ = nullptr;
  uvec2 first_size_;
  MotionSum motion_;
  std::vector<Press> presses_;
  std::vector<dvec2> clicks_;
  std::vector<dvec2> double_clicks_;
  /// A click that may be the first of two, and when it was.
  std::optional<dvec2> click_;
  double click_time_s_ = 0.0;
  std::vector<std::string> dropped_;
  bool is_active_ = true;
  bool may_have_moved_ = true;
  bool is_minimised_ = false;
  uvec2 framebuffer_size_{0};
  OverlayScale overlay_scale_;
  double last_wait_s_ = 0.0;
  double longest_turn_s_ = 0.0;
  double last_wait_work_s_ = 0.0;
  double longest_work_s_ = 0.0;
  uint64_t key_count_ = 0;
  bool wants_keys_ = false;
  bool wants_pointer_ = false;
  /// What the pointer does while a button is down.
  enum class Drag { kNone, kOrbit, kPan, kLight };
  Drag drag_ = Drag::kNone;
  /// Whether the pointer has not wandered since the button went down.
  bool is_click_ = false;
  /// Whether the overlay has had a frame since a button went down.
  bool is_press_judged_ = true;
  bool is_captured_ = false;
  dvec2 pointer_{0.0};
  Buttons buttons_{};
  Buttons went_down_{};
  dvec2 drag_start_{0.0};
  /// Place and size before full screen, in screen coordinates.
  int windowed_[4] = {0, 0, 0, 0};
};

}  // namespace promin::app
