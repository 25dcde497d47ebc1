// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "device/buffer.h"
#include "device/pipeline.h"
#include "promin/display.h"
#include "promin/math.h"
#include "trace/progressive_picture.h"
#include "view/swapchain.h"

namespace promin::app {

/// Makes what encodes the pixels of a film, as `display` shows them, to words of a buffer (shaders/encode_film.comp).
/// `has_unlit` as ProgressivePicture::has_unlit.
gpu::ComputePipeline make_encoder(const gpu::Device& device, const gpu::Buffer& film, const gpu::Buffer& encoded,
                                  const DisplayTransform& display, bool has_unlit);

/// Draws pictures to the window: a film is encoded once (shaders/encode_film.comp), then drawn as often as the window
/// wants it, scaled to all of the window (shaders/display.frag).
class DisplayPass {
 public:
  /// Throws vk::SystemError.
  DisplayPass(const gpu::Device& device, const Swapchain& swapchain);

  /// Makes room for pictures of so many pixels, and says where the films are now and how they are shown; the device
  /// must be idle. What was encoded last is kept.
  void bind(std::array<const gpu::Buffer*, kFilmCount> films, uint32_t pixel_count, const DisplayTransform& display,
            bool has_unlit);

  /// Records encoding a picture that was traced before.
  void record_encoding(const vk::raii::CommandBuffer& commands, const ShownPicture& picture);
  /// Records drawing the picture that was encoded last, if any, within a render pass of the swapchain.
  void record_drawing(const vk::raii::CommandBuffer& commands, const uvec2& window_size) const;

 private:
  const gpu::Device* device_;
  std::optional<gpu::Buffer> encoded_;
  /// The size of the encoded picture; none at first.
  std::optional<uvec2> encoded_size_;
  std::array<std::optional<gpu::ComputePipeline>, kFilmCount> encoders_;
  vk::raii::DescriptorSetLayout set_layout_{nullptr};
  vk::raii::PipelineLayout layout_{nullptr};
  vk::raii::Pipeline pipeline_{nullptr};
  vk::raii::DescriptorPool pool_{nullptr};
  vk::raii::DescriptorSet set_{nullptr};
};

}  // namespace promin::app
