// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/swapchain.h"

#include <algorithm>
#include <array>

namespace promin::app {
namespace {

constexpr std::array<std::string_view, 4> kModeNames = {"fifo", "mailbox", "immediate", "fifo-relaxed"};
constexpr std::array kModes = {vk::PresentModeKHR::eFifo, vk::PresentModeKHR::eMailbox, vk::PresentModeKHR::eImmediate,
                               vk::PresentModeKHR::eFifoRelaxed};

bool is_srgb(vk::Format format) {
  return format == vk::Format::eB8G8R8A8Srgb || format == vk::Format::eR8G8B8A8Srgb;
}

/// Chooses a format of eight bits and sRGB colours. A format that receives encoded values is preferred to one that
/// encodes linear values, because the overlay's colours are encoded values.
vk::SurfaceFormatKHR choose_format(const std::vector<vk::SurfaceFormatKHR>& formats) {
  const std::array wanted{vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm, vk::Format::eB8G8R8A8Srgb,
                          vk::Format::eR8G8B8A8Srgb};
  for (const vk::Format format : wanted) {
    const auto found =
        std::find(formats.begin(), formats.end(), vk::SurfaceFormatKHR(format, vk::ColorSpaceKHR::eSrgbNonlinear));
    if (found != formats.end()) return *found;
  }
  return formats.front();
}

vk::raii::RenderPass make_render_pass(const gpu::Device& device, vk::Format format) {
  const vk::AttachmentDescription color({}, format, vk::SampleCountFlagBits::e1, vk::AttachmentLoadOp::eClear,
                                        vk::AttachmentStoreOp::eStore, vk::AttachmentLoadOp::eDontCare,
                                        vk::AttachmentStoreOp::eDontCare, vk::ImageLayout::eUndefined,
                                        vk::ImageLayout::ePresentSrcKHR);
  const vk::AttachmentReference reference(0, vk::ImageLayout::eColorAttachmentOptimal);
  const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, {}, reference);
  // The layout of the image may change only after the image has been acquired.
  using Stage = vk::PipelineStageFlagBits;
  const vk::SubpassDependency acquired(VK_SUBPASS_EXTERNAL, 0, Stage::eColorAttachmentOutput,
                                       Stage::eColorAttachmentOutput, {}, vk::AccessFlagBits::eColorAttachmentWrite);
  return {device.handle(), vk::RenderPassCreateInfo({}, color, subpass, acquired)};
}

}  // namespace

std::span<const std::string_view> present_mode_names() {
  return kModeNames;
}

Swapchain::Swapchain(const gpu::Device& device, std::optional<std::string_view> present_mode) : device_(&device) {
  format_ = choose_format(device.physical().getSurfaceFormatsKHR(*device.surface()));
  encodes_ = is_srgb(format_.format);
  const auto modes = device.physical().getSurfacePresentModesKHR(*device.surface());
  for (size_t i = 0; i < kModes.size(); ++i) {
    const bool is_wanted = present_mode == kModeNames[i];
    if (is_wanted && std::find(modes.begin(), modes.end(), kModes[i]) != modes.end()) present_mode_ = kModes[i];
  }
  render_pass_ = make_render_pass(device, format_.format);
}

std::string_view Swapchain::present_mode() const {
  return kModeNames[static_cast<size_t>(std::find(kModes.begin(), kModes.end(), present_mode_) - kModes.begin())];
}

bool Swapchain::recreate(const uvec2& size) {
  const vk::SurfaceCapabilitiesKHR limits = device_->physical().getSurfaceCapabilitiesKHR(*device_->surface());
  // If the window manager does not specify the size, it is the window's own size.
  const bool is_told = limits.currentExtent.width != 0xFFFFFFFF;
  const vk::Extent2D extent =
      is_told ? limits.currentExtent
              : vk::Extent2D(std::clamp(size.x, limits.minImageExtent.width, limits.maxImageExtent.width),
                             std::clamp(size.y, limits.minImageExtent.height, limits.maxImageExtent.height));
  if (extent.width == 0 || extent.height == 0) return false;
  const uint32_t most = limits.maxImageCount == 0 ? ~0U : limits.maxImageCount;
  using Alpha = vk::CompositeAlphaFlagBitsKHR;
  const Alpha alpha = (limits.supportedCompositeAlpha & Alpha::eOpaque) ? Alpha::eOpaque : Alpha::eInherit;
  const vk::SwapchainCreateInfoKHR info({}, *device_->surface(), std::clamp(3U, limits.minImageCount, most),
                                        format_.format, format_.colorSpace, extent, 1,
                                        vk::ImageUsageFlagBits::eColorAttachment, vk::SharingMode::eExclusive, {},
                                        limits.currentTransform, alpha, present_mode_, VK_TRUE, *chain_);
  vk::raii::SwapchainKHR chain(device_->handle(), info);
  framebuffers_.clear();
  views_.clear();
  chain_ = std::move(chain);
  images_.clear();
  for (const VkImage image : chain_.getImages()) images_.emplace_back(image);
  const vk::ImageSubresourceRange whole(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
  for (const vk::Image image : images_) {
    views_.emplace_back(device_->handle(),
                        vk::ImageViewCreateInfo({}, image, vk::ImageViewType::e2D, format_.format, {}, whole));
    framebuffers_.emplace_back(device_->handle(), vk::FramebufferCreateInfo({}, *render_pass_, *views_.back(),
                                                                            extent.width, extent.height, 1));
  }
  rendered_.clear();
  while (rendered_.size() < images_.size()) rendered_.emplace_back(device_->handle(), vk::SemaphoreCreateInfo());
  size_ = uvec2(extent.width, extent.height);
  is_out_of_date_ = false;
  return true;
}

std::optional<uint32_t> Swapchain::acquire(vk::Semaphore ready) {
  try {
    const auto [result, image] = chain_.acquireNextImage(0, ready);
    if (result == vk::Result::eSuboptimalKHR) is_out_of_date_ = true;
    if (result == vk::Result::eSuccess || result == vk::Result::eSuboptimalKHR) return image;
  } catch (const vk::OutOfDateKHRError&) {
    is_out_of_date_ = true;
  }
  return std::nullopt;
}

void Swapchain::present(uint32_t image) {
  vk::PresentInfoKHR info;
  const vk::Semaphore wait = rendered(image);
  info.setWaitSemaphores(wait);
  info.setSwapchains(*chain_);
  info.setImageIndices(image);
  try {
    const vk::Result result = device_->use_queue([&](const vk::raii::Queue& queue) { return queue.presentKHR(info); });
    if (result == vk::Result::eSuboptimalKHR) is_out_of_date_ = true;
  } catch (const vk::OutOfDateKHRError&) {
    is_out_of_date_ = true;
  }
}

void Swapchain::begin_drawing(const vk::raii::CommandBuffer& commands, uint32_t image) const {
  const vk::Rect2D whole({0, 0}, {size_.x, size_.y});
  // A grey similar to the backdrop of most scenes, so that the first picture does not look like a flash.
  constexpr float kGrey = 0.8F;
  const vk::ClearValue grey(vk::ClearColorValue(std::array{kGrey, kGrey, kGrey, 1.0F}));
  commands.beginRenderPass(vk::RenderPassBeginInfo(*render_pass_, *framebuffers_[image], whole, grey),
                           vk::SubpassContents::eInline);
}

}  // namespace promin::app
