// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/math.h"
#include "gpu/buffer.h"
#include "view/swapchain.h"

namespace promin::app {

/// A complete picture in device memory.
struct ShownPicture {
  /// Which of the films, below kFilmCount.
  size_t film = 0;
  uvec2 size{0};
  uint32_t samples_per_pixel = 1;
};
inline constexpr size_t kFilmCount = 2;

/// Draws a film to the window, scaled to all of it and encoded (shaders/display.frag).
class DisplayPass {
 public:
  /// Throws vk::SystemError.
  DisplayPass(const gpu::Device& device, const Swapchain& swapchain);

  /// Says where film `film` is now; the device must be idle.
  void bind(size_t film, const gpu::Buffer& buffer);

  /// Records drawing within a render pass of the swapchain.
  void record(const vk::raii::CommandBuffer& commands, const ShownPicture& picture, const uvec2& window_size) const;

 private:
  const gpu::Device* device_;
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  std::vector<vk::raii::DescriptorSet> sets_;
};

}  // namespace promin::app
