// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "bvh/binning.h"
#include "bvh/builders.h"
#include "core/parallel.h"
#include "core/shared_progress.h"

// The builder splits large sets of references one after the other; all threads work on one set, in chunks of fixed
// size. A small set becomes a subtree in one task. The results of chunks and subtrees are combined in their order.
namespace promin {
namespace {

constexpr size_t kSpatialChunkSize = 4096;
constexpr size_t kSpatialSubtreeSize = 16384;

/// If the children of the best object split overlap by less than this fraction of the root's area, the builder does not
/// consider planes through primitives (Stich et al., section 4.2; there 1e-5).
constexpr double kLeastOverlap = 1e-4;

/// A cut is used even if it costs up to this factor more than the best object split. The heuristic treats the two sides
/// as leaves, but sides that do not overlap can be split better further down. The factor was measured
/// (docs/performance_log.md).
constexpr double kCutAdvantage = 1.1;

/// Returns the box of the part of a record's primitive below or above a plane.
LaneBox clip_record(const Record& record, const BuildInput& input, int axis, float lo, float hi) {
  Bounds window = record.bounds();
  window.lo[axis] = std::max(window.lo[axis], lo);
  window.hi[axis] = std::min(window.hi[axis], hi);
  const Bounds part = input.clip(record.index(), window);
  return {Record(part, 0).lo, Record(part, 0).hi};
}

/// Planes at equal distances in a box, along each axis.
class PlaneGrid {
 public:
  static constexpr uint32_t kMaxSlabs = 32;

  PlaneGrid(const LaneBox& box, size_t count)
      : slab_count_(static_cast<uint32_t>(std::min<size_t>(kMaxSlabs, 4 + count / 16))) {
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = box.lo[axis];
      const double step = (static_cast<double>(box.hi[axis]) - lo) / slab_count_;
      for (uint32_t i = 0; i < slab_count_; ++i) planes_[axis][i] = static_cast<float>(lo + i * step);
      scale_[axis] = step > 0.0 ? 1.0 / step : 0.0;
    }
  }

  uint32_t slab_count() const { return slab_count_; }
  bool is_divided(int axis) const { return scale_[axis] > 0.0; }
  /// Returns the lower side of a slab.
  float plane(int axis, uint32_t slab) const { return planes_[axis][slab]; }
  /// Returns the slab that contains a coordinate in the box. On the plane between two slabs it returns the upper one.
  uint32_t slab_above(float x, int axis) const {
    uint32_t slab = guess_slab(x, axis);
    while (slab > 0 && x < planes_[axis][slab]) --slab;
    while (slab + 1 < slab_count_ && x >= planes_[axis][slab + 1]) ++slab;
    return slab;
  }
  /// Returns the slab that contains a coordinate in the box. On the plane between two slabs it returns the lower one.
  uint32_t slab_below(float x, int axis) const {
    uint32_t slab = guess_slab(x, axis);
    while (slab > 0 && x <= planes_[axis][slab]) --slab;
    while (slab + 1 < slab_count_ && x > planes_[axis][slab + 1]) ++slab;
    return slab;
  }

 private:
  uint32_t guess_slab(float x, int axis) const {
    const double distance = static_cast<double>(x) - static_cast<double>(planes_[axis][0]);
    return std::min(slab_count_ - 1, static_cast<uint32_t>(distance * scale_[axis]));
  }

  uint32_t slab_count_;
  float planes_[3][kMaxSlabs];
  double scale_[3];
};

/// A plane between slabs that cuts primitives.
struct Cut {
  int axis = -1;
  float plane = 0.0F;
  /// The boxes of the two sides.
  LaneBox below;
  LaneBox above;
  uint32_t below_count = 0;
  uint32_t above_count = 0;
  double cost = std::numeric_limits<double>::infinity();

  bool exists() const { return axis >= 0; }
};

/// The boxes of the primitives' parts in every slab of a grid.
struct Slabs {
  LaneBox boxes[3][PlaneGrid::kMaxSlabs];
  /// Numbers of records for each slab: `entries` counts records whose first slab it is, and `exits` records whose last
  /// slab it is.
  uint32_t entries[3][PlaneGrid::kMaxSlabs] = {};
  uint32_t exits[3][PlaneGrid::kMaxSlabs] = {};

