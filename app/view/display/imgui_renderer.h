// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/display/swapchain.h"
#include "view/display/window.h"

namespace promin::app {

/// Whether Escape goes down in this frame of ImGui.
bool is_escape_pressed();

/// Dear ImGui for a window: its context and its backends of GLFW and Vulkan. The one place that knows its versions.
class ImguiRenderer {
 public:
  /// Throws vk::SystemError.
  ImguiRenderer(const gpu::Device& device, Window& window, const Swapchain& swapchain);
  ~ImguiRenderer();
  ImguiRenderer(const ImguiRenderer&) = delete;
  ImguiRenderer& operator=(const ImguiRenderer&) = delete;

  /// Sets the scale of everything that is drawn; the device must be idle.
  void set_scale(const OverlayScale& scale);
  const OverlayScale& scale() const { return scale_; }

  /// Call functions of ImGui between these two.
  void begin_frame();
  void end_frame();
  /// Records drawing ImGui's content within a render pass of the swapchain.
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
