// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "device/device.h"
#include "promin/math.h"

namespace promin::app {

/// Returns the names that --present-mode accepts.
std::span<const std::string_view> present_mode_names();

/// The images of a window, the render pass that draws to them and a framebuffer for each.
class Swapchain {
 public:
  /// Creates the render pass for a present mode. Without a preference, or if the surface lacks the mode, the mode is
  /// FIFO (vsync). Throws vk::SystemError.
  Swapchain(const gpu::Device& device, std::optional<std::string_view> present_mode);

  /// Creates the images again for a window of this size, which is not 0; the device must be idle. Returns false and
  /// creates nothing while the surface has no pixels. Otherwise size() returns the surface's size.
  bool recreate(const uvec2& size);
  /// Returns whether the images must be created again, because the window has changed.
  bool is_out_of_date() const { return is_out_of_date_; }
  const uvec2& size() const { return size_; }
  /// Returns the name of the mode in use, one of present_mode_names().
  std::string_view present_mode() const;

  /// Acquires the next image; the semaphore is signalled when the image is ready. Returns nullopt if all images are in
  /// use or the window has changed.
  std::optional<uint32_t> acquire(vk::Semaphore ready);
  /// Presents an image after the commands that were submitted with rendered(image) have drawn it.
  void present(uint32_t image);
  vk::Semaphore rendered(uint32_t image) const { return *rendered_[image]; }

  void begin_drawing(const vk::raii::CommandBuffer& commands, uint32_t image) const;
  const vk::raii::RenderPass& render_pass() const { return render_pass_; }
  /// Returns whether the surface receives linear values and encodes them itself.
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
