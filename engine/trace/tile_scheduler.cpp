// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/tile_scheduler.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/divide_up.h"
#include "trace/sampling.h"
#include "trace/share_out.h"

namespace promin {
namespace {

/// The camera's part of a frame, computed in double.
void set_camera(layout::Frame& frame, layout::Dispatch& dispatch, const Camera& camera, const uvec2& size) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half_height =
      is_orthographic ? static_cast<double>(camera.ymag) : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half_height / size.y;
  const dvec3 right = glm::cross(dvec3(camera.look), dvec3(camera.up)) * pixel;
  const dvec3 up = dvec3(camera.up) * pixel;
  // A ray's interval is open, but what lies on the viewport itself is drawn.
  const float before_near = camera.near > 0.0F ? std::nextafter(camera.near, 0.0F) : 0.0F;
  frame.eye = vec4(camera.eye, before_near);
  frame.look = vec4(camera.look, 0.0F);
  dispatch.sampling.w = is_orthographic ? 1 : 0;
  frame.right = vec4(vec3(right), 0.0F);
  frame.up = vec4(vec3(up), 0.0F);
  frame.film_center.x = 0.5F * static_cast<float>(size.x);
  frame.film_center.y = 0.5F * static_cast<float>(size.y);
}

/// Where a lane has several it does not wait for its neighbours'; but the device's cores want groups to share.
uint32_t pick_paths_a_lane(uint32_t blocks, const TileOptions& options) {
  if (options.wanted_groups == 0) return options.most_paths_a_lane;
  return std::clamp(blocks / options.wanted_groups, 1U, options.most_paths_a_lane);
}

}  // namespace

TileScheduler::TileScheduler(const layout::Frame& frame, const layout::Dispatch& dispatch, const View& view,
                             const PixelWindow& window, const TileOptions& options)
    : frame_(frame),
      dispatch_(dispatch),
      options_(options),
      samples_(view.samples_per_pixel),
      max_depth_(view.max_depth) {
  static_assert(kMaxBlocks <= 65535, "Vulkan's guaranteed workgroup count");
  assert(samples_ >= 1 && samples_ <= kMaxSamplesPerPixel);
  set_camera(frame_, dispatch_, view.camera, view.size);
  const uvec2 size = window.hi - window.lo;
  const uint32_t block_columns = divide_up(size.x, layout::BLOCK_SIZE);
  frame_.film_center.z = static_cast<float>(0.5 / samples_);
  dispatch_.window = uvec4(window.lo, size);
  dispatch_.sampling = uvec4(samples_, lattice_generator(samples_), block_columns, dispatch_.sampling.w);
  pixel_count_ = size.x * size.y;
  block_total_ = block_columns * divide_up(size.y, layout::BLOCK_SIZE);
}

double TileScheduler::fraction_done() const {
  return (first_block_ + block_count_ * (static_cast<double>(sample_) / samples_)) / block_total_;
}

TileSample TileScheduler::next(double units) {
  assert(!is_done());
  if (sample_ == 0) block_count_ = pick_block_count(units);
  const uint32_t paths_a_lane = pick_paths_a_lane(block_count_, options_);

  TileSample piece;
  piece.dispatch = dispatch_;
  piece.dispatch.range = uvec4(first_block_, first_block_ + block_count_, sample_, max_depth_);
  piece.dispatch.queue.w = paths_a_lane;
  piece.group_counts = {share_out(divide_up(block_count_, options_.packet_size), options_.most_parts),
                        uvec2(divide_up(block_count_, paths_a_lane), 1)};
  piece.units = block_count_;
  piece.most_rays_a_lane = (1.0 + max_depth_) * (1.0 + dispatch_.counts.z) * piece.units;

  ++sample_;
  if (sample_ == samples_) {
    first_block_ += block_count_;
    block_count_ = 0;
    sample_ = 0;
  }
  return piece;
}

uint32_t TileScheduler::pick_block_count(double units) const {
  const uint32_t remaining = block_total_ - first_block_;
  if (options_.blocks_per_piece > 0) return std::min({options_.blocks_per_piece, remaining, kMaxBlocks});
  const auto blocks = static_cast<uint32_t>(std::clamp(units, double{kMinBlocks}, double{kMaxBlocks}));
  return std::min(blocks, remaining);
}

}  // namespace promin