  void add(const PlaneGrid& grid, std::span<const Record> records, const BuildInput& input) {
    for (const Record& record : records) {
      for (int axis = 0; axis < 3; ++axis) {
        if (!grid.is_divided(axis)) continue;
        const uint32_t first = grid.slab_above(record.lo[axis], axis);
        const uint32_t last = std::max(first, grid.slab_below(record.hi[axis], axis));
        entries[axis][first] += 1;
        exits[axis][last] += 1;
        if (first == last) {
          boxes[axis][first].extend(record.lo, record.hi);
          continue;
        }
        for (uint32_t slab = first; slab <= last; ++slab) {
          const float lo = grid.plane(axis, slab);
          const float hi = slab < last ? grid.plane(axis, slab + 1) : record.hi[axis];
          boxes[axis][slab].extend(clip_record(record, input, axis, lo, hi));
        }
      }
    }
  }

  void add(const Slabs& slabs, const PlaneGrid& grid) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t slab = 0; slab < grid.slab_count(); ++slab) {
        boxes[axis][slab].extend(slabs.boxes[axis][slab]);
        entries[axis][slab] += slabs.entries[axis][slab];
        exits[axis][slab] += slabs.exits[axis][slab];
      }
    }
  }
};

/// Returns the cheapest plane that makes at most `max_count` references. If several planes are equally cheap, it
/// returns the first by axis, then the lowest.
Cut find_best_cut(const PlaneGrid& grid, const Slabs& slabs, size_t max_count) {
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid.is_divided(axis)) continue;
    LaneBox boxes_above[PlaneGrid::kMaxSlabs];
    uint32_t counts_above[PlaneGrid::kMaxSlabs];
    LaneBox box;
    uint32_t count = 0;
    for (uint32_t slab = grid.slab_count() - 1; slab > 0; --slab) {
      box.extend(slabs.boxes[axis][slab]);
      boxes_above[slab] = box;
      counts_above[slab] = count += slabs.exits[axis][slab];
    }
    box = {};
    count = 0;
    for (uint32_t slab = 1; slab < grid.slab_count(); ++slab) {
      box.extend(slabs.boxes[axis][slab - 1]);
      count += slabs.entries[axis][slab - 1];
      if (count == 0 || counts_above[slab] == 0 || count + counts_above[slab] > max_count) continue;
      const double cost = box.half_area() * count + boxes_above[slab].half_area() * counts_above[slab];
      if (!(cost < best.cost)) continue;
      best = {axis, grid.plane(axis, slab), box, boxes_above[slab], count, counts_above[slab], cost};
    }
  }
  return best;
}

/// Returns half the area of the intersection of two boxes.
double overlap_of(const LaneBox& a, const LaneBox& b) {
  return LaneBox{max(a.lo, b.lo), min(a.hi, b.hi)}.bounds().half_area();
}

LaneBox unite(LaneBox a, const LaneBox& b) {
  a.extend(b);
  return a;
}

/// References on one side of a plane, and their bounds.
struct Side {
  std::vector<Record> records;
  Extent extent;

  void add(const Record& record) {
    records.push_back(record);
    extent.extend(record);
  }
  void add(const Side& side) {
    records.insert(records.end(), side.records.begin(), side.records.end());
    extent.extend(side.extent);
  }
};

struct Sides {
  Side below;
  Side above;

  bool are_filled() const { return !below.records.empty() && !above.records.empty(); }
};

/// Puts a record on its side of the plane. A record that the plane cuts goes to both sides or, if that costs less,
/// completely to one (Stich et al., section 4.4).
void cut_record(const Record& record, const Cut& cut, const BuildInput& input, Sides& sides) {
  const float lo = record.lo[cut.axis];
  const float hi = record.hi[cut.axis];
  if (lo >= cut.plane) return sides.above.add(record);
  if (hi <= cut.plane) return sides.below.add(record);
  const double below = cut.below.half_area();
  const double above = cut.above.half_area();
  const LaneBox whole{record.lo, record.hi};
  const double cost_of_both = below * cut.below_count + above * cut.above_count;
  const double cost_below = unite(cut.below, whole).half_area() * cut.below_count + above * (cut.above_count - 1);
  const double cost_above = below * (cut.below_count - 1) + unite(cut.above, whole).half_area() * cut.above_count;
  if (cost_below < cost_of_both && cost_below <= cost_above) return sides.below.add(record);
  if (cost_above < cost_of_both) return sides.above.add(record);
  const LaneBox part_below = clip_record(record, input, cut.axis, lo, cut.plane);
  const LaneBox part_above = clip_record(record, input, cut.axis, cut.plane, hi);
  if (!part_below.is_empty()) sides.below.add(Record(part_below.bounds(), record.index()));
  if (!part_above.is_empty()) sides.above.add(Record(part_above.bounds(), record.index()));
}

