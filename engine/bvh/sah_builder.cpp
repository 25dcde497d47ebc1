// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "bvh/binning.h"
#include "bvh/builders.h"
#include "core/parallel.h"
#include "core/shared_progress.h"

// The builder has two phases. The first phase splits the top of the tree breadth first: the ranges of one level are cut
// into chunks, which all threads bin and scatter. The second phase builds each range below kSahSubtreeSize as a subtree
// in one task; the subtrees are appended to the top in their order. The tree does not depend on the assignment of work
// to threads: chunks and subtrees have fixed sizes, and their results are merged in order.
namespace promin {
namespace {

constexpr uint32_t kSahChunkSize = 8192;
constexpr uint32_t kSahSubtreeSize = 16384;

/// The records [begin, end) of a node that has not been made. `node` is its index and `depth` its depth (1 for the
/// root).
struct Range {
  uint32_t begin = 0;
  uint32_t end = 0;
  uint32_t node = 0;
  uint32_t depth = 1;
  Extent extent;

  uint32_t count() const { return end - begin; }
};

/// Makes one node of a range. The node is a leaf, or an inner node; for an inner node the function returns the ranges
/// of its children, the lower one first. `middle` is the beginning of the upper child's records.
std::pair<Range, Range> make_children(const Range& range, uint32_t middle, const Extent& below, const Extent& above,
                                      UnsetVector<BvhNode>& nodes) {
  const auto child = static_cast<uint32_t>(nodes.size());
  nodes[range.node] = {range.extent.box.bounds(), child, 0};
  nodes.resize(nodes.size() + 2);
  return {Range{range.begin, middle, child, range.depth + 1, below},
          Range{middle, range.end, child + 1, range.depth + 1, above}};
}

/// Moves the records below the plane to the front. Returns their number, and the boxes of the centres on both sides.
uint32_t partition_records(std::span<Record> records, const BinGrid& grid, const Split& split, LaneBox& centers_below,
                           LaneBox& centers_above) {
  LaneBox below;
  LaneBox above;
  size_t left = 0;
  size_t right = records.size();
  while (left < right) {
    const Lanes center = records[left].center();
    if (is_below(center, grid, split)) {
      below.extend(center, center);
      ++left;
    } else {
      above.extend(center, center);
      std::swap(records[left], records[--right]);
    }
  }
  centers_below = below;
  centers_above = above;
  return static_cast<uint32_t>(left);
}

/// Builds the subtree of a range on one thread; its root is node 0.
UnsetVector<BvhNode> build_subtree(const Range& root, Record* records) {
  UnsetVector<BvhNode> nodes(1);
  nodes.reserve(root.count());
  std::vector<Range> open = {root};
  open.back().node = 0;
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    const std::span<Record> members(records + range.begin, range.count());
    const BinGrid grid(range.extent.centers, range.count());
    Split split;
    Extent below;
    Extent above;
    if (range.depth < kMaxSahDepth && range.count() == 2) {
      split = find_best_split(grid, members[0], members[1]);
    } else if (range.depth < kMaxSahDepth && range.count() > 2) {
      Bins bins(grid);
      bins.add(grid, members);
      split = find_best_split(grid, bins);
      std::tie(below.box, above.box) = bins.boxes_of(split, grid);
    }
    const double area = range.extent.box.half_area();
    const bool pays = kNodeCost * area + kTestCost * split.cost < kTestCost * area * range.count();
    if (range.count() <= kMaxLeafSize && !pays) {
      nodes[range.node] = {range.extent.box.bounds(), range.begin, range.count()};
      continue;
    }
    uint32_t middle = range.begin + range.count() / 2;
    if (split.exists() && range.count() > 2) {
      middle = range.begin + partition_records(members, grid, split, below.centers, above.centers);
    } else {
      if (split.exists() && !is_below(members[0].center(), grid, split)) std::swap(members[0], members[1]);
      for (uint32_t i = range.begin; i < middle; ++i) below.extend(records[i]);
      for (uint32_t i = middle; i < range.end; ++i) above.extend(records[i]);
    }
    auto [lower, upper] = make_children(range, middle, below, above, nodes);
    open.push_back(upper);
    open.push_back(lower);
  }
  return nodes;
}

/// A range that becomes a subtree, and the buffer that contains its records.
struct Subtree {
  Range range;
  Record* records = nullptr;
};

/// A part of a range that one thread first bins and then scatters.
struct Chunk {
  uint32_t begin;
  uint32_t end;
  Bins bins;
  /// The positions to which its first records below and above the plane are moved.
  uint32_t first_below = 0;
  uint32_t first_above = 0;
  /// The extents of the records below and above the plane.
  Extent below;
  Extent above;

