// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "device/buffer.h"
#include "promin/image.h"
#include "promin/view.h"

namespace promin::app {

/// Writes pictures of the window to files: a given one, or promin-NNNN.exr and .png with the next number that is free
/// in the working folder. It writes one at a time, and the window does not wait.
class Screenshot {
 public:
  bool is_busy() const { return copy_.has_value() || written_.valid(); }
  /// Records copying a film that holds all of the picture; `has_unlit` as ProgressivePicture::has_unlit. Must not be
  /// called while busy.
  void record_copy(std::shared_ptr<const gpu::Device> device, const vk::raii::CommandBuffer& commands,
                   const gpu::Buffer& film, const View& view, bool has_unlit);
  /// Is called when the device has done that; writes on a thread of its own.
  void write(const Metadata& metadata, const DisplayTransform& display,
             const std::optional<std::filesystem::path>& file);
  /// Is called instead of writing, where the copy is not wanted after all.
  void drop() { copy_.reset(); }
  /// Waits until the picture is written; the device must have finished.
  void wait() const;
  /// A sentence about what was written, once it is. Throws RunError.
  std::optional<std::string> take();

 private:
  std::shared_ptr<const gpu::Device> device_;
  View view_;
  std::optional<gpu::Buffer> copy_;
  std::future<std::string> written_;
};

/// promin-NNNN, with the first number for which neither an .exr nor a .png is in the folder. Throws RunError when all
/// are taken.
std::string find_free_name(const std::filesystem::path& folder);

}  // namespace promin::app