/// The references of a node that has not been made. `node` is its index and `depth` its depth (1 for the root).
struct Task {
  Side side;
  uint32_t node = 0;
  uint32_t depth = 1;
  /// The number of references that cutting may add below this node.
  size_t spare = 0;

  size_t count() const { return side.records.size(); }
};

class SpatialBuild {
 public:
  SpatialBuild(const BuildInput& input, const BuildOptions& options)
      : input_(input), thread_count_(options.thread_count), progress_(options.progress) {}

  Bvh run() {
    const size_t count = input_.boxes.size();
    Task root;
    root.spare = (kMaxReferencesPerPrimitive - 1) * count;
    root.side.records.reserve(count);
    for (uint32_t i = 0; i < count; ++i) root.side.add(Record(input_.boxes[i], i));
    root_area_ = root.side.extent.box.half_area();

    Bvh top;
    std::vector<Task> subtrees;
    build(std::move(root), thread_count_, top, &subtrees);
    size_t record_count = 1;
    for (const Task& task : subtrees) record_count += task.count();
    SharedProgress progress(progress_, static_cast<double>(record_count));
    std::vector<Bvh> built(subtrees.size());
    for_each_index(subtrees.size(), thread_count_, [&](size_t i) {
      Task task = std::move(subtrees[i]);
      subtrees[i].node = std::exchange(task.node, 0);
      const auto records = static_cast<double>(task.count());
      build(std::move(task), 1, built[i], nullptr);
      progress.add(records);
    });
    for (size_t i = 0; i < subtrees.size(); ++i) append(built[i], subtrees[i].node, top);
    return top;
  }

 private:
  /// Builds the tree below one task on `thread_count` threads. Small sets are added to `subtrees` unless it is null.
  void build(Task root, unsigned thread_count, Bvh& bvh, std::vector<Task>* subtrees) const;
  /// Splits the references of a task in two. Returns nullopt if a leaf is cheaper.
  std::optional<Sides> split(const Task& task, unsigned thread_count) const;
  Sides halve(const Side& side) const;
  static void append(const Bvh& subtree, uint32_t root, Bvh& bvh);

  const BuildInput& input_;
  unsigned thread_count_;
  const ProgressCallback& progress_;
  double root_area_ = 0.0;
};

/// Calls work(chunk, part) for each chunk of the records on these threads, and returns the parts in order.
template <typename Part, typename Work>
std::vector<Part> make_parts_of(std::span<const Record> records, unsigned thread_count, const Part& initial,
                                const Work& work) {
  return make_parts(records.size(), kSpatialChunkSize, thread_count, initial,
                    [&](size_t begin, size_t end, Part& part) { work(records.subspan(begin, end - begin), part); });
}

Sides SpatialBuild::halve(const Side& side) const {
  Sides sides;
  for (size_t i = 0; i < side.records.size(); ++i) {
    (i < side.records.size() / 2 ? sides.below : sides.above).add(side.records[i]);
  }
  return sides;
}

