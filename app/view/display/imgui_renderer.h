// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/display/swapchain.h"
#include "view/display/window.h"

namespace promin::app {

/// Returns whether the Escape key is pressed in this frame of ImGui.
bool is_escape_pressed();

/// Dear ImGui for a window: its context and its backends for GLFW and Vulkan. No other code depends on ImGui's version.
class ImguiRenderer {
 public:
  /// Creates ImGui's context and backends. Throws vk::SystemError.
  ImguiRenderer(const gpu::Device& device, Window& window, const Swapchain& swapchain);
  ~ImguiRenderer();
  ImguiRenderer(const ImguiRenderer&) = delete;
  ImguiRenderer& operator=(const ImguiRenderer&) = delete;

  /// Sets the scale of everything that is drawn; the device must be idle.
  void set_scale(const OverlayScale& scale);
  const OverlayScale& scale() const { return scale_; }

  /// begin_frame() and end_frame() enclose all calls of ImGui in a frame.
  void begin_frame();
  void end_frame();
  /// Records the drawing of ImGui's content within a render pass of the swapchain.
  void record(const vk::raii::CommandBuffer& commands) const;

  bool wants_keys() const;
  bool wants_pointer() const;

 private:
  void start_backend();

  const gpu::Device* device_;
  Window* window_;
  double last_frame_s_;
  const Swapchain* swapchain_;
  OverlayScale scale_;
  vk::raii::DescriptorPool pool_{nullptr};
};

}  // namespace promin::app
