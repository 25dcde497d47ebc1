// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "device/buffer.h"
#include "promin/math.h"
#include "view/display/swapchain.h"
#include "view/display/traced_picture.h"

namespace promin::app {

/// Draws a picture, scaled to the whole window, whenever the window is drawn (shaders/window/display.frag).
class DisplayPass {
 public:
  /// Creates the pipeline. Throws vk::SystemError.
  DisplayPass(const gpu::Device& device, const Swapchain& swapchain);

  /// Sets the picture; the device must be idle.
  void take(const EncodedPicture& picture);
  /// Records the drawing of the current picture, if there is one, within a render pass of the swapchain.
  void record_drawing(const vk::raii::CommandBuffer& commands, const uvec2& window_size) const;

 private:
  const gpu::Device* device_;
  std::optional<gpu::Buffer> encoded_;
  /// The size of the current picture; empty at first.
  std::optional<uvec2> encoded_size_;
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
};

}  // namespace promin::app
