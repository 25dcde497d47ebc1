// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/window.h"

// Vulkan's header comes before GLFW's, which then declares its functions for Vulkan.
#include <vulkan/vulkan.h>

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "promin/error.h"
#include "view/panel/screen_area.h"

namespace promin::app {
namespace {

/// Largest movement of the pointer during a click, in screen coordinates. A larger movement is a drag.
constexpr double kClickSlack = 3.0;
/// The longest time between two clicks of a double click, in seconds.
constexpr double kDoubleClickTime = 0.3;

[[noreturn]] void refuse(const std::string& what) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw DeviceError({"window.display", what + (reason == nullptr ? "" : " (" + std::string(reason) + ")"), "",
                     "use promin render, which needs no window"});
}

/// Returns the monitor that shows most of the window; null if there is none.
GLFWmonitor* find_monitor(GLFWwindow* window) {
  if (GLFWmonitor* full_screen = glfwGetWindowMonitor(window); full_screen != nullptr) return full_screen;
  ScreenArea place;
  glfwGetWindowPos(window, &place.x, &place.y);
  glfwGetWindowSize(window, &place.width, &place.height);
  int count = 0;
  GLFWmonitor* const* monitors = glfwGetMonitors(&count);
  std::vector<ScreenArea> areas;
  for (int i = 0; i < count; ++i) {
    ScreenArea& area = areas.emplace_back();
    glfwGetMonitorPos(monitors[i], &area.x, &area.y);
    if (const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]); mode != nullptr) {
      area.width = mode->width;
      area.height = mode->height;
    }
  }
  return areas.empty() ? nullptr : monitors[find_display(areas, place)];
}

/// Returns the CPU seconds of this thread.
double work_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

#ifdef GLFW_PLATFORM
/// Returns whether environment variables name a Wayland compositor. If none did, libwayland would print a message.
bool could_have_wayland() {
  const auto is_path = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && value[0] == '/';
  };
  return std::getenv("WAYLAND_SOCKET") != nullptr || is_path("WAYLAND_DISPLAY") || is_path("XDG_RUNTIME_DIR");
}
#endif

/// Chooses the platform, because GLFW from 3.4 on first tries to connect to a Wayland compositor.
void choose_platform() {
#ifdef GLFW_PLATFORM
  if (!could_have_wayland() && glfwPlatformSupported(GLFW_PLATFORM_X11) == GLFW_TRUE) {
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
  }
#endif
}

}  // namespace

/// GLFW's C callbacks, which call functions of the window.
struct Window::Callbacks {
  static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

  static void set(GLFWwindow* window) {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) { of(w).on_key(key, action); });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
      of(w).on_button(button, action, modifiers);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).on_pointer({x, y}); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { of(w).on_wheel(y); });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
      of(w).dropped_.insert(of(w).dropped_.end(), paths, paths + count);
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int is_focused) {
      of(w).is_active_ = true;
      if (is_focused == GLFW_FALSE) of(w).release();
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).is_active_ = true; });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).change_place(); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { of(w).change_place(); });
    glfwSetWindowIconifyCallback(window, [](GLFWwindow* w, int is_minimised) {
      of(w).is_minimised_ = is_minimised != GLFW_FALSE;
      of(w).change_place();
    });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { of(w).change_place(); });
  }
};

