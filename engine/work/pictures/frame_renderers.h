// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/device.h"
#include "promin/renderer.h"
#include "trace/render/make_renderer.h"
#include "work/pictures/picture_run.h"

namespace promin::work {

/// The renderer of a run's frames, which shows the scene in the pose of each frame. A later frame compiles no kernel,
/// unless its tree needs a far larger stack than that of the first.
class FrameRenderers {
 public:
  /// The arguments must outlive this object.
  FrameRenderers(const gpu::Device& device, const PictureRun& run, TunedRendererOptions options);

  FrameRenderers(const FrameRenderers&) = delete;
  FrameRenderers& operator=(const FrameRenderers&) = delete;

  /// Returns the renderer, which shows the pose of a frame. References to earlier renderers become invalid. Throws
  /// InputError if the pose of the frame is refused, and the errors of Renderer's constructor.
  Renderer& at(const PlannedFrame& frame);
  /// Sets the members of a view and of statistics that depend on the frame: the camera and the time. Call at() first.
  void describe(const PlannedFrame& frame, View& view, RunStats& stats) const;

 private:
  void change_pose(const Scene& scene);

  const gpu::Device& device_;
  const PictureRun& run_;
  TunedRendererOptions options_;
  std::optional<Renderer> renderer_;
  std::optional<double> time_s_;
  /// The camera of the file in the pose of the frame.
  std::optional<Camera> camera_;
  /// The size of the traversal stack of all frames; 0 before the first.
  uint32_t stack_size_ = 0;
};

}  // namespace promin::work
