// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/tile_scheduler.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/divide_up.h"
#include "device_scene/sampling.h"
#include "trace/kernels/group_rows.h"

namespace promin {

uint32_t refracted_rays(FeatureMask features) {
  if (features.has_any(layout::FEATURE_SCATTERING)) return 0;
  if (features.has_any(layout::FEATURE_DISPERSION)) return layout::COLORS;
  return features.has_any(layout::FEATURE_GLASS) ? 1 : 0;
}

uint32_t most_steps(uint32_t depth, uint32_t refracted_rays, uint32_t most_layers) {
  if (refracted_rays == 0) return depth + most_layers;
  // Number of rays below a surface that transmits light of all colours, and number below a surface that transmits a
  // single colour, whose rays are not divided further.
  uint32_t in_tree = 0;
  uint32_t of_color = 0;
  for (uint32_t bounce = 0; bounce < depth && in_tree < layout::MOST_TREE_RAYS; ++bounce) {
    in_tree = 1 + refracted_rays + in_tree + refracted_rays * of_color;
    of_color = 2 + 2 * of_color;
  }
  // Kernels with glass may trace scenes without glass, whose paths may have the full depth.
  return std::max(std::min(in_tree, layout::MOST_TREE_RAYS), depth) + most_layers;
}

TileScheduler::TileScheduler(const SceneConstants& scene, const View& view, const PixelWindow& window,
                             const TileOptions& options)
    : scene_(scene),
      view_(view),
      window_(window),
      options_(options),
      end_sample_(options.is_listed ? 1 : std::min(view.samples_per_pixel, options.end_sample)),
      lattice_generator_(lattice_generator(view.samples_per_pixel)),
      sample_(options.first_sample) {
  assert(sample_ < end_sample_);
  static_assert(TileOptions::kMaxBlocks <= 65535, "Vulkan's guaranteed workgroup count");
  assert(view.samples_per_pixel >= 1 && view.samples_per_pixel <= kMaxSamplesPerPixel);
  const uvec2 size = window.hi - window.lo;
  pixel_count_ = size.x * size.y;
  block_total_ = divide_up(size.x, layout::BLOCK_SIZE) * divide_up(size.y, layout::BLOCK_SIZE);
}

double TileScheduler::fraction_done() const {
  const double fraction_of_piece =
      static_cast<double>(sample_ - options_.first_sample) / (end_sample_ - options_.first_sample);
  return (first_block_ + block_count_ * fraction_of_piece) / block_total_;
}

TileSample TileScheduler::next(double units) {
  assert(!is_done());
  if (sample_ == options_.first_sample) block_count_ = pick_block_count(units);

  TileSample piece;
  piece.dispatch = make_tile_dispatch(scene_, view_, window_,
                                      {.first_block = first_block_,
                                       .end_block = first_block_ + block_count_,
                                       .sample = sample_,
                                       .sample_point = sample_point(view_, lattice_generator_, sample_)});
  piece.group_count = arrange_in_rows(divide_up(block_count_, options_.packet_size), options_.most_group_rows);
  piece.steps = most_steps(view_.max_depth, options_.refracted_rays, options_.most_layers);
  piece.depth = view_.max_depth;
  piece.units = block_count_;
  const double most_hits = 1.0 + piece.steps;
  piece.most_rays_a_lane = most_hits * (1.0 + std::max(scene_.light_count, scene_.direct_count)) *
                           (1.0 + options_.most_layers) * piece.units;

  ++sample_;
  if (sample_ == end_sample_) {
    first_block_ += block_count_;
    block_count_ = 0;
    sample_ = options_.first_sample;
  }
  return piece;
}

uint32_t TileScheduler::pick_block_count(double units) const {
  const uint32_t remaining = block_total_ - first_block_;
  if (options_.blocks_per_piece > 0) return std::min({options_.blocks_per_piece, remaining, options_.most_blocks});
  const auto most = static_cast<double>(options_.most_blocks);
  const auto blocks = static_cast<uint32_t>(std::clamp(units, std::min<double>(options_.least_blocks, most), most));
  return std::min(blocks, remaining);
}

}  // namespace promin
