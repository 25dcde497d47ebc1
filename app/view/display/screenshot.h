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

/// Writes pictures of the window to files: to a given file, or to promin-NNNN.exr and .png in the working folder, with
/// the next free number. It writes one picture at a time, and the window does not wait.
class Screenshot {
 public:
  bool is_busy() const { return copy_.has_value() || written_.valid(); }
  /// Records a copy of a film that contains the whole picture. `has_unlit` is the result of
  /// ProgressivePicture::has_unlit(). Must not be called while busy.
  void record_copy(std::shared_ptr<const gpu::Device> device, const vk::raii::CommandBuffer& commands,
                   const gpu::Buffer& film, const View& view, bool has_unlit);
  /// Writes the picture on a separate thread. To be called after the device has finished the copy.
  void write(const Metadata& metadata, const DisplayTransform& display,
             const std::optional<std::filesystem::path>& file);
  /// Discards the copy. To be called in place of write() if the copy is not needed.
  void drop() { copy_.reset(); }
  /// Waits until the picture is written. The device must have finished the copy.
  void wait() const;
  /// Returns a sentence about the written files after they are written. Throws RunError.
  std::optional<std::string> take();

 private:
  std::shared_ptr<const gpu::Device> device_;
  View view_;
  std::optional<gpu::Buffer> copy_;
  std::future<std::string> written_;
};

/// Returns the name promin-NNNN with the first number for which the folder contains neither an .exr nor a .png. Throws
/// RunError if all numbers are used.
std::string find_free_name(const std::filesystem::path& folder);

}  // namespace promin::app
