// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/binning.h"

#include <algorithm>

namespace promin {

BinGrid::BinGrid(const LaneBox& centers, uint32_t count) : bin_count_(std::min(kMaxBins, 4 + count / 8)) {
  // The last centre must fall into the last bin, not beyond it: two roundings of 2^-24 each are less than 2^-20.
  const float slabs = static_cast<float>(bin_count_) * (1.0F - 0x1p-20F);
  const Lanes scale = fill_lanes(slabs) / (centers.hi - centers.lo);
  const IntLanes is_normal = (scale >= fill_lanes(std::numeric_limits<float>::min())) &
                             (scale <= fill_lanes(std::numeric_limits<float>::max()));
  origin_ = std::bit_cast<Lanes>(std::bit_cast<IntLanes>(centers.lo) & is_normal);
  scale_ = std::bit_cast<Lanes>(std::bit_cast<IntLanes>(scale) & is_normal);
}

Bins::Bins(const BinGrid& grid) {
  std::fill_n(&lo[0][0], 3 * grid.bin_count(), LaneBox().lo);
  std::fill_n(&hi[0][0], 3 * grid.bin_count(), LaneBox().hi);
  std::fill_n(&counts[0][0], 3 * grid.bin_count(), 0U);
}

void Bins::add(const BinGrid& grid, std::span<const Record> records) {
  for (const Record& record : records) {
    const IntLanes bins = grid.bins_of(record.center());
    for (int axis = 0; axis < 3; ++axis) {
      const int32_t bin = bins[axis];
      lo[bin][axis] = min(record.lo, lo[bin][axis]);
      hi[bin][axis] = max(record.hi, hi[bin][axis]);
      counts[bin][axis] += 1;
    }
  }
}

void Bins::add(const Bins& bins, const BinGrid& grid) {
  for (uint32_t bin = 0; bin < grid.bin_count(); ++bin) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[bin][axis] = min(bins.lo[bin][axis], lo[bin][axis]);
      hi[bin][axis] = max(bins.hi[bin][axis], hi[bin][axis]);
      counts[bin][axis] += bins.counts[bin][axis];
    }
  }
}

uint32_t Bins::count_below(const Split& split) const {
  uint32_t count = 0;
  for (uint32_t bin = 0; bin < split.bin; ++bin) count += counts[bin][split.axis];
  return count;
}

std::pair<LaneBox, LaneBox> Bins::boxes_of(const Split& split, const BinGrid& grid) const {
  std::pair<LaneBox, LaneBox> sides;
  if (!split.exists()) return sides;
  for (uint32_t bin = 0; bin < split.bin; ++bin) sides.first.extend(lo[bin][split.axis], hi[bin][split.axis]);
  for (uint32_t bin = split.bin; bin < grid.bin_count(); ++bin)
    sides.second.extend(lo[bin][split.axis], hi[bin][split.axis]);
  return sides;
}

Split find_best_split(const BinGrid& grid, const Bins& bins) {
  // First computes the cost of the records from bin b on, then the cost of the records below bin b: the two sides of
  // the plane below b. A side without records has the cost infinity times 0, a NaN, which every comparison rejects. A
  // branch would often be mispredicted.
  double costs_above[BinGrid::kMaxBins][3];
  LaneBox boxes[3];
  uint32_t counts[3] = {};
  for (uint32_t bin = grid.bin_count() - 1; bin > 0; --bin) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis].extend(bins.lo[bin][axis], bins.hi[bin][axis]);
      counts[axis] += bins.counts[bin][axis];
      costs_above[bin][axis] = boxes[axis].half_area() * counts[axis];
    }
  }
  std::fill_n(boxes, 3, LaneBox());
  std::fill_n(counts, 3, 0U);
  double least[3];
  uint32_t best_bins[3] = {};
  std::fill_n(least, 3, std::numeric_limits<double>::infinity());
  for (uint32_t bin = 1; bin < grid.bin_count(); ++bin) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis].extend(bins.lo[bin - 1][axis], bins.hi[bin - 1][axis]);
      counts[axis] += bins.counts[bin - 1][axis];
      const double cost = boxes[axis].half_area() * counts[axis] + costs_above[bin][axis];
      best_bins[axis] = cost < least[axis] ? bin : best_bins[axis];
      least[axis] = cost < least[axis] ? cost : least[axis];
    }
  }
  const auto axis = static_cast<int>(std::min_element(least, least + 3) - least);
  return best_bins[axis] > 0 ? Split{axis, best_bins[axis], least[axis]} : Split();
}

Split find_best_split(const BinGrid& grid, const Record& a, const Record& b) {
  // If their centres differ, one record is in the first bin and the other in the last.
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.is_divided(axis)) return {axis, 1, LaneBox{a.lo, a.hi}.half_area() + LaneBox{b.lo, b.hi}.half_area()};
  }
  return {};
}

}  // namespace promin
