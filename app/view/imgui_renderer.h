// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/swapchain.h"
#include "view/window.h"

namespace promin::app {

/// Dear ImGui for a window: its context and its backends of GLFW and Vulkan. The one place that knows its versions.
class ImguiRenderer {
 public:
  /// Throws vk::SystemError.
  ImguiRenderer(const gpu::Device& device, const Window& window, const Swapchain& swapchain);
  ~ImguiRenderer();
  ImguiRenderer(const ImguiRenderer&) = delete;
  ImguiRenderer& operator=(const ImguiRenderer&) = delete;

  /// Between these calls ImGui is told what to show.
  void begin_frame();
  void end_frame();
  /// Records drawing that within a render pass of the swapchain.
  void record(const vk::raii::CommandBuffer& commands) const;

  bool wants_keys() const;
  bool wants_pointer() const;

 private:
  vk::raii::DescriptorPool pool_;
};

}  // namespace promin::app
