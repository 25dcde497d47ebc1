// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bvh/builders.h"
#include "core/shared_progress.h"

namespace promin {
namespace {

constexpr uint32_t kObjectsPerLeaf = 2;

int longest_axis(const Bounds& bounds) {
  const dvec3 extent = dvec3(bounds.hi) - dvec3(bounds.lo);
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

}  // namespace

Bvh build_median(const BuildInput& input, const BuildOptions& options) {
  const std::span<const Bounds> boxes = input.boxes;
  struct Range {
    uint32_t begin;
    uint32_t end;
    uint32_t node;
  };
  Bvh bvh;
  bvh.references.resize(boxes.size());
  std::iota(bvh.references.begin(), bvh.references.end(), 0U);
  bvh.nodes.resize(1);
  // Each level of the tree processes all boxes.
  SharedProgress progress(options.progress, static_cast<double>(boxes.size()) * std::log2(1.0 + boxes.size()));
  std::vector<Range> open = {{0, static_cast<uint32_t>(boxes.size()), 0}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    progress.add(range.end - range.begin);
    const auto first = bvh.references.begin() + range.begin;
    const auto last = bvh.references.begin() + range.end;
    Bounds bounds;
    for (auto reference = first; reference != last; ++reference) bounds.extend(boxes[*reference]);
    const int axis = longest_axis(bounds);
    const auto comes_before = [&](uint32_t a, uint32_t b) {
      const float center_a = boxes[a].center()[axis];
      const float center_b = boxes[b].center()[axis];
      return center_a != center_b ? center_a < center_b : a < b;
    };
    if (range.end - range.begin <= kObjectsPerLeaf) {
      std::sort(first, last, comes_before);
      bvh.nodes[range.node] = {bounds, range.begin, range.end - range.begin};
      continue;
    }
    // The range is split into the halves of the sorted sequence. Each half need not be sorted, because the lower levels
    // sort it again.
    const uint32_t middle = range.begin + (range.end - range.begin) / 2;
    std::nth_element(first, bvh.references.begin() + middle, last, comes_before);
    const auto child = static_cast<uint32_t>(bvh.nodes.size());
    bvh.nodes[range.node] = {bounds, child, 0};
    bvh.nodes.resize(bvh.nodes.size() + 2);
    open.push_back({middle, range.end, child + 1});
    open.push_back({range.begin, middle, child});
  }
  return bvh;
}

}  // namespace promin
