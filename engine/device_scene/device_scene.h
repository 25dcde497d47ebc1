// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "device/buffer.h"
#include "device/pipeline.h"
#include "device_scene/pack_scene.h"

namespace promin {

/// A packed scene in device memory, with what of it goes along with each dispatch. Keeps no reference to the
/// PackedScene.
class DeviceScene {
 public:
  /// Throws vk::SystemError, and RunError where a device limit is passed.
  DeviceScene(const gpu::Device& device, const PackedScene& packed);

  /// What a picture's or a cast's constants take from the scene.
  const layout::Frame& frame() const { return frame_; }
  const layout::Dispatch& dispatch() const { return dispatch_; }
  uint32_t stack_size() const { return stack_size_; }

  /// What traversal reads: nodes and primitives, as storage buffers and as texels.
  std::vector<gpu::BoundBuffer> geometry() const;
  /// Whether the device's texel buffers hold all of it: CONSTANT_FETCHES_TEXELS.
  bool fetches_texels() const { return fetches_texels_; }
  /// What shading reads, likewise.
  std::vector<gpu::BoundBuffer> shading() const;

 private:
  gpu::Buffer nodes_;
  gpu::Buffer primitives_;
  vk::raii::BufferView node_texels_;
  vk::raii::BufferView primitive_texels_;
  gpu::Buffer shading_;
  vk::raii::BufferView shading_texels_;
  layout::Frame frame_;
  layout::Dispatch dispatch_;
  uint32_t stack_size_;
  bool fetches_texels_;
};

}  // namespace promin