Window::Window(const uvec2& size, const std::string& title) : first_size_(size) {
  choose_platform();
  if (glfwInit() == GLFW_FALSE) refuse("no display");
  if (glfwVulkanSupported() == GLFW_FALSE) {
    glfwTerminate();
    throw DeviceError({"device.loader.missing", "the Vulkan loader is missing", "",
                       "install libvulkan1 and a driver such as mesa-vulkan-drivers"});
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(static_cast<int>(size.x), static_cast<int>(size.y), title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    glfwTerminate();
    throw DeviceError(
        {"window.display", "the display cannot open a window", "", "use promin render, which needs no window"});
  }
  glfwSetWindowUserPointer(window_, this);
  Callbacks::set(window_);
  ask_display();
  last_wait_s_ = now();
  last_wait_work_s_ = work_seconds();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

gpu::Presentation Window::presentation() const {
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr) refuse("Vulkan has no surfaces");
  return {{names, names + count}, [window = window_](VkInstance instance) {
            VkSurfaceKHR surface = VK_NULL_HANDLE;
            if (glfwCreateWindowSurface(instance, window, nullptr, &surface) != VK_SUCCESS) refuse("no surface");
            return surface;
          }};
}

void Window::ask_display() {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  framebuffer_size_ = uvec2(width, height);
  int units = 0;
  glfwGetWindowSize(window_, &units, nullptr);
  float scale = 1.0F;
  glfwGetWindowContentScale(window_, &scale, nullptr);
  const double ratio = units > 0 && width > 0 ? static_cast<double>(width) / units : 1.0;
  overlay_scale_ = {scale > 0.0F ? static_cast<double>(scale) : 1.0, ratio};
}

double Window::refresh_interval_ms() const {
  constexpr int kUsualRate = 60;
  GLFWmonitor* monitor = find_monitor(window_);
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  const int rate = mode == nullptr || mode->refreshRate <= 0 ? kUsualRate : mode->refreshRate;
  return 1e3 / rate;
}

double Window::now() {
  return glfwGetTime();
}

void Window::wait(double seconds) {
  longest_turn_s_ = std::max(longest_turn_s_, now() - last_wait_s_);
  longest_work_s_ = std::max(longest_work_s_, work_seconds() - last_wait_work_s_);
  glfwWaitEventsTimeout(seconds);
  last_wait_s_ = now();
  last_wait_work_s_ = work_seconds();
}

bool Window::should_close() const {
  return glfwWindowShouldClose(window_) != 0;
}

bool Window::wants_to_close() const {
  return should_close() || std::find(presses_.begin(), presses_.end(), Press::kQuit) != presses_.end();
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::resize(const uvec2& size) {
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window_, &width, &height);
  if (size == first_size_ || uvec2(width, height) != first_size_) return;
  glfwSetWindowSize(window_, static_cast<int>(size.x), static_cast<int>(size.y));
}

void Window::hide() {
  glfwHideWindow(window_);
  glfwPollEvents();
}

bool Window::is_fullscreen() const {
  return glfwGetWindowMonitor(window_) != nullptr;
}

void Window::copy(const std::string& text) const {
  glfwSetClipboardString(window_, text.c_str());
}

void Window::toggle_fullscreen() {
  if (is_fullscreen()) {
    glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3], GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = find_monitor(window_);
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
  glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::vector<Press> Window::take_presses() {
  return std::exchange(presses_, {});
}

std::vector<dvec2> Window::take_clicks() {
  if (click_ && now() - click_time_s_ > kDoubleClickTime) clicks_.push_back(*std::exchange(click_, std::nullopt));
  return std::exchange(clicks_, {});
}

Window::Buttons Window::take_buttons() {
  Buttons down = std::exchange(went_down_, {});
  for (size_t i = 0; i < down.size(); ++i) down[i] = down[i] || buttons_[i];
  return down;
}

bool Window::take_activity() {
  return std::exchange(is_active_, false);
}

void Window::set_overlay_wants(bool keys, bool pointer) {
  wants_keys_ = keys;
  wants_pointer_ = pointer;
  if (std::exchange(is_press_judged_, true) || !pointer) return;
  // The click was on the overlay, which did not know the pointer's position yet.
  drag_ = Drag::kNone;
  click_.reset();
}

void Window::on_key(int key, int action) {
  is_active_ = true;
  if (action == GLFW_PRESS) ++key_count_;
  for (const KeyBinding& binding : key_bindings()) {
    if (binding.key != key) continue;
    // A key that was pressed before the overlay took the keys must still be released.
    if (binding.hold && (action == GLFW_RELEASE || !wants_keys_)) {
      motion_.set(*binding.hold, action != GLFW_RELEASE, now());
    }
    if (binding.press && action == GLFW_PRESS && !wants_keys_) presses_.push_back(*binding.press);
  }
}

void Window::on_button(int button, int action, int modifiers) {
  is_active_ = true;
  const bool is_down = action == GLFW_PRESS;
  const auto number = static_cast<size_t>(button);
  if (number < buttons_.size()) {
    buttons_[number] = is_down;
    went_down_[number] = went_down_[number] || is_down;
  }
  if (is_down && wants_pointer_ && !is_captured_) return;
  // A captured pointer has no position in the window.
  if (is_captured_) {
    if (is_down && button == GLFW_MOUSE_BUTTON_RIGHT) capture_pointer(false);
    return;
  }
  if (is_down) {
    is_press_judged_ = false;
    const Drag left = (modifiers & GLFW_MOD_SHIFT) == 0 ? Drag::kOrbit : Drag::kLight;
    drag_ = button == GLFW_MOUSE_BUTTON_LEFT ? left : Drag::kPan;
    is_click_ = true;
    drag_start_ = pointer_;
  } else if (std::exchange(drag_, Drag::kNone) != Drag::kNone && is_click_) {
    if (button == GLFW_MOUSE_BUTTON_LEFT) on_click();
    if (button == GLFW_MOUSE_BUTTON_RIGHT) capture_pointer(true);
  }
}

void Window::on_click() {
  const dvec2 place = pixel_ratio() * pointer_;
  if (click_ && now() - click_time_s_ <= kDoubleClickTime) {
    click_.reset();
    double_clicks_.push_back(place);
    return;
  }
  click_ = place;
  click_time_s_ = now();
}

void Window::on_wheel(double steps) {
  is_active_ = true;
  if (!wants_pointer_) motion_.zoom(steps);
}

void Window::on_pointer(const dvec2& place) {
  is_active_ = true;
  dvec2 way = place - std::exchange(pointer_, place);
  // A drag moves the scene with the pointer; a captured pointer turns the camera.
  if (is_captured_) return motion_.turn(-pixel_ratio() * way);
  if (drag_ == Drag::kNone) return;
  if (is_click_) {
    way = place - drag_start_;
    if (glm::length(way) <= kClickSlack) return;
    is_click_ = false;
  }
  if (drag_ == Drag::kOrbit) return motion_.orbit(pixel_ratio() * way);
  if (drag_ == Drag::kLight) return motion_.turn_light(pixel_ratio() * way.x);
  motion_.pan(pixel_ratio() * way);
}

void Window::change_place() {
  ask_display();
  is_active_ = true;
  may_have_moved_ = true;
}

void Window::release() {
  motion_.release_all(now());
  buttons_ = {};
  drag_ = Drag::kNone;
  capture_pointer(false);
}

void Window::capture_pointer(bool is_captured) {
  if (is_captured == is_captured_) return;
  is_captured_ = is_captured;
  drag_ = Drag::kNone;
  glfwSetInputMode(window_, GLFW_CURSOR, is_captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  glfwGetCursorPos(window_, &pointer_.x, &pointer_.y);
}

}  // namespace promin::app
