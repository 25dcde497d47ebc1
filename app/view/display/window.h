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
#include "view/panel/overlay_scale.h"

struct GLFWwindow;

namespace promin::app {

/// A window of the desktop and its keyboard and pointer input. Only one may exist, on the main thread.
class Window {
 public:
  /// Opens a window. `size` is in screen coordinates. Throws DeviceError if there is no display.
  Window(const uvec2& size, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Returns the data with which a device creates the window's surface. It is valid as long as the window exists.
  gpu::Presentation presentation() const;
  GLFWwindow* handle() const { return window_; }

  /// Returns the size in pixels; 0 while minimised.
  uvec2 framebuffer_size() const { return is_minimised_ ? uvec2(0) : framebuffer_size_; }
  /// Returns the number of pixels of the framebuffer per unit of screen coordinates.
  double pixel_ratio() const { return overlay_scale_.pixel_ratio; }
  /// Returns the scale for the overlay.
  const OverlayScale& overlay_scale() const { return overlay_scale_; }
  /// Returns the refresh interval, in milliseconds, of the display that shows most of the window.
  double refresh_interval_ms() const;
  /// Returns the time in seconds, by the window's clock.
  static double now();

  /// Handles events, and waits for one for at most this number of seconds.
  void wait(double seconds);
  /// Returns the longest time from one wait() to the next, in milliseconds. No event has waited longer.
  double longest_turn_ms() const { return 1e3 * longest_turn_s_; }
  /// Returns the largest CPU time from one wait() to the next, in milliseconds. On an otherwise idle machine it is the
  /// longest turn.
  double longest_work_ms() const { return 1e3 * longest_work_s_; }
  /// Returns the number of key presses.
  uint64_t key_count() const { return key_count_; }

  bool should_close() const;
  /// Returns whether the window was asked to close, or the key to quit is among the presses that were not taken yet.
  bool wants_to_close() const;
  void set_title(const std::string& title);
  /// Sets the size in screen coordinates, unless the user has changed it.
  void resize(const uvec2& size);
  void toggle_fullscreen();
  bool is_fullscreen() const;
  /// Puts a text on the clipboard.
  void copy(const std::string& text) const;
  /// Hides the window immediately.
  void hide();

  // The following functions return the events since their last call.
  Motion take_motion() { return motion_.take(now()); }
  std::vector<Press> take_presses();
  /// Returns positions of single clicks without dragging, in pixels, after a delay in which a second click could
  /// follow.
  std::vector<dvec2> take_clicks();
  /// Returns positions of double clicks.
  std::vector<dvec2> take_double_clicks() { return std::exchange(double_clicks_, {}); }
  /// Returns files that were dropped on the window.
  std::vector<std::string> take_dropped() { return std::exchange(dropped_, {}); }
  /// Returns whether the window may have moved to another display. The first call returns true.
  bool take_change_of_place() { return std::exchange(may_have_moved_, false); }
  /// Returns whether there was any event.
  bool take_activity();

  /// Returns whether a key that moves the camera is down.
  bool is_moving() const { return motion_.is_held(); }
  /// Returns whether the pointer has moved the camera since the last take_motion().
  bool has_turned() const { return motion_.has_any(); }

  /// Returns the pointer's position in screen coordinates; empty while it turns the camera without a button.
  std::optional<dvec2> pointer() const { return is_captured_ ? std::nullopt : std::optional(pointer_); }
  /// The state of the first three buttons: whether each is down or went down since the last call.
  using Buttons = std::array<bool, 3>;
  Buttons take_buttons();

  /// Sets whether the overlay uses keys and pointer itself. To be called after each of its frames.
  void set_overlay_wants(bool keys, bool pointer);

 private:
  struct Callbacks;

  void on_key(int key, int action);
  void on_button(int button, int action, int modifiers);
  void on_wheel(double steps);
  void on_click();
  void on_pointer(const dvec2& place);
  void change_place();
  /// Queries the display for values that depend on the window's position. This takes some time.
  void ask_display();
  void release();
  void capture_pointer(bool is_captured);

  GLFWwindow* window_ = nullptr;
  uvec2 first_size_;
  MotionSum motion_;
  std::vector<Press> presses_;
  std::vector<dvec2> clicks_;
  std::vector<dvec2> double_clicks_;
  /// A click that may be the first of a double click, and its time.
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
  /// The effect of moving the pointer while a button is down.
  enum class Drag { kNone, kOrbit, kPan, kLight };
  Drag drag_ = Drag::kNone;
  /// True if the pointer has not moved since the button went down.
  bool is_click_ = false;
  /// True if the overlay has drawn a frame since a button went down.
  bool is_press_judged_ = true;
  bool is_captured_ = false;
  dvec2 pointer_{0.0};
  Buttons buttons_{};
  Buttons went_down_{};
  dvec2 drag_start_{0.0};
  /// Position and size before full screen, in screen coordinates.
  int windowed_[4] = {0, 0, 0, 0};
};

}  // namespace promin::app
