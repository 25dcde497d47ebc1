// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

// Kernels as shader objects (VK_EXT_shader_object). Their binaries can be kept on the disk. With Vulkan headers before
// 1.3.246, which do not have the extension, promin compiles and has no driver with it.

namespace promin::gpu {

#ifdef VK_EXT_shader_object
using ShaderObject = vk::raii::ShaderEXT;
#else
class ShaderObject {
 public:
  explicit ShaderObject(std::nullptr_t /*none*/) {}
  bool operator*() const { return false; }
};
#endif

/// Returns the names of the device extensions that shader objects need; empty if the headers do not have them.
std::span<const char* const> shader_object_extensions();

/// Returns the structure that enables shader objects, for the chain of a VkDeviceCreateInfo.
const void* shader_object_features();

/// Returns words that identify the format of a driver's binaries. The driver's own UUID is not enough: lavapipe's is
/// the first 16 characters of Mesa's version. The words also contain the names and versions of the device and the
/// driver. Lavapipe's contain the version of LLVM and the width of its vectors.
std::vector<uint32_t> binary_format_of(const vk::raii::PhysicalDevice& device);

/// The kind of the bytes from which a shader is made.
enum class ShaderCode { kSpirv, kBinary };

/// Makes a compute shader with entry point "main" and one descriptor set. The code of a binary is aligned to 16 bytes,
/// as that of a std::vector is. Returns null if the driver refuses a binary. Throws vk::SystemError.
ShaderObject make_shader(const vk::raii::Device& device, ShaderCode kind, std::span<const std::byte> code,
                         vk::DescriptorSetLayout layout);

/// Returns the binary of a shader. Throws vk::SystemError.
std::vector<std::byte> binary_of(const ShaderObject& shader);

/// Records the binding of a shader.
void bind_shader(const vk::raii::CommandBuffer& commands, const ShaderObject& shader);

}  // namespace promin::gpu
