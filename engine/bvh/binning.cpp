// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/binning.h"

#include <algorithm>
#include <cmath>

namespace promin {

BinGrid::BinGrid(const LaneBox& centers, uint32_t count) : bin_count_(std::min(kMaxBins, 4 + count / 8)) {
  // The last centre must fall into the last bin, not beyond it: two roundings of 2^-24 each are less than 2^-20.
  const float slabs = static_cast<float>(bin_count_) * (1.0F - 0x1p-20F);
  for (int axis = 0; axis < 3; ++axis) {
    const float scale = slabs / (centers.hi[axis] - centers.lo[axis]);
    if (!std::isnormal(scale)) continue;
    origin_[axis] = centers.lo[axis];
    scale_[axis] = scale;
  }
}

Bins::Bins(const BinGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(boxes[axis], grid.bin_count(), LaneBox{});
    std::fill_n(counts[axis], grid.bin_count(), 0U);
  }
}

void Bins::add(const BinGrid& grid, std::span<const Record> records) {
  for (const Record& record : records) {
    const Lanes center = record.center();
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t bin = grid.bin_of(center, axis);
      boxes[axis][bin].extend(record.lo, record.hi);
      counts[axis][bin] += 1;
    }
  }
}

void Bins::add(const Bins& bins, const BinGrid& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t bin = 0; bin < grid.bin_count(); ++bin) {
      boxes[axis][bin].extend(bins.boxes[axis][bin]);
      counts[axis][bin] += bins.counts[axis][bin];
    }
  }
}

double Bins::overlap_of(const Split& split, const BinGrid& grid) const {
  if (!split.exists()) return std::numeric_limits<double>::infinity();
  LaneBox below;
  LaneBox above;
  for (uint32_t bin = 0; bin < split.bin; ++bin) below.extend(boxes[split.axis][bin]);
  for (uint32_t bin = split.bin; bin < grid.bin_count(); ++bin) above.extend(boxes[split.axis][bin]);
  return LaneBox{max(below.lo, above.lo), min(below.hi, above.hi)}.bounds().half_area();
}

Split find_best_split(const BinGrid& grid, const Bins& bins) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid.is_divided(axis)) continue;
    // Cost of everything from bin b on, then of everything below b: both sides of the plane below b.
    double cost_above[BinGrid::kMaxBins];
    LaneBox box;
    uint32_t count = 0;
    for (uint32_t bin = grid.bin_count() - 1; bin > 0; --bin) {
      box.extend(bins.boxes[axis][bin]);
      count += bins.counts[axis][bin];
      cost_above[bin] = count > 0 ? box.half_area() * count : std::numeric_limits<double>::infinity();
    }
    box = {};
    count = 0;
    for (uint32_t bin = 1; bin < grid.bin_count(); ++bin) {
      box.extend(bins.boxes[axis][bin - 1]);
      count += bins.counts[axis][bin - 1];
      if (count == 0) continue;
      const double cost = box.half_area() * count + cost_above[bin];
      if (cost < best.cost) best = {axis, bin, cost};
    }
  }
  return best;
}

}  // namespace promin
