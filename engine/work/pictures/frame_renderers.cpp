// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/frame_renderers.h"

#include <algorithm>
#include <utility>

#include "work/pictures/frame_motion.h"

namespace promin::work {
namespace {

/// The number of entries by which the stack of a frame may exceed that of the first. Kernels are compiled for multiples
/// of 8 entries.
constexpr uint32_t kSpareStack = 8;

}  // namespace

FrameRenderers::FrameRenderers(const gpu::Device& device, const PictureRun& run, TunedRendererOptions options)
    : device_(device), run_(run), options_(std::move(options)) {
  if (run.moving == nullptr) return;
  options_.more_features |= run.moving->features();
  options_.repack = [this](PackedScene packed) {
    if (stack_size_ == 0) stack_size_ = packed.stack_size + kSpareStack;
    packed.stack_size = std::max(packed.stack_size, stack_size_);
    return packed;
  };
}

Renderer& FrameRenderers::at(const PlannedFrame& frame) {
  if (renderer_ && time_s_ == frame.time_s) return *renderer_;
  if (run_.moving == nullptr) {
    renderer_.emplace(make_renderer(device_, run_.scene, options_));
  } else {
    const Scene scene = run_.moving->at(frame.time_s.value_or(0.0));
    camera_ = file_camera_in(scene, run_, frame);
    if (renderer_) {
      change_pose(scene);
    } else {
      renderer_.emplace(make_renderer(device_, scene, options_));
    }
  }
  time_s_ = frame.time_s;
  return *renderer_;
}

void FrameRenderers::change_pose(const Scene& scene) {
  // Tracing a frame takes longer than building a tree, so a better tree pays. The samples of an open shutter are traced
  // in little time.
  const TreeOfPose tree = run_.options.shutter ? TreeOfPose::kRefitted : TreeOfPose::kBuilt;
  try {
    RendererAccess::set_pose(*renderer_, world::flatten(scene, world::Purpose::kPictures, options_.instances), tree);
  } catch (...) {
    renderer_.reset();
    throw;
  }
}

void FrameRenderers::describe(const PlannedFrame& frame, View& view, RunStats& stats) const {
  if (frame.time_s) stats.motion.time_s = frame.time_s;
  if (frame.camera) {
    view.camera = *frame.camera;
  } else if (camera_) {
    view.camera = *camera_;
  }
}

}  // namespace promin::work
