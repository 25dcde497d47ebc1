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
  std::fill_n(&boxes[0][0], 3 * grid.bin_count(), LaneBox{});
  std::fill_n(&counts[0][0], 3 * grid.bin_count(), 0U);
}

void Bins::add(const BinGrid& grid, std::span<const Record> records) {
  for (const Record& record : records) {
    const IntLanes bins = grid.bins_of(record.center());
    for (int axis = 0; axis < 3; ++axis) {
      boxes[bins[axis]][axis].extend(record.lo, record.hi);
      counts[bins[axis]][axis] += 1;
    }
  }
}

void Bins::add(const Bins& bins, const BinGrid& grid) {
  for (uint32_t bin = 0; bin < grid.bin_count(); ++bin) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[bin][axis].extend(bins.boxes[bin][axis]);
      counts[bin][axis] += bins.counts[bin][axis];
    }
  }
}

uint32_t Bins::count_below(const Split& split) const {
  uint32_t count = 0;
  for (uint32_t bin = 0; bin < split.bin; ++bin) count += counts[bin][split.axis];
  return count;
}

double Bins::overlap_of(const Split& split, const BinGrid& grid) const {
  if (!split.exists()) return std::numeric_limits<double>::infinity();
  LaneBox below;
  LaneBox above;
  for (uint32_t bin = 0; bin < split.bin; ++bin) below.extend(boxes[bin][split.axis]);
  for (uint32_t bin = split.bin; bin < grid.bin_count(); ++bin) above.extend(boxes[bin][split.axis]);
  return LaneBox{max(below.lo, above.lo), min(below.hi, above.hi)}.bounds().half_area();
}

Split find_best_split(const BinGrid& grid, const Bins& bins) {
  // Cost of everything from bin b on, then of everything below b: both sides of the plane below b. A bin without
  // records has no plane of its own.
  double costs_above[BinGrid::kMaxBins][3];
  LaneBox boxes[3];
  uint32_t counts[3] = {};
  double costs[3];
  std::fill_n(costs, 3, std::numeric_limits<double>::infinity());
  for (uint32_t bin = grid.bin_count() - 1; bin > 0; --bin) {
    for (int axis = 0; axis < 3; ++axis) {
      if (bins.counts[bin][axis] > 0) {
        boxes[axis].extend(bins.boxes[bin][axis]);
        counts[axis] += bins.counts[bin][axis];
        costs[axis] = boxes[axis].half_area() * counts[axis];
      }
      costs_above[bin][axis] = costs[axis];
    }
  }
  Split best[3];
  std::fill_n(boxes, 3, LaneBox());
  std::fill_n(counts, 3, 0U);
  for (uint32_t bin = 1; bin < grid.bin_count(); ++bin) {
    for (int axis = 0; axis < 3; ++axis) {
      if (bins.counts[bin - 1][axis] == 0) continue;
      boxes[axis].extend(bins.boxes[bin - 1][axis]);
      counts[axis] += bins.counts[bin - 1][axis];
      const double cost = boxes[axis].half_area() * counts[axis] + costs_above[bin][axis];
      if (cost < best[axis].cost) best[axis] = {axis, bin, cost};
    }
  }
  return *std::min_element(best, best + 3, [](const Split& a, const Split& b) { return a.cost < b.cost; });
}

Split find_best_split(const BinGrid& grid, const Record& a, const Record& b) {
  // Wherever their centres differ they are in the first bin and the last.
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.is_divided(axis)) return {axis, 1, LaneBox{a.lo, a.hi}.half_area() + LaneBox{b.lo, b.hi}.half_area()};
  }
  return {};
}

}  // namespace promin