std::optional<Sides> SpatialBuild::split(const Task& task, unsigned thread_count) const {
  const Side& side = task.side;
  const auto count = static_cast<uint32_t>(task.count());
  if (count == 1) return std::nullopt;
  const LaneBox& box = side.extent.box;
  Split split;
  Cut cut;
  const BinGrid bin_grid(side.extent.centers, count);
  if (task.depth < kMaxSahDepth) {
    Bins bins(bin_grid);
    for (const Bins& part : make_parts_of(side.records, thread_count, Bins(bin_grid),
                                          [&](auto records, auto&result) { result.add(bin_grid, records); })) {
      bins.add(part, bin_grid);
    }
    split = find_best_split(bin_grid, bins);
    const auto [below, above] = bins.boxes_of(split, bin_grid);
    if (input_.clip && (!split.exists() || overlap_of(below, above) >= kLeastOverlap * root_area_)) {
      const PlaneGrid grid(box, count);
      Slabs slabs;
      for (const Slabs& part : make_parts_of(side.records, thread_count, Slabs(),
                                             [&](auto records, auto&result) { result.add(grid, records, input_); })) {
        slabs.add(part, grid);
      }
      cut = find_best_cut(grid, slabs, count + task.spare);
    }
  }
  const double area = box.half_area();
  const bool pays = kNodeCost * area + kTestCost * std::min(split.cost, cut.cost) < kTestCost * area * count;
  if (count <= kMaxLeafSize && !pays) return std::nullopt;

  const auto distribute = [&](const auto& put) {
    Sides sides;
    for (const Sides& part : make_parts_of(side.records, thread_count, Sides(), [&](auto records, auto&result) {
           for (const Record& record : records) put(record, result);
         })) {
      sides.below.add(part.below);
      sides.above.add(part.above);
    }
    return sides;
  };
  if (cut.cost < kCutAdvantage * split.cost) {
    Sides sides = distribute([&](const Record& record, Sides& result) { cut_record(record, cut, input_, result); });
    if (sides.are_filled()) return sides;
  }
  if (!split.exists()) return halve(side);
  return distribute([&](const Record& record, Sides& result) {
    (is_below(record.center(), bin_grid, split) ? result.below : result.above).add(record);
  });
}

void SpatialBuild::build(Task root, unsigned thread_count, Bvh& bvh, std::vector<Task>* subtrees) const {
  bvh.nodes.resize(1);
  std::vector<Task> open;
  open.push_back(std::move(root));
  while (!open.empty()) {
    Task task = std::move(open.back());
    open.pop_back();
    if (subtrees != nullptr && task.count() <= kSpatialSubtreeSize) {
      subtrees->push_back(std::move(task));
      continue;
    }
    // The progress is still 0, but this call allows the callback to cancel the build.
    if (subtrees != nullptr && progress_) progress_(0.0);
    std::optional<Sides> sides = split(task, thread_count);
    const Bounds bounds = task.side.extent.box.bounds();
    if (!sides) {
      bvh.nodes[task.node] = {bounds, static_cast<uint32_t>(bvh.references.size()),
                              static_cast<uint32_t>(task.count())};
      for (const Record& record : task.side.records) bvh.references.push_back(record.index());
      continue;
    }
    const auto child = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes[task.node] = {bounds, child, 0};
    bvh.nodes.resize(bvh.nodes.size() + 2);
    const size_t below = sides->below.records.size();
    const size_t both = below + sides->above.records.size();
    // Parts without a point are dropped, so `both` may even be smaller than the number before the cut.
    const size_t spare = task.spare + task.count() - both;
    const size_t spare_below = spare * below / both;
    open.push_back({std::move(sides->above), child + 1, task.depth + 1, spare - spare_below});
    open.push_back({std::move(sides->below), child, task.depth + 1, spare_below});
  }
}

/// Copies a subtree into the tree: its root becomes node `root`, and its other nodes are appended.
void SpatialBuild::append(const Bvh& subtree, uint32_t root, Bvh& bvh) {
  const auto node_shift = static_cast<uint32_t>(bvh.nodes.size()) - 1;
  const auto reference_shift = static_cast<uint32_t>(bvh.references.size());
  const auto shift = [&](BvhNode node) {
    node.first += node.count == 0 ? node_shift : reference_shift;
    return node;
  };
  bvh.nodes[root] = shift(subtree.nodes.front());
  std::transform(subtree.nodes.begin() + 1, subtree.nodes.end(), std::back_inserter(bvh.nodes), shift);
  bvh.references.insert(bvh.references.end(), subtree.references.begin(), subtree.references.end());
}

}  // namespace

Bvh build_spatial(const BuildInput& input, const BuildOptions& options) {
  // The approximate fraction of the time that the build with cuts takes.
  constexpr double kCutShare = 0.9;
  BuildOptions of_cut = options;
  BuildOptions of_whole = options;
  if (options.progress) {
    of_cut.progress = [&](double fraction) { return options.progress(kCutShare * fraction); };
    of_whole.progress = [&](double fraction) { return options.progress(kCutShare + (1.0 - kCutShare) * fraction); };
  }
  Bvh cut = SpatialBuild(input, of_cut).run();
  // Cutting is greedy and not always better. In a few scenes the tree without cuts costs less.
  Bvh whole = build_sah(input, of_whole);
  return measure_bvh("", whole).sah_cost < measure_bvh("", cut).sah_cost ? whole : cut;
}

}  // namespace promin
