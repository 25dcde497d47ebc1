// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/device.h"
#include "promin/math.h"

namespace promin::app {

/// Names that --present-mode takes.
std::span<const std::string_view> present_mode_names();

/// The images of a window, the render pass that draws to them and a framebuffer for each.
class Swapchain {
 public:
  /// Without a preference, and where the surface lacks the mode, FIFO: vsync. Throws vk::SystemError.
  Swapchain(const gpu::Device& device, std::optional<std::string_view> present_mode);

  /// Makes images anew for a window of this size, which is not 0; the device must be idle. False, and nothing is made,
  /// while the surface has no pixels. Otherwise size() is what the surface gives.
  bool recreate(const uvec2& size);
  /// Whether the images have to be made anew, because the window has changed.
  bool is_out_of_date() const { return is_out_of_date_; }
  const uvec2& size() const { return size_; }
  /// The mode in use, one of present_mode_names().
  std::string_view present_mode() const;

  /// Takes the next image, whose readiness signals the semaphore; none where all are in use or the window has changed.
  std::optional<uint32_t> acquire(vk::Semaphore ready);
  /// Shows an image as soon as what was submitted to the queue with rendered(image) has drawn it.
  void present(uint32_t image);
  vk::Semaphore rendered(uint32_t image) const { return *rendered_[image]; }

  void begin_drawing(const vk::raii::CommandBuffer& commands, uint32_t image) const;
  const vk::raii::RenderPass& render_pass() const { return render_pass_; }
  /// Whether the surface takes linear values and encodes them itself.
  bool encodes() const { return encodes_; }
  uint32_t image_count() const { return static_cast<uint32_t>(images_.size()); }

 private:
  const gpu::Device* device_;
  vk::SurfaceFormatKHR format_;
  vk::PresentModeKHR present_mode_ = vk::PresentModeKHR::eFifo;
  bool encodes_ = false;
  bool is_out_of_date_ = true;
  uvec2 size_{0};
  vk::raii::RenderPass render_pass_{nullptr};
  vk::raii::SwapchainKHR chain_{nullptr};
  std::vector<vk::Image> images_;
  std::vector<vk::raii::ImageView> views_;
  std::vector<vk::raii::Framebuffer> framebuffers_;
  std::vector<vk::raii::Semaphore> rendered_;
};

}  // namespace promin::app
