// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "device_scene/scene_constants.h"
#include "promin/view.h"
#include "scene/features.h"
#include "shared/layout.h"

namespace promin {

/// A piece of work: one sample of each pixel of some blocks. It is one dispatch of the camera stage and of each later
/// stage.
struct TileSample {
  layout::Dispatch dispatch{};
  /// Number of workgroups of shaders/picture/camera_stage.comp; y is the number of rows.
  uvec2 group_count{0};
  /// The largest number of rays that follow a camera ray.
  uint32_t steps = 0;
  /// Depth of the view.
  uint32_t depth = 0;
  /// The amount of work, counted in blocks of 8x8 pixels.
  double units = 0.0;
  /// The largest number of rays that a lane may count in this piece.
  double most_rays_a_lane = 0.0;
};

struct TileOptions {
  static constexpr uint32_t kMaxBlocks = 8192;
  /// Number of blocks that is enough to keep a device's cores busy.
  static constexpr uint32_t kLeastBlocks = 64;
  /// Number of blocks that is enough with glass, where a piece takes many turns of the stream, most of them with few
  /// rays.
  static constexpr uint32_t kLeastBlocksOfTrees = 1024;

  /// The number of pixels that a lane of the camera stage traces together (PACKET_SIZE): 1, 2 or 4.
  uint32_t packet_size = 1;
  /// The largest number of rows of workgroups; see trace/kernels/group_rows.h.
  uint32_t most_group_rows = 1;
  /// The smallest and the largest number of blocks of a piece; at most kMaxBlocks.
  uint32_t least_blocks = kLeastBlocks;
  uint32_t most_blocks = kMaxBlocks;
  /// Largest number of surfaces that a ray passes through because they blend.
  uint32_t most_layers = 0;
  /// Largest number of rays that a surface transmits (refracted_rays).
  uint32_t refracted_rays = 0;
  /// The range of the view's samples of each pixel to trace: [first, end).
  uint32_t first_sample = 0;
  /// True if the sums begin with the first sample even if it is not sample 0.
  bool begins_sums = false;
  uint32_t end_sample = kMaxSamplesPerPixel;
  /// True if each pixel is a sample of a list (FEATURE_LISTED_SAMPLES). Such a sample is traced once.
  bool is_listed = false;
  /// A fixed number of blocks per piece, for tests that tiles do not change bits. If 0, the requested units determine
  /// the number.
  uint32_t blocks_per_piece = 0;
};

/// Returns the largest number of rays that a surface transmits, in addition to its mirror ray: one for glass, or one
/// for each colour with dispersion (shaders/picture/tree.glsl).
uint32_t refracted_rays(FeatureMask features);

/// Returns the largest number of rays of a sample after the camera ray: mirror rays, refracted rays, and continuations
/// behind surfaces.
uint32_t most_steps(uint32_t depth, uint32_t refracted_rays, uint32_t most_layers);

/// Divides a picture into pieces. A piece is a range of blocks and one sample of each of its pixels. Every division
/// gives the same bits. This code does not use Vulkan.
class TileScheduler {
 public:
  /// Divides `window` of the view's picture.
  TileScheduler(const SceneConstants& scene, const View& view, const PixelWindow& window,
                const TileOptions& options = {});

  /// Returns the constants that all pieces share.
  layout::ViewConstants view_constants() const { return make_view_constants(scene_, view_); }
  uint32_t pixel_count() const { return pixel_count_; }
  /// Returns whether the sums of each pixel begin with these pieces.
  bool begins_sums() const { return options_.first_sample == 0 || options_.begins_sums; }
  /// Returns whether the pieces begin the sums without sample 0, which initialises the sums of colours.
  bool begins_without_first() const { return options_.first_sample != 0 && options_.begins_sums; }
  bool is_done() const { return first_block_ == block_total_; }
  double fraction_done() const;

  /// Returns the next piece. It has about `units`, but is not smaller than the smallest piece. Must not be called after
  /// the last piece.
  TileSample next(double units);

  static constexpr uint32_t kMinBlocks = TileOptions::kLeastBlocks;

 private:
  uint32_t pick_block_count(double units) const;

  SceneConstants scene_;
  View view_;
  PixelWindow window_;
  TileOptions options_;
  uint32_t end_sample_;
  uint32_t lattice_generator_;
  uint32_t pixel_count_;
  uint32_t block_total_;
  uint32_t first_block_ = 0;
  /// The number of blocks in the current range, and the next sample of these blocks.
  uint32_t block_count_ = 0;
  uint32_t sample_;
};

}  // namespace promin
