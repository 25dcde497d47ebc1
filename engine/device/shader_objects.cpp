// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/shader_objects.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "core/divide_up.h"

namespace promin::gpu {

#ifdef VK_EXT_shader_object

std::span<const char* const> shader_object_extensions() {
  // The extension requires the second one, which requires the third one, and so on.
  static constexpr std::array kExtensions{VK_EXT_SHADER_OBJECT_EXTENSION_NAME, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
                                          VK_KHR_DEPTH_STENCIL_RESOLVE_EXTENSION_NAME,
                                          VK_KHR_CREATE_RENDERPASS_2_EXTENSION_NAME};
  return kExtensions;
}

const void* shader_object_features() {
  static const vk::PhysicalDeviceShaderObjectFeaturesEXT features(VK_TRUE);
  return &features;
}

std::vector<uint32_t> binary_format_of(const vk::raii::PhysicalDevice& device) {
  const auto chain = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties,
                                           vk::PhysicalDeviceShaderObjectPropertiesEXT>();
  const vk::PhysicalDeviceProperties& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const auto& binaries = chain.get<vk::PhysicalDeviceShaderObjectPropertiesEXT>();
  std::string text(binaries.shaderBinaryUUID.begin(), binaries.shaderBinaryUUID.end());
  for (const char* name : {properties.deviceName.data(), driver.driverName.data(), driver.driverInfo.data()}) {
    text.append(name).push_back('\n');
  }
  std::vector<uint32_t> words(divide_up(text.size(), sizeof(uint32_t)));
  std::memcpy(words.data(), text.data(), text.size());
  words.insert(words.end(),
               {binaries.shaderBinaryVersion, properties.vendorID, properties.deviceID, properties.driverVersion});
  return words;
}

ShaderObject make_shader(const vk::raii::Device& device, ShaderCode kind, std::span<const std::byte> code,
                         vk::DescriptorSetLayout layout) {
  vk::ShaderCreateInfoEXT info;
  info.stage = vk::ShaderStageFlagBits::eCompute;
  info.codeType = kind == ShaderCode::kSpirv ? vk::ShaderCodeTypeEXT::eSpirv : vk::ShaderCodeTypeEXT::eBinary;
  info.codeSize = code.size();
  info.pCode = code.data();
  info.pName = "main";
  info.setLayoutCount = 1;
  info.pSetLayouts = &layout;
  // Newer headers return null for a binary that the driver refuses, and older headers throw.
  try {
    return {device, info};
  } catch (const vk::SystemError&) {
    if (kind == ShaderCode::kSpirv) throw;
    return nullptr;
  }
}

std::vector<std::byte> binary_of(const ShaderObject& shader) {
  const std::vector<uint8_t> bytes = shader.getBinaryData();
  std::vector<std::byte> result(bytes.size());
  std::ranges::transform(bytes, result.begin(), [](uint8_t byte) { return std::byte{byte}; });
  return result;
}

void bind_shader(const vk::raii::CommandBuffer& commands, const ShaderObject& shader) {
  commands.bindShadersEXT(vk::ShaderStageFlagBits::eCompute, *shader);
}

#else

// No device has the extension, so only the first function is called.
std::span<const char* const> shader_object_extensions() {
  return {};
}

const void* shader_object_features() {
  return nullptr;
}

std::vector<uint32_t> binary_format_of(const vk::raii::PhysicalDevice& /*device*/) {
  return {};
}

ShaderObject make_shader(const vk::raii::Device& /*device*/, ShaderCode /*kind*/, std::span<const std::byte> /*code*/,
                         vk::DescriptorSetLayout /*layout*/) {
  return ShaderObject(nullptr);
}

std::vector<std::byte> binary_of(const ShaderObject& /*shader*/) {
  return {};
}

void bind_shader(const vk::raii::CommandBuffer& /*commands*/, const ShaderObject& /*shader*/) {}

#endif

}  // namespace promin::gpu
