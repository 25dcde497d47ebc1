// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/pipeline.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <stdexcept>
#include <string>

#include "core/address_space.h"
#include "device/buffer.h"
#include "device/device.h"

namespace promin::gpu {
namespace {

/// Reserves address space for a driver's compiler during its lifetime. LLVM crashes at the limit of address space, so
/// the compiler starts only if enough is free. The class does nothing if address space is not limited.
class CompilerSpace {
 public:
  /// Waits for other compilers if there is not enough address space for all. Throws RunError if there is not enough for
  /// one.
  explicit CompilerSpace(uint64_t code_bytes) {
    if (!address_space_limit()) return;
    bytes_ = estimate(code_bytes);
    std::unique_lock lock(mutex_);
    has_ended_.wait(lock, [&] { return taken_ == 0 || !find_lack(taken_ + bytes_); });
    const auto lack = taken_ == 0 ? find_lack(bytes_ - std::min(bytes_, most_)) : std::nullopt;
    if (lack) throw RunError(*lack);
    taken_ += bytes_;
    most_ = std::max(most_, bytes_);
  }
  CompilerSpace(const CompilerSpace&) = delete;
  CompilerSpace& operator=(const CompilerSpace&) = delete;
  ~CompilerSpace() {
    if (bytes_ == 0) return;
    const std::lock_guard lock(mutex_);
    taken_ -= bytes_;
    has_ended_.notify_all();
  }

 private:
  /// Returns an estimate of the memory that lavapipe uses to compile a kernel of this many bytes of SPIR-V, without the
  /// memory for starting it. Measured with the start: Mesa 22.3.6 uses 44 MiB for 144 KiB, 38 for 176, 76 for 235, 183
  /// for 348, 385 for 474 and 391 for 484; Mesa 25.0.7 uses 30 for 176, 128 for 348 and 294 for 474. The estimates for
  /// these six sizes are 40, 61, 108, 237, 439 and 457 MiB.
  static uint64_t estimate(uint64_t code_bytes) { return code_bytes * code_bytes / 512; }

  /// The additional memory that a driver needs to start a kernel: up to 24 MiB.
  static std::optional<Problem> find_lack(uint64_t bytes) {
    constexpr uint64_t kStartBytes = uint64_t{32} << 20;
    return find_lack_of_space("the driver to compile the scene's kernels", bytes + kStartBytes);
  }

  static inline std::mutex mutex_;
  static inline std::condition_variable has_ended_;
  static inline uint64_t taken_ = 0;
  /// The largest memory of one compilation so far. The process keeps this memory, and the next compilation uses it
  /// again.
  static inline uint64_t most_ = 0;
  uint64_t bytes_ = 0;
};

vk::raii::Pipeline make_pipeline(const vk::raii::Device& device, std::span<const uint32_t> code,
                                 std::span<const SpecializationConstant> constants, vk::PipelineLayout layout) {
  const vk::raii::ShaderModule module(device, vk::ShaderModuleCreateInfo({}, code.size_bytes(), code.data()));
  std::vector<vk::SpecializationMapEntry> entries;
  for (const SpecializationConstant& constant : constants) {
    const auto offset =
        static_cast<uint32_t>(entries.size() * sizeof constant + offsetof(SpecializationConstant, value));
    entries.emplace_back(constant.id, offset, sizeof constant.value);
  }
  const vk::SpecializationInfo values(static_cast<uint32_t>(entries.size()), entries.data(), constants.size_bytes(),
                                      constants.data());
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &values);
  return {device, nullptr, vk::ComputePipelineCreateInfo({}, stage, layout)};
}

/// Returns true if another form of the code may be accepted.
bool is_refusal(const vk::SystemError& error) {
  const std::array fatal{vk::Result::eErrorOutOfHostMemory, vk::Result::eErrorOutOfDeviceMemory,
                         vk::Result::eErrorDeviceLost};
  return std::ranges::none_of(fatal, [&](vk::Result result) { return error.code() == vk::make_error_code(result); });
}

}  // namespace

const CompiledPipeline& CompiledPipelines::get(const vk::raii::Device& device, std::span<const uint32_t> spirv,
                                               std::span<const SpecializationConstant> constants,
                                               std::span<const vk::DescriptorSetLayoutBinding> bindings) {
  for (const SpecializationConstant& constant : constants) {
    if (!has_specialization_constant(spirv, constant.id)) {
      throw std::logic_error("the shader has no specialization constant " + std::to_string(constant.id));
    }
  }
  const std::vector<uint32_t> code = specialize(spirv, constants);
  std::vector<uint32_t> key;
  for (const vk::DescriptorSetLayoutBinding& binding : bindings) {
    key.insert(key.end(), {binding.binding, static_cast<uint32_t>(binding.descriptorType)});
  }
  key.push_back(static_cast<uint32_t>(bindings.size()));
  key.insert(key.end(), code.begin(), code.end());
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = compiled_.find(key); found != compiled_.end()) return found->second;
  }

  const CompilerSpace space(code.size() * sizeof(uint32_t));
  CompiledPipeline made;
  made.set_layout = vk::raii::DescriptorSetLayout(
      device, vk::DescriptorSetLayoutCreateInfo({}, static_cast<uint32_t>(bindings.size()), bindings.data()));
  made.layout = vk::raii::PipelineLayout(device, vk::PipelineLayoutCreateInfo({}, *made.set_layout));
  try {
    if (folder_) {
      made.shader = make_shader_object(device, key, code, *made.set_layout);
    } else {
      made.pipeline = make_pipeline(device, code, {}, *made.layout);
      count_compiled();
    }
  } catch (const vk::SystemError& error) {
    if (!is_refusal(error)) throw;
    made.pipeline = make_pipeline(device, spirv, constants, *made.layout);
    count_compiled(std::string("the driver refused a kernel without its dead code (") + error.what() + ")");
  }
  // If two threads have compiled the same code, only one result is kept.
  const std::lock_guard lock(mutex_);
  return compiled_.emplace(std::move(key), std::move(made)).first->second;
}

