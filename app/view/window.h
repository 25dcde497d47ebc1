// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
  uvec2 framebuffer_size() const;
  /// The number of pixels of the framebuffer in a unit of screen coordinates.
  double pixel_ratio() const;
  /// The scale that the overlay is to have.
  OverlayScale overlay_scale() const;
  /// The refresh interval of the display that most of the window is on, in milliseconds.
  double refresh_interval_ms() const;
  /// The time in seconds, by a clock of the window.
  static double now();

  /// Takes events in without waiting, or waits until one comes, for at most so many seconds.
  void poll();
  void wait(double seconds);

  bool should_close() const;
  /// Whether the window was asked to close, or the key to quit is among the presses that are to be taken.
  bool wants_to_close() const;
  void set_title(const std::string& title);
  void toggle_fullscreen();

  // These return what happened since they were last called.
  Motion take_motion() { return motion_.take(now()); }
  std::vector<Press> take_presses();
  double take_wheel();
  /// Places where the pointer was clicked without being dragged, in pixels.
  std::vector<dvec2> take_clicks();
  /// Whether the window may be on another display; at first it may.
  bool take_change_of_place() { return std::exchange(may_have_moved_, false); }
  /// Whether anything happened at all.
  bool take_activity();

  /// Whether a key is down that moves the camera.
  bool is_moving() const { return motion_.is_held(); }

  /// Whether the overlay wants keys and pointer for itself just now.
  void set_overlay_wants(bool keys, bool pointer);

 private:
  struct Callbacks;

  void on_key(int key, int action);
  void on_button(int button, int action);
  void on_pointer(const dvec2& place);
  void change_place();
  void release();
  void capture_pointer(bool is_captured);

  GLFWwindow* window_ = nullptr;
  MotionSum motion_;
  std::vector<Press> presses_;
  std::vector<dvec2> clicks_;
  double wheel_ = 0.0;
  bool is_active_ = true;
  bool may_have_moved_ = true;
  bool wants_keys_ = false;
  bool wants_pointer_ = false;
  bool is_dragging_ = false;
  /// Whether the pointer has not wandered since the button went down.
  bool is_click_ = false;
  bool is_captured_ = false;
  dvec2 pointer_{0.0};
  dvec2 drag_start_{0.0};
  /// Place and size before full screen, in screen coordinates.
  int windowed_[4] = {0, 0, 0, 0};
};

}  // namespace promin::app
