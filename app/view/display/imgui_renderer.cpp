// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/imgui_renderer.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "view/panel/overlay.h"

namespace promin::app {
namespace {

constexpr uint32_t kMaxTextures = 8;

void throw_failure(VkResult result) {
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) throw vk::OutOfDeviceMemoryError("Dear ImGui");
  if (result == VK_ERROR_DEVICE_LOST) throw vk::DeviceLostError("Dear ImGui");
  if (result < 0) throw vk::SystemError(vk::make_error_code(static_cast<vk::Result>(result)), "Dear ImGui");
}

vk::raii::DescriptorPool make_pool(const gpu::Device& device) {
  const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, kMaxTextures);
  return {device.handle(),
          vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, kMaxTextures, size)};
}

void upload_fonts([[maybe_unused]] const gpu::Device& device) {
#if IMGUI_VERSION_NUM >= 19000
  // This version of ImGui submits to the queue itself.
  device.use_queue([](const vk::raii::Queue&) { ImGui_ImplVulkan_CreateFontsTexture(); });
#else
  device.run([](const vk::raii::CommandBuffer& commands) { ImGui_ImplVulkan_CreateFontsTexture(*commands); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

}  // namespace

bool is_escape_pressed() {
#if IMGUI_VERSION_NUM >= 18700
  return ImGui::IsKeyPressed(ImGuiKey_Escape);
#else
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
#endif
}

ImguiRenderer::ImguiRenderer(const gpu::Device& device, Window& window, const Swapchain& swapchain)
    : device_(&device),
      window_(&window),
      last_frame_s_(Window::now()),
      swapchain_(&swapchain),
      scale_(window.overlay_scale()) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
  start_backend();
}

void ImguiRenderer::set_scale(const OverlayScale& scale) {
  // Every version of ImGui creates its textures, including the fonts, when the backend starts.
  ImGui_ImplVulkan_Shutdown();
  scale_ = scale;
  start_backend();
}

void ImguiRenderer::start_backend() {
  const gpu::Device& device = *device_;
  scale_overlay(scale_);
  pool_ = make_pool(device);
  ImGui_ImplVulkan_InitInfo info = {};
  info.Instance = *device.instance();
  info.PhysicalDevice = *device.physical();
  info.Device = *device.handle();
  info.QueueFamily = device.queue_family();
  info.Queue = device.use_queue([](const vk::raii::Queue& queue) { return static_cast<VkQueue>(*queue); });
  info.DescriptorPool = *pool_;
  info.MinImageCount = 2;
  info.ImageCount = std::max(info.MinImageCount, swapchain_->image_count());
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = throw_failure;
#if IMGUI_VERSION_NUM >= 19030
  info.RenderPass = *swapchain_->render_pass();
  ImGui_ImplVulkan_Init(&info);
#else
  ImGui_ImplVulkan_Init(&info, *swapchain_->render_pass());
#endif
  upload_fonts(device);
}

ImguiRenderer::~ImguiRenderer() {
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImguiRenderer::begin_frame() {
  ImGui_ImplVulkan_NewFrame();
  // Shortest time between frames in seconds. ImGui_ImplGlfw_NewFrame() is not used, because it queries the display for
  // what the window already knows and waits for each answer, which takes tens of milliseconds on a busy machine.
  constexpr double kLeastTime = 1e-5;
  ImGuiIO& io = ImGui::GetIO();
  const auto ratio = static_cast<float>(window_->pixel_ratio());
  const vec2 size = vec2(window_->framebuffer_size()) / ratio;
  io.DisplaySize = ImVec2(size.x, size.y);
  io.DisplayFramebufferScale = ImVec2(ratio, ratio);
  const double now = Window::now();
  io.DeltaTime = static_cast<float>(std::max(now - std::exchange(last_frame_s_, now), kLeastTime));
#if IMGUI_VERSION_NUM < 18700
  // Later versions receive this position from the callbacks that they have set.
  constexpr float kNowhere = std::numeric_limits<float>::max();
  const std::optional<dvec2> pointer = window_->pointer();
  io.MousePos =
      pointer ? ImVec2(static_cast<float>(pointer->x), static_cast<float>(pointer->y)) : ImVec2(-kNowhere, -kNowhere);
  const Window::Buttons down = window_->take_buttons();
  std::copy(down.begin(), down.end(), io.MouseDown);
#endif
  ImGui::NewFrame();
}

void ImguiRenderer::end_frame() {
  ImGui::Render();
}

void ImguiRenderer::record(const vk::raii::CommandBuffer& commands) const {
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
}

bool ImguiRenderer::wants_keys() const {
  return ImGui::GetIO().WantTextInput;
}

bool ImguiRenderer::wants_pointer() const {
  return ImGui::GetIO().WantCaptureMouse;
}

}  // namespace promin::app
