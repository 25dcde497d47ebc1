// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "layout.h"
#include "render/view.h"

namespace promin {

/// One dispatch of a picture.
struct PicturePiece {
  layout::Dispatch dispatch{};
  uint32_t group_count = 0;
  /// What it takes: blocks of 8x8 pixels times samples.
  double units = 0.0;
  /// Most rays that a lane may count in it.
  double most_rays_a_lane = 0.0;
};

struct PieceOptions {
  /// Workgroups among which a piece is shared out at least, before one takes several blocks; 0: each takes one.
  uint32_t wanted_groups = 0;
  /// With wanted groups: samples that a lane takes at most, of one pixel or of several. llvmpipe lets a lane's loops
  /// turn 65535 times, all together (shaders/loop_check.glsl).
  uint32_t most_samples_a_lane = 16;
  /// Fixed number of blocks a piece, for tests of tile independence; 0 follows the units asked for.
  uint32_t blocks_per_piece = 0;
};

/// A picture cut into dispatches, a range of blocks and of samples each. Every cut gives the same bits. Vulkan-free.
class PicturePieces {
 public:
  /// Of `window` of the picture. `frame` and `dispatch` hold what they take from the scene (PackedScene).
  PicturePieces(const layout::Frame& frame, const layout::Dispatch& dispatch, const View& view,
                const PixelWindow& window, const PieceOptions& options = {});

  /// The constants that all pieces share.
  const layout::Frame& frame() const { return frame_; }
  uint32_t pixel_count() const { return pixel_count_; }
  bool is_done() const { return first_block_ == block_total_; }
  double fraction_done() const;

  /// The next piece, of about `units`; at least kMinBlocks blocks, which keep a device's cores busy. Not when done.
  PicturePiece next(double units);

  static constexpr uint32_t kMinBlocks = 64;

 private:
  uint32_t pick_block_count(double units) const;

  layout::Frame frame_;
  layout::Dispatch dispatch_;
  PieceOptions options_;
  uint32_t samples_;
  uint32_t max_depth_;
  uint32_t pixel_count_;
  uint32_t block_total_;
  uint32_t first_block_ = 0;
  /// Of the blocks under way, and of these the samples taken.
  uint32_t block_count_ = 0;
  uint32_t first_sample_ = 0;
};

}  // namespace promin
