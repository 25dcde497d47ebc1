// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "promin/math.h"

// Inner loops of the SAH builder: boxes that fill whole registers, the bins of boxes, and the best plane between bins.
namespace promin {

/// Four floats in one register (vector extension of GCC and Clang): x, y, z and an unused lane.
using Lanes = float __attribute__((vector_size(16)));
using IntLanes = int32_t __attribute__((vector_size(16)));
using DoubleLanes = double __attribute__((vector_size(32)));

inline Lanes min(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes fill_lanes(float x) {
  return Lanes{x, x, x, x};
}
inline Lanes clear_spare_lane(Lanes a) {
  return std::bit_cast<Lanes>(std::bit_cast<IntLanes>(a) & IntLanes{-1, -1, -1, 0});
}

/// A box in registers, empty by default.
struct LaneBox {
  Lanes lo = fill_lanes(std::numeric_limits<float>::infinity());
  Lanes hi = fill_lanes(-std::numeric_limits<float>::infinity());

  void extend(Lanes low, Lanes high) {
    lo = min(low, lo);
    hi = max(high, hi);
  }
  void extend(const LaneBox& box) { extend(box.lo, box.hi); }
  /// Returns half the surface area of a box that is not empty. Computes in double, because fp32 would overflow for
  /// coordinates of 1e19 or more.
  double half_area() const {
    // Clears the spare lane before the conversion: it may hold an index, and most indices are subnormal as floats and
    // slow to convert.
    const DoubleLanes size = __builtin_convertvector(clear_spare_lane(hi), DoubleLanes) -
                             __builtin_convertvector(clear_spare_lane(lo), DoubleLanes);
    return size[0] * size[1] + (size[1] + size[0]) * size[2];
  }
  bool is_empty() const { return bounds().is_empty(); }
  Bounds bounds() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// A box to sort into the tree; the spare lane holds its index in the builder's input. The members have no default
/// values, so that the threads that fill an array of millions are the first to touch its memory.
struct Record {
  Lanes lo;
  Lanes hi;

  Record() = default;
  Record(const Bounds& bounds, uint32_t index)
      : lo{bounds.lo.x, bounds.lo.y, bounds.lo.z, std::bit_cast<float>(index)},
        hi{bounds.hi.x, bounds.hi.y, bounds.hi.z, 0.0F} {}

  Bounds bounds() const { return LaneBox{lo, hi}.bounds(); }
  uint32_t index() const { return std::bit_cast<uint32_t>(static_cast<float>(lo[3])); }
  /// The coordinates are halved before they are added, because the sum could overflow. The spare lane is cleared,
  /// because most indices are subnormal as floats and arithmetic on those is slow.
  Lanes center() const { return fill_lanes(0.5F) * clear_spare_lane(lo) + fill_lanes(0.5F) * hi; }
};

/// The bounds of a set of records: their common box and the box of their centres.
struct Extent {
  LaneBox box;
  LaneBox centers;

  void extend(const Record& record) {
    const Lanes center = record.center();
    box.extend(record.lo, record.hi);
    centers.extend(center, center);
  }
  void extend(const Extent& extent) {
    box.extend(extent.box);
    centers.extend(extent.centers);
  }
};

/// Divides the box of the centres into slabs of equal thickness along each axis.
class BinGrid {
 public:
  static constexpr uint32_t kMaxBins = 32;

  /// Creates a grid for `count` records whose centres lie in this box. Few records get few bins.
  BinGrid(const LaneBox& centers, uint32_t count);

  uint32_t bin_count() const { return bin_count_; }
  /// Returns false if the centres coincide, or are too close together or too far apart for a float. All records are
  /// then in bin 0.
  bool is_divided(int axis) const { return scale_[axis] > 0.0F; }
  /// Returns the bin of a centre on each axis; the spare lane has no meaning.
  IntLanes bins_of(Lanes center) const { return __builtin_convertvector((center - origin_) * scale_, IntLanes); }

 private:
  Lanes origin_{};
  Lanes scale_{};
  uint32_t bin_count_;
};

/// A plane that divides records: the lower side of bin `bin` along `axis`.
struct Split {
  int axis = -1;
  uint32_t bin = 0;
  /// Sum over both sides of half the area times the number of records; infinite if no plane has records on both sides.
  double cost = std::numeric_limits<double>::infinity();

  bool exists() const { return axis >= 0; }
};

inline bool is_below(Lanes center, const BinGrid& grid, const Split& split) {
  return static_cast<uint32_t>(grid.bins_of(center)[split.axis]) < split.bin;
}

/// Boxes and numbers of the records in every bin of a grid, indexed by bin and axis.
struct Bins {
  // The arrays do not hold LaneBox, because its default constructor would set all elements to empty boxes.
  Lanes lo[BinGrid::kMaxBins][3];
  Lanes hi[BinGrid::kMaxBins][3];
  uint32_t counts[BinGrid::kMaxBins][3];

  explicit Bins(const BinGrid& grid);
  void add(const BinGrid& grid, std::span<const Record> records);
  void add(const Bins& bins, const BinGrid& grid);
  uint32_t count_below(const Split& split) const;
  /// Returns the boxes of the records below and above the plane; empty if there is no plane.
  std::pair<LaneBox, LaneBox> boxes_of(const Split& split, const BinGrid& grid) const;
};

/// Returns the split that find_best_split would find in the bins of two records.
Split find_best_split(const BinGrid& grid, const Record& a, const Record& b);

/// Returns the cheapest plane. If several planes are equally cheap, it returns the first by axis, then by bin.
Split find_best_split(const BinGrid& grid, const Bins& bins);

}  // namespace promin
