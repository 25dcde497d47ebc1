// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "device/pipeline.h"
#include "device/spirv.h"

namespace promin::gpu {

/// A kernel, and the buffers with which it will run.
struct KernelSource {
  std::span<const uint32_t> spirv;
  std::vector<SpecializationConstant> constants;
  std::vector<BoundBuffer> buffers;
};

/// Compiles a kernel on a second device, and puts the result into the driver's cache on the disk. `device` takes it
/// from there in the kernel's first dispatch. Lavapipe compiles a kernel in its first dispatch, in one thread: the
/// kernels of a picture would compile one after the other while the other cores wait. The result depends on the code,
/// and on the format of each texel buffer and on whether its size is a power of two, so the second device gets small
/// buffers of this kind. It takes the memory of one compilation, as if the kernels compiled side by side. Throws what
/// Device and ComputePipeline throw.
void compile_on_second_device(const Device& device, const KernelSource& kernel);

/// Does the same in a thread during its lifetime, but only if the lifetime is long: if the driver has the kernels in
/// its cache, the dispatch during which this object exists ends at once, and a second device would be a waste. Does
/// nothing if the profile does not recommend it (DeviceProfile::compiles_on_second_device) or if address space is
/// limited. An error has no effect: `device` then compiles the kernel itself.
class SideCompiler {
 public:
  SideCompiler(const Device& device, const KernelSource& kernel);
  SideCompiler(const SideCompiler&) = delete;
  SideCompiler& operator=(const SideCompiler&) = delete;
  /// Waits until a compilation that has begun ends.
  ~SideCompiler();

 private:
  std::mutex mutex_;
  std::condition_variable has_ended_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace promin::gpu