ShaderObject CompiledPipelines::make_shader_object(const vk::raii::Device& device, std::span<const uint32_t> key,
                                                   std::span<const uint32_t> code, vk::DescriptorSetLayout layout) {
  std::vector<uint32_t> key_in_folder = binary_format_;
  key_in_folder.insert(key_in_folder.end(), key.begin(), key.end());
  if (const auto binary = folder_->find(key_in_folder); !binary.empty()) {
    ShaderObject shader = make_shader(device, ShaderCode::kBinary, binary, layout);
    if (*shader) {
      const std::lock_guard lock(mutex_);
      ++stats_.read;
      return shader;
    }
  }
  ShaderObject shader = make_shader(device, ShaderCode::kSpirv, std::as_bytes(code), layout);
  folder_->store(key_in_folder, binary_of(shader));
  count_compiled();
  return shader;
}

void CompiledPipelines::keep_binaries(const vk::raii::PhysicalDevice& physical, std::filesystem::path folder) {
  binary_format_ = binary_format_of(physical);
  folder_.emplace(std::move(folder));
}

void CompiledPipelines::count_compiled(const std::string& note) {
  const std::lock_guard lock(mutex_);
  ++stats_.compiled;
  if (!note.empty()) stats_.notes.push_back(note);
}

KernelStats CompiledPipelines::stats() const {
  const std::lock_guard lock(mutex_);
  KernelStats stats = stats_;
  if (!folder_) return stats;
  stats.folder = folder_->path();
  if (const std::string problem = folder_->problem(); !problem.empty()) {
    stats.notes.push_back("compiled kernels are not kept: " + problem);
  }
  return stats;
}

size_t CompiledPipelines::size() const {
  const std::lock_guard lock(mutex_);
  return compiled_.size();
}

ComputePipeline::ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                                 std::span<const SpecializationConstant> constants,
                                 std::span<const BoundBuffer> buffers)
    : device_(&device) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  std::map<vk::DescriptorType, uint32_t> type_counts;
  for (const BoundBuffer& buffer : buffers) {
    bindings.emplace_back(buffer.binding, buffer.type, 1, vk::ShaderStageFlagBits::eCompute);
    ++type_counts[buffer.type];
  }
  compiled_ = &device.compiled_pipelines().get(device.handle(), spirv, constants, bindings);
  std::vector<vk::DescriptorPoolSize> pool_sizes;
  for (const auto& [type, count] : type_counts) pool_sizes.emplace_back(type, count);
  pool_ = vk::raii::DescriptorPool(
      device.handle(),
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, pool_sizes));
  const vk::DescriptorSetAllocateInfo allocation(*pool_, *compiled_->set_layout);
  set_ = std::move(vk::raii::DescriptorSets(device.handle(), allocation).front());
  for (const BoundBuffer& buffer : buffers) bind(buffer);
}

void ComputePipeline::bind(const BoundBuffer& buffer) {
  vk::WriteDescriptorSet write(*set_, buffer.binding, 0, 1, buffer.type);
  // The shader reads data beyond the range of a storage buffer as texels, so the range may end earlier.
  const vk::DeviceSize range =
      std::min<vk::DeviceSize>(buffer.buffer->size_bytes(), device_->limits().maxStorageBufferRange);
  const vk::DescriptorBufferInfo info(*buffer.buffer->handle(), 0, range);
  vk::BufferView view;
  if (buffer.view != nullptr) {
    view = **buffer.view;
    write.pTexelBufferView = &view;
  } else {
    write.pBufferInfo = &info;
  }
  device_->handle().updateDescriptorSets(write, {});
}

void ComputePipeline::bind_all(const vk::raii::CommandBuffer& commands) const {
  if (*compiled_->shader) {
    bind_shader(commands, compiled_->shader);
  } else {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *compiled_->pipeline);
  }
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *compiled_->layout, 0, *set_, {});
}

void ComputePipeline::dispatch(const vk::raii::CommandBuffer& commands, const uvec2& group_count) const {
  bind_all(commands);
  commands.dispatch(group_count.x, group_count.y, 1);
}

void ComputePipeline::dispatch_indirect(const vk::raii::CommandBuffer& commands, const Buffer& group_count,
                                        vk::DeviceSize offset_bytes) const {
  bind_all(commands);
  commands.dispatchIndirect(*group_count.handle(), offset_bytes);
}

}  // namespace promin::gpu