  Chunk(uint32_t first, uint32_t last, const BinGrid& grid) : begin(first), end(last), bins(grid) {}
};

/// A range in the top of the tree that is being split.
struct Halving {
  Range range;
  BinGrid grid;
  std::vector<Chunk> chunks;
  Split split;
  uint32_t middle = 0;

  explicit Halving(const Range& whole) : range(whole), grid(whole.extent.centers, whole.count()) {
    for (uint32_t begin = range.begin; begin < range.end; begin += std::min(kSahChunkSize, range.end - begin)) {
      chunks.emplace_back(begin, begin + std::min(kSahChunkSize, range.end - begin), grid);
    }
  }
  void choose_split();
  void scatter(Chunk& chunk, const Record* from, Record* to) const;
};

/// Chooses the plane and assigns each chunk its positions on both sides, so that records keep their order. It is called
/// after all chunks are binned.
void Halving::choose_split() {
  Bins all(grid);
  for (const Chunk& chunk : chunks) all.add(chunk.bins, grid);
  split = find_best_split(grid, all);
  if (!split.exists()) return;
  middle = range.begin + all.count_below(split);
  uint32_t below = range.begin;
  uint32_t above = middle;
  for (Chunk& chunk : chunks) {
    chunk.first_below = below;
    chunk.first_above = above;
    below += chunk.bins.count_below(split);
    above += chunk.end - chunk.begin - chunk.bins.count_below(split);
  }
}

void Halving::scatter(Chunk& chunk, const Record* from, Record* to) const {
  uint32_t below = chunk.first_below;
  uint32_t above = chunk.first_above;
  for (uint32_t i = chunk.begin; i < chunk.end; ++i) {
    if (is_below(from[i].center(), grid, split)) {
      to[below++] = from[i];
      chunk.below.extend(from[i]);
    } else {
      to[above++] = from[i];
      chunk.above.extend(from[i]);
    }
  }
}

class SahBuild {
 public:
  SahBuild(std::span<const Bounds> boxes, const BuildOptions& options)
      : boxes_(boxes),
        thread_count_(options.thread_count),
        progress_(options.progress, count_levels(boxes.size())),
        records_(boxes.size()),
        scattered_(boxes.size()) {}

  Bvh run() {
    bvh_.nodes.resize(1);
    std::vector<Range> level;
    add_range(make_root(), records_.data(), level);
    while (!level.empty()) level = split_level(level);
    build_subtrees();
    return std::move(bvh_);
  }

 private:
  Range make_root();
  std::vector<Range> split_level(const std::vector<Range>& level);
  void build_subtrees();

  /// Returns the amount of work for `count` records if each level halves them.
  static double count_levels(size_t count) { return static_cast<double>(count) * std::log2(1.0 + count); }

  /// Adds a range. A large range is split with the next level; a small or deep range becomes a subtree.
  void add_range(const Range& range, Record* records, std::vector<Range>& level) {
    if (range.count() > kSahSubtreeSize && range.depth < kMaxSahDepth) {
      level.push_back(range);
    } else {
      subtrees_.push_back({range, records});
    }
  }

  std::span<const Bounds> boxes_;
  unsigned thread_count_;
  /// The progress, measured in records times levels.
  SharedProgress progress_;
  /// The records of the current level, and the buffer to which its chunks scatter them.
  UnsetVector<Record> records_;
  UnsetVector<Record> scattered_;
  std::vector<Subtree> subtrees_;
  Bvh bvh_;
};

Range SahBuild::make_root() {
  const auto count = static_cast<uint32_t>(boxes_.size());
  std::vector<Extent> extents((count + kSahChunkSize - 1) / kSahChunkSize);
  for_each_index(extents.size(), thread_count_, [&](size_t chunk) {
    const auto begin = static_cast<uint32_t>(chunk * kSahChunkSize);
    Extent extent;
    for (uint32_t i = begin; i < begin + std::min(kSahChunkSize, count - begin); ++i) {
      records_[i] = Record(boxes_[i], i);
      extent.extend(records_[i]);
    }
    extents[chunk] = extent;
  });
  Range root;
  root.end = count;
  for (const Extent& extent : extents) root.extent.extend(extent);
  return root;
}

std::vector<Range> SahBuild::split_level(const std::vector<Range>& level) {
  std::vector<Halving> halvings(level.begin(), level.end());
  std::vector<std::pair<Halving*, Chunk*>> work;
  for (Halving& halving : halvings) {
    for (Chunk& chunk : halving.chunks) work.emplace_back(&halving, &chunk);
  }
  for_each_index(work.size(), thread_count_, [&](size_t i) {
    const auto [halving, chunk] = work[i];
    chunk->bins.add(halving->grid, {records_.data() + chunk->begin, records_.data() + chunk->end});
  });
  for (Halving& halving : halvings) halving.choose_split();
  for_each_index(work.size(), thread_count_, [&](size_t i) {
    const auto [halving, chunk] = work[i];
    if (halving->split.exists()) halving->scatter(*chunk, records_.data(), scattered_.data());
  });
  std::vector<Range> next_level;
  for (const Halving& halving : halvings) {
    if (!halving.split.exists()) {
      subtrees_.push_back({halving.range, records_.data()});
      continue;
    }
    Extent below;
    Extent above;
    for (const Chunk& chunk : halving.chunks) {
      below.extend(chunk.below);
      above.extend(chunk.above);
    }
    const auto [lower, upper] = make_children(halving.range, halving.middle, below, above, bvh_.nodes);
    add_range(lower, scattered_.data(), next_level);
    add_range(upper, scattered_.data(), next_level);
    progress_.add(halving.range.count());
  }
  std::swap(records_, scattered_);
  return next_level;
}

void SahBuild::build_subtrees() {
  bvh_.references.resize(boxes_.size());
  std::vector<UnsetVector<BvhNode>> built(subtrees_.size());
  for_each_index(subtrees_.size(), thread_count_, [&](size_t i) {
    const auto& [range, records] = subtrees_[i];
    built[i] = build_subtree(range, records);
    for (uint32_t k = range.begin; k < range.end; ++k) bvh_.references[k] = records[k].index();
    progress_.add(count_levels(range.count()));
  });
  // A subtree's root replaces its placeholder in the top; its other nodes are appended.
  std::vector<size_t> starts = {bvh_.nodes.size()};
  for (const UnsetVector<BvhNode>& nodes : built) starts.push_back(starts.back() + nodes.size() - 1);
  bvh_.nodes.resize(starts.back());
  for_each_index(subtrees_.size(), thread_count_, [&](size_t i) {
    const auto shift = static_cast<uint32_t>(starts[i]) - 1;
    for (BvhNode& node : built[i]) {
      if (node.count == 0) node.first += shift;
    }
    bvh_.nodes[subtrees_[i].range.node] = built[i].front();
    std::copy(built[i].begin() + 1, built[i].end(), bvh_.nodes.begin() + static_cast<std::ptrdiff_t>(starts[i]));
  });
}

}  // namespace

Bvh build_sah(const BuildInput& input, const BuildOptions& options) {
  return SahBuild(input.boxes, options).run();
}

}  // namespace promin
